"""`raytruth table`: files that other programs read, with a measured error beside them, or a refusal and no file."""

import ast
import json
import math
import struct
import unittest


from test_schemas import validator
from support import SOURCE, ProgramTest, changed

try:
    import numpy
except ImportError:
    numpy = None

OPTICS = [{"s": s, "extinction": 2, "color": [1, 0.5, 0.25]} for s in (0, 255)]
CASE = {
    "transfer_function": {"points": OPTICS},
    "emission": "associated",
    "builder": "exact",
    "size": 8,
    "length": 1,
    "range": [0, 255],
    "format": "float32",
}
RAMP = changed(CASE, "/transfer_function/points/0", {"s": 0, "extinction": 0, "color": [0, 0, 1]})
PARABOLAS = changed(changed(CASE, "/builder", "second_order_iterations"), "/iterations", 16)
OPACITIES = {"points": [{"s": 0, "opacity": 0, "color": [1, 1, 1]}, {"s": 255, "opacity": 0.5, "color": [1, 1, 1]}], "unit_length": 1}
RADIUS = {"axis": "signed", "low": 0.25, "high": 4, "count": 2}
QUADRATIC = changed(changed(CASE, "/builder", "quadratic_gray"), "/radius", RADIUS)
PSI = {"builder": "partial_pre_integration", "size": 16}
OPACITY = 1 - math.exp(-2)
SLAB = [OPACITY, 0.5 * OPACITY, 0.25 * OPACITY, OPACITY]

SCHEMAS = [json.loads((SOURCE / f"experiments/schemas/{name}.json").read_text()) for name in ("table", "case", "names")]


def schema_accepts(case):
    return validator("table").is_valid(case)


class TableTest(ProgramTest):
    def make(self, case, name="table.npy"):
        """The table's file, and what stands beside it."""
        self.output_of("table", self.write("case.json", case), "-o", name)
        self.assertTrue(schema_accepts(case))
        return self.folder / name, json.loads((self.folder / f"{name}.json").read_text())


