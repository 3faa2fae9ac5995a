from defect import Defect, main

import math

DEFECT = Defect(
    title="VTK's integrators of unstructured grids drop control points of the opacity",
    where="Rendering/Volume/vtkUnstructuredGridLinearRayIntegrator.cxx, GetTransferFunction, and the same loop in vtkUnstructuredGridPartialPreIntegration.cxx; in the tree since 2004.",
    what="""The loop over the points of the opacity ends where the scalar is function_range[0], the first point, not
        function_range[1], the last one, as the loop over the colours does. So all points of the opacity but the first are left out,
        unless a colour has a point at the same scalar. Here the opacity is a tent between two points of the colour: it renders as
        nothing. vtkUnstructuredGridPreIntegration, the default of the mapper, fills its table by the partial one, and has it too.""",
    repair="compare with function_range[1] in the loop over the opacity.",
    quantity="opacity of a ray through the tent",
    tolerance=0.01,
)
NODES = [(0, 0), (0.4, 0), (0.5, 4), (0.6, 0), (1, 0)]


def measure():
    from vtk_integrators import doubles, integrator_of, property_of, volume_of

    # From 0.1 to 0.9 along a length of 2: the tent's area of 0.4 is crossed at 2 / 0.8 of length for each unit of the scalar.
    truth = 1 - math.exp(-0.4 * 2 / 0.8)
    for name in ("linear", "partial", "table", "homogeneous"):
        array = doubles([0, 1, 0, 1])
        volume, mapper = volume_of(property_of([(0, (1, 0, 0)), (1, (0, 1, 0))], NODES), array, 2)
        integrator, rgba = integrator_of(name), [0.0] * 4
        mapper.SetRayIntegrator(integrator)
        integrator.Initialize(volume, array)
        # The homogeneous one takes a segment as a whole; many short ones are fair to it.
        count = 1 if name != "homogeneous" else 1000
        s = [0.1 + 0.8 * i / count for i in range(count + 1)]
        integrator.Integrate(doubles([2 / count] * count), doubles(s[:-1]), doubles(s[1:]), rgba)
        yield name, truth, rgba[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
