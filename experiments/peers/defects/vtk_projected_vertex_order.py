from defect import Defect, main

import math

DEFECT = Defect(
    title="The opacity of a projected tetrahedron depends on the order of its vertices",
    where="Rendering/VolumeOpenGL2/vtkOpenGLProjectedTetrahedraMapper.cxx, 'Find the opacity at intersection', case of four triangles; in the tree since 2004.",
    what="""Where the projection of a tetrahedron is a quadrilateral, two of its edges cross in the image, at the parameters alpha of the first and
        beta of the second edge. The colours at the crossing are interpolated by both; the opacity of the fourth vertex is weighted by alpha
        where beta belongs. Here the first edge has the extinction 0, the second one rises from 0 to 4, and is crossed at beta, where the cell is
        1/2 thick: the depth is beta.""",
    repair="weight the fourth vertex by beta, as the colours above it are.",
    quantity="opacity at the crossing",
    tolerance=0.01,
)
EXTINCTION = 4.0


def opacity(order, beta):
    import matter
    from vtk_window import property_of, render_8_bits, vtk

    vertices = [((-0.5, 0, 0.25), 0.0), ((0.5, 0, 0.25), 0.0), ((0, -beta, -0.25), 0.0), ((0, 1 - beta, -0.25), 1.0)]
    grid, points, scalars = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkDoubleArray()
    for i in order:
        points.InsertNextPoint(vertices[i][0])
        scalars.InsertNextValue(vertices[i][1])
    grid.SetPoints(points)
    grid.InsertNextCell(vtk.VTK_TETRA, 4, [0, 1, 2, 3])
    grid.GetPointData().SetScalars(scalars)
    mapper, volume = vtk.vtkProjectedTetrahedraMapper(), vtk.vtkVolume()
    mapper.SetInputData(grid)
    volume.SetMapper(mapper)
    volume.SetProperty(property_of([(0, (1, 1, 1)), (1, (1, 1, 1))], [(0, 0), (1, 1)], 1 / EXTINCTION))
    camera = {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0], "height": 2.4, "size": [201, 201]}
    return matter.middle(render_8_bits(volume, camera))[0]


def measure():
    for beta in (0.1, 0.3, 0.5, 0.8):
        for name, order in (("second", (0, 1, 2, 3)), ("first", (2, 3, 0, 1))):
            yield f"beta {beta}, the edge that varies comes {name}", 1 - math.exp(-beta), opacity(order, beta)


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
