from defect import Defect, main

DEFECT = Defect(
    title="vtk.js makes pixels opaque whose opacity is above 0.99",
    where="Sources/Rendering/OpenGL/glsl/vtkVolumeFS.glsl of vtk.js 37.4.3: `if (color.a > 0.99) { color.a = 1.0; break; }`.",
    what="""Rays end where they are nearly opaque, which is fair, but the opacity that they have by then is replaced by 1, so that what is behind
        the volume changes by up to 2.5 steps of 8 bits at a contour. Here a block has the opacity 0.9914.""",
    repair="leave the opacity as it is, or end rays at 1 - 1/512.",
    quantity="opacity of the block",
    tolerance=0.004,
)


def measure():
    import matter
    import vtkjs

    for opacity in (0.43, 0.448):
        true = matter.opacity_of(None, opacity, 8)
        yield f"{opacity:g} per unit, 8 units", true, matter.middle(vtkjs.render(matter.slab(opacity=opacity), [], {"step": 1 / 16}))[3]


if __name__ == "__main__":
    import vtkjs

    main(DEFECT, vtkjs.version(), measure)
