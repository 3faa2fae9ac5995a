from defect import Defect, main

import math

DEFECT = Defect(
    title="VTK's integrators of unstructured grids keep the transfer function of the first time step",
    where="Rendering/Volume/vtkUnstructuredGridLinearRayIntegrator.cxx, vtkUnstructuredGridPartialPreIntegration.cxx and vtkUnstructuredGridPreIntegration.cxx, Initialize.",
    what="""Initialize returns early where the property is unmodified since the last call, but what it prepares also depends on the
        range of the scalars, and for PreIntegration on the longest cell. Where the data change under the same property, as in every
        animation, tables stay those of the first data: beyond its range Linear and Partial extrapolate, and PreIntegration clamps.
        Here data of range [0, 1/4] come first, then data of range [0, 3]; the opacity rises from 0 at 0 to 2 at 1, and is 2 beyond.""",
    repair="return early only where the scalars' range (and the longest cell) are those of the last call, too.",
    quantity="opacity of a ray of length 1 with the constant scalar 2.5, after earlier data",
    tolerance=0.01,
)


def measure():
    from vtk_integrators import doubles, integrator_of, property_of, volume_of

    truth = 1 - math.exp(-2)
    for name in ("linear", "partial", "table"):
        for earlier in (False, True):
            later = doubles([0, 3])
            volume, mapper = volume_of(property_of([(0, (1, 1, 1)), (1, (1, 1, 1))], [(0, 0), (1, 2)]), doubles([0, 3, 0, 3]), 1)
            integrator, rgba = integrator_of(name), [0.0] * 4
            mapper.SetRayIntegrator(integrator)
            if earlier:
                integrator.Initialize(volume, doubles([0, 0.25]))
            integrator.Initialize(volume, later)
            integrator.Integrate(doubles([1]), doubles([2.5]), doubles([2.5]), rgba)
            yield f"{name}, {'after other data' if earlier else 'fresh'}", truth, rgba[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
