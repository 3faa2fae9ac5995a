from defect import Defect, main

DEFECT = Defect(
    title="VTK's linear integrator makes light from nothing where matter is faint",
    where="Rendering/Volume/vtkUnstructuredGridLinearRayIntegrator.cxx, IntegrateRay and Psi, in float.",
    what="""The colour of a segment is a difference of terms that are near the colours themselves; for an optical depth of 1e-8 they
        agree in all digits that a float has, and what is left is up to the whole difference of the two colours, and of either sign,
        instead of 1e-8. Where cells are small or thin matter lies between dense one, every cell adds such light.""",
    repair="for small depths take the series, or the mean of the front and back colours times the opacity, and expm1 for 1 - exp.",
    quantity="blue light of a segment whose opacity is 1.5e-8, from colours 1 in front and 0 behind",
    tolerance=1e-3,
)


def measure():
    from vtk_integrators import doubles, integrator_of, property_of, volume_of

    for front, back in ((0.2, 0.8), (0.8, 0.2), (0.47265625, 0.53173828125)):
        array = doubles([0, 1, 0, 1])
        volume, mapper = volume_of(property_of([(0, (0.5, 0.25, 1)), (1, (1, 0.75, 0))], [(0, 1e-8), (1, 2e-8)]), array, 1)
        integrator, rgba = integrator_of("linear"), [0.0] * 4
        mapper.SetRayIntegrator(integrator)
        integrator.Initialize(volume, array)
        integrator.Integrate(doubles([1]), doubles([front]), doubles([back]), rgba)
        depth = 1e-8 * (1 + (front + back) / 2)
        yield f"scalars {front:.2f} to {back:.2f}", depth * (1 - (front + back) / 2), rgba[2]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
