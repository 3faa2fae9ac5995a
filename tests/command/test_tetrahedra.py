"""Rays through tetrahedra: against marches in rational numbers, files of every form, and what is refused."""

import importlib.util
import itertools
import json
import math
import random
import unittest
from fractions import Fraction

import numpy
from support import ProgramTest, changed

POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]
TETRAHEDRA = [[0, 1, 2, 3], [1, 2, 3, 4]]
SCALARS = [0, 1, 0.25, 0.5, 0.75]
MESH = {"points": POINTS, "tetrahedra": TETRAHEDRA, "scalars": SCALARS}
# Linear over all scalars, so that the depth is the sum of the cells' mean scalars times their lengths.
LINEAR = {
    "points": [{"s": 0, "extinction": 0, "color": [1, 1, 1]}, {"s": 1, "extinction": 2, "color": [1, 1, 1]}]
}
RAY = {
    "signal": {"kind": "tetrahedra", "mesh": MESH, "origin": [-1, 0.125, 0.25], "direction": [1, 0.0625, 0.125]},
    "transfer_function": LINEAR,
    "schemes": ["reference"],
}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def depth_of(points, tetrahedra, scalars, origin, direction, of_cells=False):
    """The optical depth and the length, by clipping the line against the planes of every cell in rational numbers."""
    exact = [[Fraction(x) for x in point] for point in points]
    origin, direction = [Fraction(x) for x in origin], [Fraction(x) for x in direction]
    stretches = {}
    for number, corners in enumerate(tetrahedra):
        low, high = Fraction(0), Fraction(10**9)
        functions = []
        for k in range(4):
            a, b, c = (exact[corners[j]] for j in range(4) if j != k)
            normal = cross([y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)])
            scale = dot(normal, [y - x for x, y in zip(a, exact[corners[k]])])
            at_0 = dot(normal, [y - x for x, y in zip(a, origin)]) / scale
            slope = dot(normal, direction) / scale
            functions.append((at_0, slope))
            if slope > 0:
                low = max(low, -at_0 / slope)
            elif slope < 0:
                high = min(high, -at_0 / slope)
            elif at_0 < 0:
                high = low
        if low >= high or (low, high) in stretches:
            continue
        middle = (low + high) / 2
        weights = [at_0 + slope * middle for at_0, slope in functions]
        value = scalars[number] if of_cells else dot(weights, [Fraction(scalars[i]) for i in corners])
        stretches[low, high] = Fraction(value)
    unit = math.sqrt(dot(direction, direction))
    return (
        2 * float(sum((high - low) * value for (low, high), value in stretches.items())) * unit,
        float(sum(high - low for low, high in stretches)) * unit,
    )


def split(size, number):
    """The tetrahedra of a grid, from the tables of vtkDataSetTriangleFilter and of Kuhn."""
    nx, ny, nz = size
    even, odd = "0356 1053 2036 4065 7356", "1247 0124 3172 5147 6274"
    kuhn = " ".join("0%d%d7" % (a, a + b) for a, b in itertools.permutations((1, 2, 4), 2))
    result = []
    for k, j, i in itertools.product(range(nz - 1), range(ny - 1), range(nx - 1)):
        words = kuhn if number == 6 else (even if (i + j + k) % 2 == 0 else odd)
        for word in words.split():
            result.append([(i + (b & 1)) + nx * ((j + (b >> 1 & 1)) + ny * (k + (b >> 2))) for b in map(int, word)])
    return result


