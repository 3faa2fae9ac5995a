from defect import Defect, main

DEFECT = Defect(
    title="vtkFixedPointVolumeRayCastMapper rounds colours up at every sample",
    where="Rendering/Volume: `(colour * alpha + 0x7fff) >> 15` in 125 lines of 6 files, as vtkFixedPointVolumeRayCastCompositeHelper.cxx, line 157 of d5345fac.",
    what="""Products of 15 bits are rounded by adding 0x7fff before the shift, which is rounding up: half of the last bit is 0x4000. A
        sample adds up to 1/32767 of white to a channel, never subtracts, so that the colour is too bright in proportion to the number of
        samples: smaller steps, which are to make the image better, make it worse below a quarter of a voxel. Here faint white matter is seen
        through 8 units of length; its colour should be its opacity.""",
    repair="add 0x4000, not 0x7fff.",
    quantity="light minus opacity, which is 0 for white matter",
    tolerance=0.002,
)


def measure():
    import matter
    import vtk_raycasters

    for step in (1, 0.25, 1 / 16, 1 / 64, 1 / 256):
        pixel = matter.middle(vtk_raycasters.render(matter.slab(opacity=0.05), ["fixed_point_buffer"], {"step": step}))
        yield f"step {step:g}", 0, pixel[0] - pixel[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
