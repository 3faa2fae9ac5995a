from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="vtkUnstructuredGridVolumeRayCastMapper truncates interpolated scalars to the type of the data",
    where="Rendering/Volume/vtkUnstructuredGridVolumeRayCastMapper.cxx, line 389 of d5345fac (NearIntersectionsBuffer of the data's type); vtkUnstructuredGridBunykRayCastFunction.cxx, static_cast<ValueType>.",
    what="""Scalars at the faces of cells, between the vertices, are kept in an array of the type of the data, and cast to it. For integers
        all that is behind the point is cut off, a bias of half a step of the integer: for unsigned char with few values, labels or counts,
        the picture is banded and too dark. The same grid with float scalars is right. Here a block whose scalar rises from 0 to 2.""",
    repair="keep the intersections' scalars in double (or float), whatever the data are.",
    quantity="opacity; expected is that of the same grid with float scalars",
    tolerance=0.005,
)


def measure():
    import matter
    import vtk_tetrahedra

    z, y, x = np.mgrid[0:3, 0:3, 0:3]
    for kind in ("f4", "u1", "i2"):
        scene = {"voxels": x.astype(float), "spacing": [1, 1, 1], "separate_lists": {"color": [{"s": s, "color": [1, 1, 1]} for s in (0, 2)], "extinction": [{"s": s, "extinction": 0.5 * s} for s in (0, 2)]},
                 "camera": {"eye": [1.3, 1.2, 9], "target": [1.3, 1.2, 1], "up": [0, 1, 0], "height": 0.2, "size": [9, 9]}}
        pixel = matter.middle(vtk_tetrahedra.render(scene, ["bunyk"], {"voxels": kind, "integrator": "linear"}))[3]
        if kind == "f4":
            of_floats = pixel
        else:
            yield {"u1": "unsigned char", "i2": "short"}[kind], of_floats, pixel


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
