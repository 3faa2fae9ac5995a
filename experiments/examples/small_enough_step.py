"""Is my step small enough?

Errors of a renderer's slabs (`order1`, pre-integrated) at ever smaller steps, on random rays through a volume, against
certified values. Put your own volume and transfer function in place of these.
"""

import numpy
import raytruth

x, y, z = numpy.mgrid[-1:1:48j, -1:1:48j, -1:1:48j]
shells = 127.5 * (1 + numpy.cos(9 * numpy.sqrt(x**2 + y**2 + z**2)))
volume = raytruth.Volume(shells.astype(numpy.uint8))  # indexed [z, y, x]

transfer = raytruth.TransferFunction.from_opacities(  # opacity of a length of one voxel
    s=[0, 120, 160, 255], opacity=[0, 0, 0.3, 0.1], color=[(0, 0, 0), (0.9, 0.4, 0.2), (1, 0.8, 0.5), (0.4, 0.6, 1)]
)

random = numpy.random.default_rng(1)
middle = (numpy.array(volume.size) - 1) / 2
directions = random.normal(size=(500, 3))
directions /= numpy.linalg.norm(directions, axis=1)[:, None]
origins = middle - 60 * directions + random.uniform(-15, 15, size=(500, 3))

truth = raytruth.rays(volume, transfer, origins, directions)
print(f"certified: no colour or opacity is off by more than {truth.radius.max():.1e}")
print("step      RMSE   largest  on a screen of 8 bits")
for step in (2, 1, 0.5, 0.25, 0.125):
    found = raytruth.rays(volume, transfer, origins, directions, scheme="order1", step=step)
    error = numpy.abs(found.color - truth.color)
    visible = "seen" if error.max() > 0.5 / 255 else "not seen"
    print(f"{step:<6} {numpy.sqrt(numpy.mean(error**2)):.1e}   {error.max():.1e}  {visible}")