class Rays(ProgramTest):
    def check(self, answer, depth, length):
        reference = answer["reference"]
        self.assertAlmostEqual(answer["length"], length, delta=1e-14 * (1 + length))
        self.assertAlmostEqual(reference["opacity"], -math.expm1(-depth), delta=reference["error_bound"] + 2e-15)
        self.assertLess(reference["error_bound"], 1e-13)

    def test_a_march_in_rational_numbers(self):
        numbers = random.Random(5)
        cases, truths = [], []
        for number in (5, 6):
            size = [3, 4, 3]
            values = [numbers.random() for _ in range(36)]
            points = [[i, j, k] for k in range(3) for j in range(4) for i in range(3)]
            tetrahedra = split(size, number)
            for origin, direction in [
                ([numbers.uniform(0, 2), numbers.uniform(0, 3), -1], [numbers.uniform(-0.5, 0.5), numbers.uniform(-0.5, 0.5), 1])
                for _ in range(12)
            ] + [([-1, 1, 1], [1, 0, 0]), ([-1, -1, -1], [1, 1, 1]), ([0, 0, -1], [0, 0, 1]), ([0.5, -1, 0.5], [0, 1, 0]),
                 ([1, 1.25, 1], [0.25, 1, 0.5])]:
                signal = {"kind": "tetrahedra", "volume": {"size": size, "values": values}, "split": number}
                cases.append({**RAY, "signal": {**signal, "origin": origin, "direction": direction}})
                truths.append(depth_of(points, tetrahedra, values, origin, direction))
        for answer, (depth, length) in zip(self.json_of("eval", "-", stdin=cases), truths):
            self.check(answer, depth, length)
        self.assertGreater(sum(length > 0 for _, length in truths), 20)

    def test_points_cells_and_every_form(self):
        of_cells = {**MESH, "cell_scalars": [0.25, 1]}
        del of_cells["scalars"]
        signal = RAY["signal"]
        ray = (signal["origin"], signal["direction"])
        truth = depth_of(POINTS, TETRAHEDRA, SCALARS, *ray)
        truth_of_cells = depth_of(POINTS, TETRAHEDRA, [0.25, 1], *ray, of_cells=True)
        self.check(self.json_of("eval", "-", stdin=RAY), *truth)
        answer = self.json_of("eval", "-", stdin=changed(RAY, "/signal/mesh", of_cells))
        self.check(answer, *truth_of_cells)
        self.assertEqual([part["cells"] for part in answer["parts"]], [2])
        for name, text in FILES.items():
            self.write(name, text)
            for array, expected in (("s", truth), ("c", truth_of_cells)):
                with self.subTest(name, array=array):
                    case = changed(RAY, "/signal/mesh", {"file": name, "array": array})
                    self.check(self.json_of("eval", self.write("case.json", case)), *expected)
            case = changed(RAY, "/signal/mesh", name)
            done = self.run_program("eval", self.write("case.json", case))
            self.assertIn(b"the array s is taken as the scalar; the file also has others: s, c", done.stderr)
            info = self.json_of("info", "--json", name)
            self.assertEqual((info["cells"], info["points"], info["array"]), (2, 5, "s"))
            self.assertEqual((info["minimum"], info["maximum"]), (0, 1))
            self.assertIn("2 tetrahedra", self.output_of("info", name))

    def test_meshio_writes_what_is_read(self):
        if importlib.util.find_spec("meshio") is None:
            self.skipTest("python3-meshio is not installed")
        import meshio

        mesh = meshio.Mesh(POINTS, [("tetra", TETRAHEDRA)], point_data={"s": SCALARS})
        signal = RAY["signal"]
        truth = depth_of(POINTS, TETRAHEDRA, SCALARS, signal["origin"], signal["direction"])
        for name, file_format in (("a.vtu", "vtu"), ("b.vtk", "vtk42"), ("c.vtk", "vtk51")):
            with self.subTest(file_format):
                meshio.write(str(self.folder / name), mesh, file_format=file_format, binary=False)
                self.check(self.json_of("eval", self.write("case.json", changed(RAY, "/signal/mesh", name))), *truth)
                meshio.write(str(self.folder / name), mesh, file_format=file_format)
                self.assert_refused(self.run_program("info", name), name, "Data Mode Ascii, compressor none")

    def test_gaps_cross_no_surface_and_schemes_are_refused_there(self):
        apart = {
            "points": POINTS[:4] + [[x + 3, y, z] for x, y, z in POINTS[:4]],
            "tetrahedra": [[0, 1, 2, 3], [4, 5, 6, 7]],
            "scalars": [0, 0.125, 0, 0, 1, 0.875, 1, 1],
        }
        case = {
            "signal": {"kind": "tetrahedra", "mesh": apart, "origin": [-1, 0.25, 0.25], "direction": [1, 0, 0]},
            "transfer_function": {"isosurfaces": [{"s": s, "opacity": 0.5, "color": [1, 1, 1]} for s in (0.03125, 0.5, 0.96875)]},
            "sampling": {"kind": "cells"},
            "schemes": ["reference", "order1"],
        }
        answer = self.json_of("eval", "-", stdin=case)
        self.assertEqual(answer["parts"], [{"from": 0, "to": 0.5, "cells": 1}, {"from": 3, "to": 3.5, "cells": 1}])
        self.assertEqual([(hit["t"], hit["surface"]) for hit in answer["reference"]["hits"]], [(0.25, 0), (3.25, 2)])
        self.assertEqual(answer["reference"]["opacity"], 0.75)
        answer = self.json_of("eval", "-", stdin={**case, "transfer_function": LINEAR})
        self.assertIn("leaves the mesh and enters it again", answer["schemes"]["order1"]["why"])

    def test_the_exact_scheme_of_linear_slabs_is_the_reference(self):
        case = {**RAY, "sampling": {"kind": "cells"}, "schemes": ["reference", "order1"]}
        answer = self.json_of("eval", "-", stdin=case)
        self.assertLess(abs(answer["schemes"]["order1"]["opacity_error"]), 1e-15)
        self.assertLess(answer["schemes"]["order1"]["xi"], 1e-15)

    def test_images(self):
        scene = {
            "mesh": MESH,
            "transfer_function": LINEAR,
            "camera": {"eye": [0.25, 0.25, 4], "target": [0.25, 0.25, 0], "up": [0, 1, 0], "height": 1.5, "size": [9, 9]},
            "scheme": "reference",
        }
        for projection in ({"height": 1.5}, {"fov_y": 20}):
            with self.subTest(projection):
                camera = {**scene["camera"], **projection}
                if "fov_y" in projection:
                    del camera["height"]
                answer = self.json_of("render", self.write("scene.json", {**scene, "camera": camera}), "-o", "a.npy")
                self.assertEqual((answer["volume"], answer["border"]), ("inline", "mesh"))
                self.assertEqual(answer["bound_of"], "the camera's rays as rounded to binary64")
                self.assertLess(answer["error_bound"], 1e-7)  # a .npy is in binary32
                image = numpy.load(self.folder / "a.npy")
                for row, column in ((4, 4), (3, 5), (6, 2), (0, 0)):
                    x, y = (column + 0.5) / 4.5 - 1, 1 - (row + 0.5) / 4.5
                    half = 0.75 if "height" in camera else math.tan(math.radians(10))
                    place = [0.25 + x * half, 0.25 + y * half, 4]
                    ray = (place, [0, 0, -1]) if "height" in camera else ([0.25, 0.25, 4], [x * half, y * half, -1])
                    depth, _ = depth_of(POINTS, TETRAHEDRA, SCALARS, *ray)
                    self.assertAlmostEqual(float(image[row, column, 3]), -math.expm1(-depth), delta=1e-6)
                self.output_of("render", self.write("scene.json", {**scene, "camera": camera, "scheme": "order1", "sampling": "cells"}), "-o", "b.npy")
                self.assertLess(abs(numpy.load(self.folder / "b.npy") - image).max(), 1e-6)
        for key, value, *expected in (
            ("step", 1, "/step"),
            ("shading", {}, "/shading", "beside a mesh"),
            ("volume", "v.nrrd", "/volume"),
            ("empty_space", {}, "/empty_space"),
            ("transfer_function", {"isosurfaces": [{"s": 0.5, "opacity": 1, "color": [1, 1, 1]}]}, "isosurfaces with a mesh"),
        ):
            with self.subTest(key):
                self.write("scene.json", {**scene, key: value})
                self.assert_refused(self.run_program("render", "scene.json", "-o", "c.npy"), *expected)
        self.output_of("render", self.write("scene.json", {**scene, "camera": {"size": [8, 8]}}), "-o", "d.npy")
        self.assertGreater(numpy.load(self.folder / "d.npy")[..., 3].max(), 0.1)

    def test_refusals(self):
        for pointer, value, *expected in (
            ("/signal/mesh/tetrahedra/1/3", 5, "/signal/mesh/tetrahedra/1", "the point 5 in cell 1"),
            ("/signal/mesh/points/4", [0.5, 0.25, 0.25], "/signal/mesh: cell 1", "volume of zero"),
            ("/signal/mesh/points/4", [0.25, 0.25, 0.25], "cell 1", "folded over cell 0"),
            ("/signal/mesh/tetrahedra/2", [1, 2, 3, 0], "cell 2", "folded over cell 0"),
            ("/signal/mesh/scalars/4", ..., "4 scalars for 5 points"),
            ("/signal/mesh/cell_scalars", [1, 2], "either scalars or cell_scalars"),
            ("/signal/mesh", "absent.vtu", "absent.vtu"),
            ("/signal/split", 5, "/signal/split"),
        ):
            with self.subTest(expected):
                self.assert_refused(self.run_program("eval", "-", stdin=changed(RAY, pointer, value)), *expected)
        volume = {"kind": "tetrahedra", "volume": {"size": [2, 2, 1], "values": [0, 1, 2, 3]}, "split": 5}
        case = {**RAY, "signal": {**volume, "origin": [0, 0, 0], "direction": [1, 0, 0]}}
        self.assert_refused(self.run_program("eval", "-", stdin=case), "/signal/volume", "2 x 2 x 1 voxels")
        case["signal"].update(split=6, parity="odd")
        self.assert_refused(self.run_program("eval", "-", stdin=case), "/signal/parity")

    def test_refusals_of_files(self):
        vtu, old, new = FILES.values()
        for name, text, *expected in (
            ("a.vtu", vtu.replace('"ascii"', '"appended"', 1), "appended", "Data Mode Ascii, compressor none"),
            ("a.vtu", vtu.replace("10 10", "10 12"), "cell 1", "type 12, a hexahedron", "Tetrahedralize"),
            ("a.vtu", vtu.replace("1 2 3 4", "1 2 3 9"), "cell 1", "0 to 4"),
            ("a.vtu", vtu.replace("UnstructuredGrid", "ImageData"), "ImageData"),
            ("a.vtu", vtu[:300], "line"),
            ("b.vtk", old.replace("ASCII", "BINARY"), "a binary file", "Data Mode Ascii"),
            ("b.vtk", old.replace("0 1 0\n", "0 nan 0\n"), "point 2", "nan"),
            ("b.vtk", old.replace("CELL_TYPES 2", "CELL_TYPES 3"), "found"),
            ("c.vtk", new.replace("UNSTRUCTURED_GRID", "POLYDATA"), "POLYDATA"),
            ("c.vtk", new.replace("POINTS 5", "POINTS 5000000000"), "5000000000"),
        ):
            with self.subTest(expected):
                self.write(name, text)
                self.assert_refused(self.run_program("info", name), name, *expected)


