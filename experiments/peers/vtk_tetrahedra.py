"""VTK's mappers of unstructured grids render a scene, its cells cut into tetrahedra:
vtk_tetrahedra.py NAME [integrator=linear] < scene.json > image.npy

NAME: projected (vtkProjectedTetrahedraMapper), zsweep (vtkUnstructuredGridVolumeZSweepMapper), bunyk
(vtkUnstructuredGridVolumeRayCastMapper, by Bunyk's function). A tetrahedron's scalar is linear, that of the scene's
cell trilinear: the two are the same for scalars that are linear in x, y and z.
"""

import math

import questions
from vtk_integrators import integrator_of
from vtk_window import VERSION, functions_of, render as render_window, render_8_bits, run_adapter, tetrahedra, vtk

MAPPERS = {"projected": "vtkProjectedTetrahedraMapper", "zsweep": "vtkUnstructuredGridVolumeZSweepMapper",
           "bunyk": "vtkUnstructuredGridVolumeRayCastMapper"}


def version():
    return VERSION


def property_of(scene):
    """Opacities over the unit distance are extinctions here."""
    colors, densities, unit = questions.lists_of(scene)
    if unit is not None:
        # Linear opacities as extinctions, which they are through many points.
        densities = [(s, -math.log1p(-min(a, 1 - 2**-24)) / unit) for s, a in finer(densities)]
    low, high = float(scene["voxels"].min()), float(scene["voxels"].max())
    found = vtk.vtkVolumeProperty()
    color, opacity = functions_of(questions.widened(colors, low, high), questions.widened(densities, low, high))
    found.SetColor(color)
    found.SetScalarOpacity(opacity)
    found.SetScalarOpacityUnitDistance(min(scene["spacing"]))
    found.SetInterpolationTypeToLinear()
    return found


def finer(points, parts=64):
    """The same line through more points."""
    result = []
    for (a, x), (b, y) in zip(points, points[1:]):
        count = 1 if a == b or x == y else parts
        result += [(a + i / count * (b - a), x + i / count * (y - x)) for i in range(count)]
    return [*result, points[-1]]


def render(scene, words, options):
    name, = words
    mapper, volume = getattr(vtk, MAPPERS[name])(), vtk.vtkVolume()
    mapper.SetInputData(tetrahedra(scene["voxels"], scene["spacing"], options.get("voxels", "f4")))
    if name != "projected":
        mapper.AutoAdjustSampleDistancesOff()
        if "integrator" in options:
            mapper.SetRayIntegrator(integrator_of(options["integrator"]))
    volume.SetMapper(mapper)
    volume.SetProperty(property_of(scene))
    # The projected ones are drawn by a pass of their own, which leaves the pass in binary32 empty.
    return render_8_bits(volume, scene["camera"]) if name == "projected" else render_window(volume, scene["camera"])


if __name__ == "__main__":
    run_adapter(render)