class Files(TableTest):
    def test_a_constant_transfer_function_in_npy_by_hand(self):
        file, beside = self.make(CASE)
        data = file.read_bytes()
        self.assertEqual(data[:8], b"\x93NUMPY\x01\x00")
        (length,) = struct.unpack("<H", data[8:10])
        self.assertEqual((10 + length) % 64, 0)
        header = ast.literal_eval(data[10 : 10 + length].decode().strip())
        self.assertEqual(header, {"descr": "<f4", "fortran_order": False, "shape": (8, 8, 4)})
        values = struct.unpack("<256f", data[10 + length :])
        for i, value in enumerate(values):
            self.assertAlmostEqual(value, SLAB[i % 4], delta=1e-7)
        self.assertLess(beside["error"]["max"], 1e-7)
        self.assertEqual(beside["shape"], [8, 8, 4])

    def test_nrrd(self):
        file, _ = self.make(CASE, "table.nrrd")
        header, _, data = file.read_bytes().partition(b"\n\n")
        self.assertEqual(
            header.decode().splitlines(),
            ["NRRD0004", "type: float", "dimension: 3", "sizes: 4 8 8", "endian: little", "encoding: raw"],
        )
        for i, (value,) in enumerate(struct.iter_unpack("<f", data)):
            self.assertAlmostEqual(value, SLAB[i % 4], delta=1e-7)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_numpy_reads_every_format(self):
        truth = numpy.load(self.make(changed(RAMP, "/format", "float64"))[0])
        for name, dtype, scale, error in (
            ("float32", "<f4", 1, 2**-25),
            ("float16", "<f2", 1, 2**-12),
            ("unorm16", "<u2", 65535, 0.5 / 65535),
            ("unorm8", "|u1", 255, 0.5 / 255),
        ):
            table = numpy.load(self.make(changed(RAMP, "/format", name))[0])
            self.assertEqual((table.dtype.str, table.shape), (dtype, (8, 8, 4)))
            self.assertLessEqual(abs(table.astype(float) / scale - truth).max(), error + 1e-9, name)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_the_stated_error_is_that_of_the_stored_numbers(self):
        """By look-ups of a reader's own, at the very place that is stated, and at every node."""
        largest = {"float64": None, "float32": 1, "float16": 1, "unorm16": 65535, "unorm8": 255}
        for name, scale in largest.items():
            exact = numpy.load(self.make(changed(RAMP, "/format", "float64"))[0])
            file, beside = self.make(changed(RAMP, "/format", name))
            table = numpy.load(file).astype(float) / (scale or 1)
            self.assertEqual(beside["error"]["rounding_max"], abs(table - exact).max())
            n = len(table)
            low, high = RAMP["range"]
            place = [(beside["error"]["max_at"][axis] - low) / (high - low) * (n - 1) for axis in ("back", "front")]
            (i, v), (j, u) = ((min(int(x), n - 2), x - min(int(x), n - 2)) for x in place)
            found = (1 - v) * ((1 - u) * table[i, j] + u * table[i, j + 1]) + v * ((1 - u) * table[i + 1, j] + u * table[i + 1, j + 1])
            case = {
                "signal": {"kind": "piecewise_polynomial", "breaks": [0, RAMP["length"]],
                           "coefficients": [[beside["error"]["max_at"]["front"],
                                             (beside["error"]["max_at"]["back"] - beside["error"]["max_at"]["front"]) / RAMP["length"]]]},
                "transfer_function": RAMP["transfer_function"], "sampling": {"kind": "cells"}, "schemes": ["reference"],
            }
            truth = self.json_of("eval", "-", stdin=case)["reference"]
            error = abs(found - numpy.array([*truth["color"], truth["opacity"]])).max()
            self.assertAlmostEqual(error, beside["error"]["max"], delta=1e-14 + truth["error_bound"])

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_the_error_of_psi_is_that_of_the_stored_numbers(self):
        errors = []
        for name in ("float64", "unorm16", "unorm8"):
            case = changed(changed(PSI, "/format", name), "/size", 256)
            _, beside = self.make(case)
            errors.append(beside["error"]["max"])
            self.assertLessEqual(beside["error"]["rounding_max"], {"float64": 0, "unorm16": 0.5 / 65535, "unorm8": 0.5 / 255}[name])
        self.assertGreater(beside["error"]["rounding_max"], 0.4 / 255)
        for error, rounding in zip(errors[1:], (0.5 / 65535, 0.5 / 255)):
            self.assertNotEqual(error, errors[0])
            self.assertLessEqual(abs(error - errors[0]), rounding)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_the_front_scalar_varies_faster_than_the_back_one(self):
        """Under a ramp the slab from low to high scalars shows its blue front more than the one from high to low."""
        table = numpy.load(self.make(RAMP)[0])
        self.assertGreater(table[7, 0, 2], table[0, 7, 2])
        self.assertAlmostEqual(table[7, 0, 3], table[0, 7, 3], places=6)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_tables_of_second_order_and_of_psi(self):
        for builder in ("second_order_iterations", "second_order_nyquist", "second_order_exact"):
            case = changed(PARABOLAS, "/builder", builder)
            file, beside = self.make(case if "iterations" in builder else changed(case, "/iterations", ...))
            table = numpy.load(file)
            self.assertEqual(table.shape, (8, 8, 8, 4))
            self.assertLess(abs(table - SLAB).max(), 1e-6)
            self.assertLess(beside["error"]["max"], 1e-6)
        file, beside = self.make(PSI)
        psi = numpy.load(file)
        self.assertEqual(psi.shape, (16, 16))
        self.assertEqual((psi[0, 0], psi[15, 15]), (1, 0))
        self.assertLess(beside["error"]["max"], 0.1)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_quadratic_tables(self):
        file, beside = self.make(QUADRATIC)
        table = numpy.load(file)
        self.assertEqual(table.shape, (5, 8, 8, 4))
        self.assertLess(abs(table - SLAB).max(), 1e-6)
        self.assertLess(beside["error"]["max"], 1e-6)
        self.assertLess(beside["error"]["entries"]["error_bound"], 1e-12)
        self.assertEqual([round(a, 9) for a in beside["radius"]["curvatures"]], [-16, -0.0625, 0, 0.0625, 16])
        # As printed: R = 2^-3 to 2^3 above the linear table, every 32nd gray value.
        printed = changed(changed(QUADRATIC, "/builder", "quadratic_gray_printed"), "/radius", ...)
        file, beside = self.make(printed)
        self.assertEqual(numpy.load(file).shape, (8, 8, 8, 4))
        self.assertEqual(beside["high"], 224)
        self.assertIsNone(beside["error"]["entries"]["error_bound"])
        self.assertGreater(beside["error"]["max"], 0.01)

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_an_entry_of_a_quadratic_table_is_the_slab_of_order2(self):
        table = numpy.load(self.make(changed(changed(QUADRATIC, "/transfer_function", RAMP["transfer_function"]), "/format", "float64"))[0])
        front, back, a = 255 * 2 / 7, 255 * 5 / 7, -16
        case = {
            "signal": {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[front, back - front - a, a]]},
            "transfer_function": RAMP["transfer_function"], "sampling": {"kind": "constant", "step": 0.5},
            "schemes": ["reference", "order2", "quadratic_gray", "quadratic_gray_printed"],
        }
        answer = self.json_of("eval", "-", stdin=case)
        truth = numpy.array([*answer["reference"]["color"], answer["reference"]["opacity"]])
        self.assertLess(abs(table[0, 5, 2] - truth).max(), 1e-12)
        for name, least, most in (("order2", 0, 1e-12), ("quadratic_gray", 0, 1e-12), ("quadratic_gray_printed", 1e-4, 1)):
            scheme = answer["schemes"][name]
            error = abs(numpy.array([*scheme["color"], scheme["opacity"]]) - truth).max()
            self.assertTrue(least <= error <= most, (name, error))

    @unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test_light_by_the_gradient_of_the_opacity(self):
        """Along a straight ramp of extinction 2 over 255 gray values dtau/ds is the same everywhere."""
        ramp = changed(QUADRATIC, "/transfer_function", RAMP["transfer_function"])
        lit = changed(ramp, "/light", "diffuse")
        diffuse = numpy.load(self.make(lit)[0])
        printed = numpy.load(self.make(changed(lit, "/gradient", "printed"))[0])
        self.assertLess(abs(printed[..., :3] - diffuse[..., :3] * 2 / 255).max(), 1e-6)
        specular = changed(changed(changed(ramp, "/light", "specular"), "/exponent", 8), "/v", {"low": -0.5, "high": 0.5, "count": 3})
        file, beside = self.make(specular)
        self.assertEqual(numpy.load(file).shape, (3, 5, 8, 8, 4))
        self.assertEqual(beside["radius"]["v"], [-0.5, 0, 0.5])
        self.assertLess(abs(numpy.load(file)[1] - diffuse).max(), 1e-6)  # v = 0: as wide as diffuse light

    def test_the_error_is_that_of_the_builder(self):
        """Without attenuation a constant slab sends out its depth times its colour: 2 (1, 1/2, 1/4)."""
        _, beside = self.make(changed(CASE, "/builder", "no_attenuation"))
        self.assertAlmostEqual(beside["error"]["max"], 2 - OPACITY, delta=1e-7)

    def test_weighted_tables_state_their_error(self):
        """Weighted tables take all of an interval's light to its middle: of second order in the intervals' width.
        Moments are those of homogeneous intervals: exact for a constant transfer function, up to the interpolation
        between equal entries."""
        for name in ("moment_0", "moment_1", "moment_2", "moment_3", "moment_tent"):
            _, beside = self.make(changed(changed(CASE, "/builder", name), "/format", "float64"))
            self.assertLess(beside["error"]["max"], 1e-13, name)
            self.assertLess(beside["error"]["error_bound"], 1e-13)
        for name in ("front_weighted", "back_weighted_specular", "front_weighted_difference"):
            coarse, fine = (
                self.make(changed(changed(CASE, "/builder", name), "/size", size))[1]["error"]["l1"] for size in (9, 65)
            )
            self.assertGreater(coarse, 1e-4)
            self.assertLess(fine, coarse / 4)

    def test_every_builder_of_the_catalogue(self):
        listed = [entry["name"] for entry in self.json_of("list", "tables", "--json")]
        names = SCHEMAS[2]["$defs"]["table_builder"]["enum"]
        self.assertEqual(
            names
            + SCHEMAS[2]["$defs"]["second_order_builder"]["enum"]
            + SCHEMAS[2]["$defs"]["quadratic_gray_builder"]["enum"]
            + ["partial_pre_integration"],
            listed,
        )
        for name in names:
            self.make(changed(CASE, "/builder", name))

    def test_the_same_bytes_on_any_number_of_threads(self):
        case = self.write("case.json", RAMP)
        for threads in "12":
            self.output_of("table", case, "-j", threads, "-o", f"{threads}.npy")
        self.assertEqual(*((self.folder / f"{threads}.npy").read_bytes() for threads in "12"))


