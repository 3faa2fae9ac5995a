from defect import Defect, main

import math

DEFECT = Defect(
    title="In perspective, projected tetrahedra vanish where the grid also holds a large cell",
    where="Rendering/VolumeOpenGL2/vtkOpenGLProjectedTetrahedraMapper.cxx, GetCorrectedDepth and SqrtTable; in the tree since 89350e99af (2006).",
    what="""In perspective the thickness of a cell is looked up, without interpolation, in a table of 2048 square roots up to the largest edge of the
        whole grid. A cell thinner than that edge over sqrt(2048), 45.25, has the thickness 0: meshes that are refined where something happens
        lose their finest cells. In parallel projection they are right. Here a cell 0.16 thick has the extinction 20; another one, outside of the
        picture, grows.""",
    repair="take the square root; it costs less than it did in 2006.",
    quantity="opacity of the cell",
    tolerance=0.01,
)
SHAPE = ((-0.5, -0.3, -0.3), (0.5, -0.3, -0.3), (0, 0.6, -0.3), (0, 0, 0.5))
EDGE, EXTINCTION, DISTANCE = 0.2, 20.0, 5.0


def opacity(other_edge, perspective):
    import matter
    from vtk_window import property_of, render_8_bits, vtk

    grid, points, scalars = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkDoubleArray()
    for center, edge in (((0, 0, 0), EDGE), ((0, -30, -40), other_edge)):
        if edge > 0:
            ids = [points.InsertNextPoint([c + edge * x for c, x in zip(center, corner)]) for corner in SHAPE]
            for _ in ids:
                scalars.InsertNextValue(0.5)
            grid.InsertNextCell(vtk.VTK_TETRA, 4, ids)
    grid.SetPoints(points)
    grid.GetPointData().SetScalars(scalars)
    mapper, volume = vtk.vtkProjectedTetrahedraMapper(), vtk.vtkVolume()
    mapper.SetInputData(grid)
    volume.SetMapper(mapper)
    volume.SetProperty(property_of([(0, (1, 1, 1)), (1, (1, 1, 1))], [(0, 1), (1, 1)], 1 / EXTINCTION))
    camera = {"eye": [0, 0, DISTANCE], "target": [0, 0, 0], "up": [0, 1, 0], "size": [201, 201]}
    camera |= {"fov_y": 6} if perspective else {"height": 2 * DISTANCE * math.tan(math.radians(3))}
    return matter.middle(render_8_bits(volume, camera))[0]


def measure():
    for edge in (0, 1, 4, 8, 20):
        for perspective in (False, True):
            yield f"edge of the other cell {edge}, {'perspective' if perspective else 'parallel'}", 1 - math.exp(-EXTINCTION * 0.8 * EDGE), opacity(edge, perspective)


if __name__ == "__main__":
    from vtk_window import VERSION

    main(DEFECT, VERSION, measure)
