from defect import Defect, main

DEFECT = Defect(
    title="VTK's ray casters of regular grids end a ray at a whole number of steps",
    where="Rendering/VolumeOpenGL2/shaders/raycasterfs.glsl and vtkVolumeShaderComposer.h (termination); Rendering/Volume/vtkFixedPointVolumeRayCastMapper.cxx, number of steps of a ray.",
    what="""Every sample stands for a whole step. On the GPU a ray has one sample less than fits, so it is shorter than the volume by up to
        a step, and by a whole one where the step divides its length; the fixed point mapper takes the nearest number of steps, so it is up to
        half a step too short or too long. Where the matter at the border is visible (a box filled with fog, a cropped volume, a clipping
        plane), opacities change with the step in a saw tooth. A convention as much as a defect: it vanishes with the step, in the first
        order.""",
    repair="weight the last sample by the length that is left: its opacity is 1 - (1 - a)^share.",
    quantity="opacity of a block of 8 units, 0.1 each",
    tolerance=0.002,
)


def measure():
    import matter
    import vtk_raycasters

    for name in ("gpu", "fixed_point_buffer"):
        for step in (0.7, 0.3, 0.1):
            scene = matter.slab(opacity=0.1)
            yield f"{name}, step {step:g}", matter.opacity_of(scene, 0.1, 8), matter.middle(vtk_raycasters.render(scene, [name], {"step": step}))[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