class Studies(ProgramTest):
    def rows(self, measure):
        experiment = {"raytruth": "experiment/1", "name": "study", "question": "Does it agree?", "source": "none", "seed": 1, "measures": [measure]}
        self.output_of("run", self.write("study.json", experiment), "-o", "out")
        result = json.loads((self.folder / "out" / "study.json").read_text())
        return result["rows"]

    def test_a_cell_whose_picture_has_closed_forms(self):
        size = 16
        rows = self.rows({"kind": "projected_tetrahedra", "meshes": ["cross", "sheared"], "extinctions": [4], "size": size})
        of = {(row["mesh"], row["projection"], row["rule"], row["order"]): row for row in rows}
        # The scalar is 1/2 + x/8 + y/8 - 3 z/4, and the cell reaches from |x| - 1/2 to 1/2 - |y|.
        worst = 0
        places = [(2 * i + 1) / size - 1 for i in range(size)]
        for x, y in itertools.product(places, places):
            length = 1 - abs(x) - abs(y)
            if length > 0:
                depth = 4 * length * (0.5 + (x + y) / 8 - 0.375 * (abs(x) - abs(y)))
                worst = max(worst, abs(math.expm1(-depth) - length * math.expm1(-2)))
        row = of["cross", "parallel", "projected_opacity", "exact"]
        self.assertAlmostEqual(row["opacity_error_max"], worst, delta=1e-13)
        self.assertLess(of["cross", "parallel", "projected_exponential", "exact"]["opacity_error_max"], 1e-13)
        self.assertLess(of["sheared", "parallel", "projected_table", "exact"]["error_max"], 1e-12)
        self.assertGreater(of["sheared", "parallel", "projected_table", "centre"]["error_max"], 1e-3)

    def test_costs_are_those_of_a_count(self):
        measure = {"kind": "cell_tables", "shapes": ["ramp"], "optical_depths": [2], "sizes": [9], "distances": [5, 9], "counted_sizes": [16], "look_ups": 32}
        rows = self.rows(measure)
        costs = {(row["part"], row["builder"]): row for row in rows if row["part"] != "look_up"}
        composites = 16 * sum(abs(i - j) - 1 for i in range(16) for j in range(16) if i != j)
        self.assertEqual(costs["cost", "brute_force"]["composites"], composites)
        self.assertEqual(costs["cost_of_distances", "subrange"]["order_composites"], 1)
        look_ups = {(row["distance_axis"], row["distances"]): row for row in rows if row["part"] == "look_up"}
        # The mean of a ramp is linear in both scalars, so that nothing is left of the opacity's error.
        for count in (5, 9):
            self.assertLess(look_ups["mean_depth", count]["opacity_error"], 1e-14)
            self.assertGreater(look_ups["uniform", count]["opacity_error"], 1e-4)
        self.assertEqual(look_ups["uniform", 5]["bytes_float32"], 4 * 9 * 9 * 4 * 4)