class Refusals(TableTest):
    bad = [
        (changed(CASE, "/size", 1), "/size", "2"),
        (changed(CASE, "/size", 4097), "/size", "4096"),
        (changed(PARABOLAS, "/size", 257), "/size", "256"),
        (changed(CASE, "/length", 0), "/length", "> 0"),
        (changed(CASE, "/length", 1e300), "/length", "optical depth"),
        (changed(changed(PARABOLAS, "/transfer_function", RAMP["transfer_function"]), "/length", 1e300), "/length", "depth"),
        (changed(CASE, "/range", [1, 1]), "/range", "ascending"),
        (changed(CASE, "/range", [0]), "/range", "2"),
        (changed(CASE, "/range", ...), "/range", ""),
        (changed(CASE, "/builder", "exakt"), "/builder", "perhaps exact"),
        (changed(CASE, "/format", "float8"), "/format", "float16"),
        (changed(CASE, "/emission", "both"), "/emission", "plain"),
        (changed(CASE, "/iterations", 8), "/iterations", ""),
        (changed(PARABOLAS, "/iterations", ...), "/iterations", ""),
        (changed(PARABOLAS, "/iterations", 0), "/iterations", "1"),
        (changed(CASE, "/unknown", 1), "/unknown", ""),
        (changed(PSI, "/length", 1), "/length", ""),
        (changed(QUADRATIC, "/size", 1025), "/size", "1024"),
        (changed(QUADRATIC, "/radius/axis", "equal"), "/radius/axis", "equal_steps"),
        (changed(QUADRATIC, "/radius/low", 8), "/radius", "low < high"),
        (changed(QUADRATIC, "/radius/axis", "powers_of_two"), "/radius", "high = 2^(k + count - 1)"),
        (changed(QUADRATIC, "/radius/count", 0), "/radius/count", "1"),
        (changed(QUADRATIC, "/radius/high", ...), "/radius/high", ""),
        (changed(changed(QUADRATIC, "/builder", "quadratic_gray_printed"), "/size", 33), "/size", "every (256 / n)-th"),
        (changed(CASE, "/radius", RADIUS), "/radius", ""),
        (changed(changed(changed(QUADRATIC, "/size", 1024), "/radius/axis", "equal_steps"), "/radius/count", 400), "/size", "67108864"),
        (changed(changed(QUADRATIC, "/light", "diffuse"), "/transfer_function", OPACITIES), "/transfer_function", "state the extinction"),
        (changed(QUADRATIC, "/exponent", 8), "/exponent", "diffuse or specular"),
        (changed(changed(QUADRATIC, "/light", "specular"), "/exponent", 8), "/v", ""),
        (changed(changed(QUADRATIC, "/light", "diffuse"), "/exponent", 8), "/exponent", "specular"),
        (changed(CASE, "/transfer_function/points/0/extinction", -1), "/transfer_function/points/0/extinction", "0"),
    ]

    def test_bad_cases(self):
        only_program = {"ascending", "optical depth", "depth", "low < high", "high = 2^(k + count - 1)", "every (256 / n)-th", "67108864", "state the extinction"}  # what no schema can say
        for case, pointer, words in self.bad:
            with self.subTest(pointer=pointer, words=words):
                done = self.run_program("table", self.write("case.json", case), "-o", "bad.npy")
                self.assert_refused(done, f"case.json: {pointer}", words)
                self.assertEqual(self.names_in_folder(), ["case.json"])
                self.assertEqual(schema_accepts(case), words in only_program)

    def test_files_of_other_kinds_and_places(self):
        case = self.write("case.json", CASE)
        for name, words in (("table.png", ".npy and .nrrd"), ("table", ".npy and .nrrd"), ("no/folder.npy", "written")):
            self.assert_refused(self.run_program("table", case, "-o", name), words, code=4 if words == "written" else 2)
        self.write("case.json", changed(CASE, "/format", "float16"))
        self.assert_refused(self.run_program("table", case, "-o", "half.nrrd"), "case.json: /format", "NRRD")
        self.assertEqual(self.names_in_folder(), ["case.json"])

    def test_numbers_above_1_in_fixed_point_are_told(self):
        case = changed(changed(CASE, "/builder", "no_attenuation"), "/format", "unorm8")
        done = self.run_program("table", self.write("case.json", case), "-o", "clamped.npy")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"64 numbers above 1", done.stderr)


