from defect import Defect, main

import math

DEFECT = Defect(
    title="VTK's integrators of unstructured grids turn a jump of the transfer function into a ramp",
    where="Rendering/Volume/vtkUnstructuredGridLinearRayIntegrator.cxx and vtkUnstructuredGridPartialPreIntegration.cxx, GetTransferFunction: std::set of scalars.",
    what="""vtkPiecewiseFunction and vtkColorTransferFunction have AllowDuplicateScalars for functions that jump, and the ray casters of
        regular grids follow them. The integrators collect the scalars of the points in a std::set, so of two points at one scalar one is
        kept, with the value that GetValue gives there, and the other side becomes a ramp to the neighbour. Here the opacity jumps from 0
        to 3 at 1/2, where the ray is in the middle of its way.""",
    repair="keep both points, for instance by std::multiset with the values from the left and from the right.",
    quantity="opacity of a ray from 0 to 1 through the jump",
    tolerance=0.01,
)


def measure():
    from vtk_integrators import doubles, integrator_of, property_of, volume_of

    truth = 1 - math.exp(-1.5)
    white = [(s, (1, 1, 1)) for s in (0, 0.5, 0.5, 1)]
    for name in ("linear", "partial", "table"):
        array = doubles([0, 1, 0, 1])
        volume, mapper = volume_of(property_of(white, [(0, 0), (0.5, 0), (0.5, 3), (1, 3)]), array, 1)
        integrator, rgba = integrator_of(name), [0.0] * 4
        mapper.SetRayIntegrator(integrator)
        integrator.Initialize(volume, array)
        integrator.Integrate(doubles([1]), doubles([0]), doubles([1]), rgba)
        yield name, truth, rgba[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
