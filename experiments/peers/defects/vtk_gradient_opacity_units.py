from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="VTK's gradient opacity is a function of the gradient per average voxel, not per unit of length",
    where="Rendering/Volume/vtkVolumeMapper.cxx and vtkEncodedGradientEstimator.cxx (aspect: spacing over its mean); Rendering/VolumeOpenGL2/vtkVolumeShaderComposer.h (cell spacing over its mean).",
    what="""The scalar opacity has a unit distance; the gradient opacity has none, and its argument is the change of the scalar over the average of the
        three spacings. The same matter at twice the resolution, or the same file in millimetres and in metres where these differ along the axes,
        has another gradient opacity. Both mappers agree, so it is a convention, but the documentation does not state it, and presets cannot be
        carried from one volume to another. Here a scalar rises steadily; the gradient opacity is 1/4 at a slope of 1 per unit of length.""",
    repair="state it in SetGradientOpacity's documentation; better, let the volume property state the length, as for the scalar opacity.",
    quantity="opacity of the same matter, spaced 1 and 2 units apart",
    tolerance=0.05,
)


def measure():
    import matter
    import vtk_raycasters
    from vtk_window import property_of, render, renderer_of, vtk, window_of

    size = 9
    for name in ("gpu", "fixed_point_buffer"):
        for spacing in (1, 2):
            n = 32 // spacing + 1
            rise = np.broadcast_to(np.arange(n)[:, None, None] * float(spacing), (n, 9, 9))
            mapper = vtk_raycasters.mapper_of(name, {"voxels": rise, "spacing": [spacing] * 3}, 0.05)
            found = property_of([(0, (1, 1, 1)), (32, (1, 1, 1))], [(0, 0.1), (32, 0.1)], 1)
            gradient = vtk.vtkPiecewiseFunction()
            gradient.AddPoint(0, 0)
            gradient.AddPoint(4, 1)
            found.SetGradientOpacity(gradient)
            volume = vtk.vtkVolume()
            volume.SetMapper(mapper)
            volume.SetProperty(found)
            middle = [4 * spacing, 4 * spacing, 16]
            camera = {"eye": [*middle[:2], 100], "target": middle, "up": [0, 1, 0], "height": 0.5, "size": [size, size]}
            if name == "gpu":
                image = render(volume, camera)
            else:
                window_of(renderer_of(volume, camera), [size, size]).Render()
                image = vtk_raycasters.buffer_of(mapper, size, size)
            yield f"{name}, spacing {spacing}", matter.opacity_of(None, 0.1 / 4, 32), matter.middle(image)[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
