"""VTK's integrators of unstructured grids answer vectors: vtk_integrators.py NAME < vectors.json > answers.csv

NAME: linear, partial, table (vtkUnstructuredGridPreIntegration, which is the default; incremental as it is by default),
table_not_incremental, homogeneous.
"""

import sys

import questions
from vtk_window import vtk

MAKERS = {"linear": "vtkUnstructuredGridLinearRayIntegrator", "partial": "vtkUnstructuredGridPartialPreIntegration",
          "homogeneous": "vtkUnstructuredGridHomogeneousRayIntegrator", "table": "vtkUnstructuredGridPreIntegration",
          "table_not_incremental": "vtkUnstructuredGridPreIntegration"}


def integrator_of(name):
    integrator = getattr(vtk, MAKERS[name])()
    if name == "table_not_incremental":
        integrator.IncrementalPreIntegrationOff()
    return integrator


def doubles(values):
    array = vtk.vtkDoubleArray()
    for value in values:
        array.InsertNextValue(value)
    return array


def property_of(colors, extinctions):
    """The integrators take an opacity over the unit distance for the extinction."""
    color, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    color.AllowDuplicateScalarsOn()
    opacity.AllowDuplicateScalarsOn()
    for s, rgb in colors:
        color.AddRGBPoint(s, *rgb)
    for s, extinction in extinctions:
        opacity.AddPoint(s, extinction)
    found = vtk.vtkVolumeProperty()
    found.SetColor(color)
    found.SetScalarOpacity(opacity)
    found.SetScalarOpacityUnitDistance(1)
    found.SetInterpolationTypeToLinear()
    return found


def volume_of(property_, scalars, longest):
    """A volume of one cell: tables ask the mapper's grid for its longest edge."""
    grid, corners = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    for corner in ((0, 0, 0), (longest, 0, 0), (0, 1e-9, 0), (0, 0, 1e-9)):
        corners.InsertNextPoint(corner)
    grid.SetPoints(corners)
    grid.InsertNextCell(vtk.VTK_TETRA, 4, (0, 1, 2, 3))
    scalars.SetName("s")
    grid.GetPointData().SetScalars(scalars)
    mapper, volume = vtk.vtkUnstructuredGridVolumeRayCastMapper(), vtk.vtkVolume()
    mapper.SetInputData(grid)
    volume.SetMapper(mapper)
    volume.SetProperty(property_)
    return volume, mapper


def answer(name, vector):
    """None where the question is one that the integrator has no words for: opacities that are linear."""
    length, front, back = questions.segments_of(vector)
    colors, densities, unit = questions.lists_of(vector)
    if unit is not None:
        return None
    scalars = [*front, back[-1], colors[0][0], colors[-1][0], densities[0][0], densities[-1][0]]
    low, high = min(scalars), max(scalars)
    colors, densities = questions.widened(colors, low, high), questions.widened(densities, low, high)
    array = doubles([low, high, low, high])
    volume, mapper = volume_of(property_of(colors, densities), array, length)
    integrator = integrator_of(name)
    mapper.SetRayIntegrator(integrator)
    mapper.Update()
    integrator.Initialize(volume, array)
    rgba = [0.0] * 4
    integrator.Integrate(doubles([length] * len(front)), doubles(front), doubles(back), rgba)
    return rgba


def main():
    if sys.argv[1:] == ["--version"]:
        return print("VTK", vtk.vtkVersion.GetVTKVersion())
    answers = {vector["id"]: answer(sys.argv[1], vector) for vector in questions.associated(questions.ask()["vectors"])}
    questions.answer_vectors({name: rgba for name, rgba in answers.items() if rgba is not None})


if __name__ == "__main__":
    main()
