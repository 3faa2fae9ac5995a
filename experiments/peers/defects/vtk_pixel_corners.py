from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="vtkUnstructuredGridVolumeRayCastMapper sends rays through the pixels' corners",
    where="Rendering/Volume/vtkUnstructuredGridBunykRayCastFunction.cxx, line 113 of d5345fac: X / (size - 1) * 2 - 1.",
    what="""Pixel i of N has its centre at (i + 1/2)/N of the image's width. Bunyk's function takes i/(N - 1): the outermost rays go along
        the image's border, so that the picture is smaller by a pixel and off by up to half a pixel, where surfaces and other mappers in the same
        window are not. (The stretch of the display helper, another defect, partly hides it.) Here a plane divides the image: matter to
        the left of it, none to the right.""",
    repair="take (X + 0.5) / size * 2 - 1.",
    quantity="where the matter ends, in pixels from the left, of 64",
    tolerance=0.2,
)


def measure():
    import vtk_tetrahedra

    # A block from x = 0 to x = 8; the image shows x = -4 to 12 by 64 pixels of 1/4: the block's borders are those of pixels 16 and 48.
    z, y, x = np.mgrid[0:2, 0:9, 0:9]
    scene = {"voxels": np.full(x.shape, 0.5), "spacing": [1, 1, 1], "separate_lists": {"color": [{"s": s, "color": [1, 1, 1]} for s in (0, 1)], "extinction": [{"s": s, "extinction": 2} for s in (0, 1)]},
             "camera": {"eye": [4, 4, 9], "target": [4, 4, 0.5], "up": [0, 1, 0], "height": 16, "size": [64, 64]}}
    for name in ("bunyk", "zsweep", "projected"):
        row = vtk_tetrahedra.render(scene, [name], {})[32, :, 3]
        full = row.max()
        yield f"{name}, left border", 16, 32 - row[:32].sum() / full
        yield f"{name}, right border", 48, 32 + row[32:].sum() / full


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