POINT_LINES = "\n".join(" ".join(map(str, point)) for point in POINTS) + "\n"
FILES = {
    "a.vtu": f"""<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>
<Piece NumberOfPoints="5" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{POINT_LINES}</DataArray></Points>
<Cells><DataArray Name="connectivity" type="Int64" format="ascii">0 1 2 3
1 2 3 4</DataArray><DataArray Name="offsets" type="Int64" format="ascii">4 8</DataArray>
<DataArray Name="types" type="UInt8" format="ascii">10 10</DataArray></Cells>
<PointData Scalars="s"><DataArray Name="v" NumberOfComponents="3" type="Float64" format="ascii">{POINT_LINES}</DataArray>
<DataArray Name="s" type="Float64" format="ascii">0 1 0.25 0.5 0.75</DataArray></PointData>
<CellData><DataArray Name="c" type="Float64" format="ascii">0.25 1</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>
""",
    "b.vtk": f"""# vtk DataFile Version 3.0
a title
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
{POINT_LINES}CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10
10
POINT_DATA 5
SCALARS s double
LOOKUP_TABLE default
0 1 0.25 0.5 0.75
VECTORS v double
{POINT_LINES}CELL_DATA 2
SCALARS c double 1
LOOKUP_TABLE default
0.25 1
""",
    "c.vtk": f"""# vtk DataFile Version 5.1
vtk output
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
{POINT_LINES}METADATA
INFORMATION 1
NAME L2_NORM_RANGE LOCATION vtkDataArray
DATA 2 0 1

CELLS 3 8
OFFSETS vtktypeint64
0 4 8
CONNECTIVITY vtktypeint64
0 1 2 3 1 2 3 4
CELL_TYPES 2
10
10

POINT_DATA 5
FIELD FieldData 2
s 1 5 double
0 1 0.25 0.5 0.75
v 3 5 double
{POINT_LINES}
CELL_DATA 2
FIELD FieldData 1
c 1 2 double
0.25 1
""",
}

if __name__ == "__main__":
    unittest.main()
