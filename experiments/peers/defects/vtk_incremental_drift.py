from defect import Defect, main

import math

DEFECT = Defect(
    title="VTK's incremental pre-integration table drifts along its length",
    where="Rendering/Volume/vtkUnstructuredGridPreIntegration.cxx, BuildPreIntegrationTables: IncrementalPreIntegration, on by default.",
    what="""Every layer of the table, a segment that is longer by one step, is made of the layer before and one sampled step more at the
        back, whose scalar range is taken as if it were that of the whole; the errors of the steps add up, and the last layers, those of
        the longest cells, are wrong in the first digit where a narrow peak lies between both ends. The table that is not incremental is
        right to some digits; its cost is why it is not the default.""",
    repair="let the incremental step compose the layer of (front, middle) with that of (middle, back), both at their own scalars; or warn that the default is an approximation for long cells.",
    quantity="opacity of a segment of the longest length, from 0 to 1 through a narrow peak",
    tolerance=0.02,
)
PEAK, WIDTH = 512.0, 2**-10
NAMES = {"table": "incremental table", "table_not_incremental": "the same, not incremental", "linear": "linear integrator"}


def measure():
    from vtk_integrators import doubles, integrator_of, property_of, volume_of

    nodes = [(0, 0), (0.5 - WIDTH, 0), (0.5, PEAK), (0.5 + WIDTH, 0), (1, 0)]
    white = [(s, (1, 1, 1)) for s, _ in nodes]
    for name in NAMES:
        for share in (0.25, 1):
            array = doubles([0, 1, 0, 1])
            volume, mapper = volume_of(property_of(white, nodes), array, 1)
            integrator, rgba = integrator_of(name), [0.0] * 4
            mapper.SetRayIntegrator(integrator)
            integrator.Initialize(volume, array)
            integrator.Integrate(doubles([share]), doubles([0]), doubles([1]), rgba)
            yield f"{NAMES[name]}, {share:g} of the longest length", 1 - math.exp(-PEAK * WIDTH * share), rgba[3]


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
