from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="VTK's isosurface mode shows at most one surface per step",
    where="Rendering/VolumeOpenGL2/vtkVolumeShaderComposer.h, ShadingMultipleInputs/ShadingSingleInput for ISOSURFACE_BLEND (VTK 9.0 on).",
    what="""With vtkVolumeMapper::ISOSURFACE_BLEND the shader looks for the first contour value between two samples and goes on with the next
        step, so of several surfaces between two samples one is drawn. Contours that lie close, as the walls of a vessel, or large steps
        while interacting, lose surfaces, and with them opacity. Here three surfaces of opacity 1/2 lie behind each other.""",
    repair="sort the contour values that the step crosses by where it crosses them, and composite all of them.",
    quantity="opacity of three surfaces of opacity 1/2",
    tolerance=0.01,
)


def measure():
    import matter
    from vtk_window import image_data, render, vtk

    n = 33
    voxels = np.broadcast_to(np.linspace(0, 1, n)[:, None, None], (n, 5, 5))
    for step in (1, 4, 8, 16):
        mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
        mapper.SetInputData(image_data(np.ascontiguousarray(voxels), [1, 1, 1]))
        mapper.AutoAdjustSampleDistancesOff()
        mapper.SetSampleDistance(step)
        mapper.UseJitteringOff()
        mapper.SetBlendModeToIsoSurface()
        color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
        found = vtk.vtkVolumeProperty()
        for s in (0, 1):
            color.AddRGBPoint(s, 1, 1, 1)
            opacity.AddPoint(s, 0.5)
        found.SetColor(color)
        found.SetScalarOpacity(opacity)
        found.SetInterpolationTypeToLinear()
        found.ShadeOff()
        for i, value in enumerate((0.4, 0.5, 0.6)):
            found.GetIsoSurfaceValues().SetValue(i, value)
        volume = vtk.vtkVolume()
        volume.SetMapper(mapper)
        volume.SetProperty(found)
        camera = {"eye": [2, 2, 100], "target": [2, 2, 16], "up": [0, 1, 0], "height": 0.5, "size": [9, 9]}
        yield f"step {step}, surfaces 3.2 apart", 0.875, matter.middle(render(volume, camera))[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
