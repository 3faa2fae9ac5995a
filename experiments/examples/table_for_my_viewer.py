"""A pre-integration table for my viewer: which size and format are worth their bytes?

The error beside each is that of linear look-ups in the stored numbers, measured against proven values.
"""

import numpy
import raytruth

transfer = raytruth.TransferFunction.from_opacities(
    s=[0, 80, 110, 255], opacity=[0, 0, 0.4, 0.9], color=[(0, 0, 0), (0.9, 0.5, 0.4), (1, 0.9, 0.8), (1, 1, 1)]
)
print("size  format      bytes    largest error of a look-up")
for size in (32, 64, 128, 256):
    for number_format in ("unorm8", "float16", "float32"):
        case = {
            "transfer_function": transfer,
            "builder": "exact",
            "size": size,
            "length": 0.5,  # the step of the viewer, in voxels
            "range": [0, 255],
            "format": number_format,
        }
        table = raytruth.table(case)
        print(f"{size:<5} {number_format:<9} {table.values.nbytes:>8}    {table.description['error']['max']:.1e}")
numpy.save("table.npy", table.values)  # [back, front, (red, green, blue, opacity)]