class InShaders(TableTest):
    """The table by a compute shader is the one by the CPU, and its error is measured the same way."""

    def made(self, case, *options):
        file = self.write("case.json", case)
        self.output_of("table", file, "-o", "table.npy", *options)
        return struct.unpack("<256f", (self.folder / "table.npy").read_bytes()[-1024:]), json.loads(
            (self.folder / "table.npy.json").read_text()
        )

    def test_brute_force(self):
        case = changed(RAMP, "/builder", "brute_force")
        if self.run_program("table", self.write("case.json", case), "-o", "table.npy", "--gl", "osmesa").returncode == 3:
            self.skipTest("OSMesa is not there")
        by_cpu, beside_cpu = self.made(case)
        by_shader, beside = self.made(case, "--gl", "osmesa")
        for one, other in zip(by_cpu, by_shader):
            self.assertAlmostEqual(one, other, delta=1e-5)
        self.assertNotIn("gl", beside_cpu)
        self.assertEqual(beside["gl"]["platform"], "osmesa")
        self.assertAlmostEqual(beside["error"]["max"], beside_cpu["error"]["max"], delta=1e-5)

    def test_refusals(self):
        case = self.write("case.json", RAMP)
        self.assert_refused(
            self.run_program("table", case, "-o", "table.npy", "--gl", "osmesa"), "case.json: /builder", "brute_force", "without --gl"
        )
        bent = changed(PARABOLAS, "/transfer_function/points/0/s", 100)
        self.assert_refused(
            self.run_program("table", self.write("case.json", bent), "-o", "table.npy", "--gl", "osmesa"),
            "case.json: /transfer_function",
            "between the table's entries",
        )
        self.assertEqual(self.names_in_folder(), ["case.json"])


class InBinary32(TableTest):
    def test_it_is_said_and_within_its_error(self):
        tables = {}
        for name in ("float32", "float64"):
            case = changed(changed(RAMP, "/builder", "subrange_means"), "/format", name)
            file, beside = self.make(case)
            self.assertEqual("arithmetic" in beside["error"], name == "float32")
            tables[name] = [value for (value,) in struct.iter_unpack("<f" if name == "float32" else "<d", file.read_bytes()[-256 * (4 if name == "float32" else 8):])]
        differences = [abs(a - b) for a, b in zip(*tables.values())]
        self.assertLessEqual(max(differences), 1e-5)
        self.assertGreater(max(differences), 0)


if __name__ == "__main__":
    unittest.main()
