from defect import Defect, main

DEFECT = Defect(
    title="vtk.js drops matter whose opacity is below 0.001 per step",
    where="Sources/Rendering/OpenGL/glsl/vtkVolumeFS.glsl of vtk.js 37.4.3: `if (alpha < EPSILON) return vec4(0.0)`, EPSILON = 0.001.",
    what="""The test comes after the opacity was corrected for the step, so that the threshold is one per step: the smaller the steps, the more
        matter is dropped. Settings for quality erase faint clouds that settings for speed show. Here a block of fog of 8 units of length, with
        an opacity of 0.01 each, is seen at three steps.""",
    repair="compare the opacity before it is corrected, or drop the test: a sample that adds nothing costs nothing to add.",
    quantity="opacity of the block",
    tolerance=0.012,
)


def measure():
    import matter
    import vtkjs

    for step in (1, 0.25, 1 / 16):
        yield f"step {step:g}", matter.opacity_of(None, 0.01, 8), matter.middle(vtkjs.render(matter.slab(opacity=0.01), [], {"step": step}))[3]


if __name__ == "__main__":
    import vtkjs

    main(DEFECT, vtkjs.version(), measure)
