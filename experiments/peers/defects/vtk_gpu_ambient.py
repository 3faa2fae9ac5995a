from defect import Defect, main

import numpy as np

DEFECT = Defect(
    title="vtkOpenGLGPUVolumeRayCastMapper does not multiply ambient light by the matter's colour",
    where="Rendering/VolumeOpenGL2/vtkVolumeShaderComposer.h, lines 1410, 1456, 1480, 1492 of d5345fac: `in_ambient * ambient`; the headlight's (line 1310) has `* color.rgb`.",
    what="""With scene lights, the ambient term is the lights' ambient colour alone, so that ambient light on red matter is white. With a
        headlight it is right, and vtkFixedPointVolumeRayCastMapper is right in both cases, so the two mappers of vtkSmartVolumeMapper
        show different images. Lights of VTK have a black ambient colour by default, which hides it until one is set. Here red matter is
        lit by ambient light only.""",
    repair="multiply by color.rgb, as in the headlight's branch.",
    quantity="green light of red matter under ambient light of 1/2",
    tolerance=0.01,
)


def measure():
    import matter
    import vtk_raycasters

    for name in ("gpu", "fixed_point_buffer"):
        scene = matter.slab(opacity=0.2, color=(1, 0, 0))
        scene["voxels"] += np.linspace(-0.2, 0.2, 9)[:, None, None]  # normals need a gradient
        scene["shading"] = {"light": [0, 0, 1], "ambient": 0.5, "diffuse": 0, "specular": 0, "shininess": 1}
        yield name, 0, matter.middle(vtk_raycasters.render(scene, [name], {"step": 0.25}))[1]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
