"""Volumes' files in scenes, cases and experiments: NumPy arrays, and what may be said beside "volume"."""

import json
import unittest

import numpy

from support import EXPERIMENT, RAY, ProgramTest, changed

SHAPE = (4, 3, 5)  # z, y, x
ARRAY = numpy.random.default_rng(1).integers(0, 100, SHAPE)
INLINE = {"size": SHAPE[::-1], "values": ARRAY.ravel().tolist()}
POINTS = {"points": [{"s": s, "extinction": s / 50, "color": [1, s / 100, 0.5]} for s in (0, 100)]}
SCENE = {
    "volume": {**INLINE, "spacing": [0.5, 1, 2]},
    "transfer_function": POINTS,
    "scheme": "reference",
    "camera": {"eye": [9, 7, 30], "target": [1, 1, 3], "up": [0, 1, 0], "height": 8, "size": [6, 5]},
}
CASE = {
    "signal": {"kind": "trilinear", "volume": INLINE, "origin": [-1, 0.3, -0.4], "direction": [2, 1, 1.5]},
    "transfer_function": POINTS,
    "sampling": {"kind": "cells"},
    "schemes": ["order1"],
}


class NumPy(ProgramTest):
    def arrays(self):
        """The same volume in types and orders that NumPy has."""
        for dtype in ("u1", "i1", "<u2", ">i2", "<i4", ">u4", "<i8", ">u8", "<f4", ">f4", "<f8", ">f8"):
            yield dtype, ARRAY.astype(dtype)
        yield "Fortran", numpy.asfortranarray(ARRAY.astype("<f4"))
        yield "axes of size 1", ARRAY.astype("u1").reshape(1, *SHAPE, 1)

    def test_every_type_and_order_is_the_same_volume(self):
        self.output_of("render", self.write("scene.json", SCENE), "-o", "inline.npy")
        image = numpy.load(self.folder / "inline.npy")
        answer = self.json_of("eval", "-", stdin=CASE)
        scene = {**SCENE, "volume": "v.npy", "spacing": [0.5, 1, 2]}
        for what, array in self.arrays():
            with self.subTest(what=what):
                numpy.save(self.folder / "v.npy", array)
                done = self.run_program("render", self.write("scene.json", scene), "-o", "file.npy")
                self.assertEqual((done.returncode, done.stderr), (0, b""))
                self.assertNotIn("warnings", json.loads(done.stdout))
                numpy.testing.assert_array_equal(numpy.load(self.folder / "file.npy"), image)
                self.assertEqual(self.json_of("eval", self.write("case.json", changed(CASE, "/signal/volume", "v.npy"))), answer)
                info = self.json_of("info", "v.npy", "--json", "--spacing", "0.5", "1", "2")
                self.assertEqual((info["size"], info["spacing"], info["format"]), ([5, 3, 4], [0.5, 1, 2], "NPY"))
                self.assertEqual((info["minimum"], info["maximum"]), (ARRAY.min(), ARRAY.max()))

    def test_the_first_axis_is_z(self):
        array = numpy.zeros((2, 3, 4))
        array[1, 0, 0] = 7
        numpy.save(self.folder / "v.npy", array)
        case = changed(CASE, "/signal", {"kind": "trilinear", "volume": "v.npy", "origin": [0, 0, -1], "direction": [0, 0, 1]})
        case["transfer_function"] = {"points": [{"s": 0, "extinction": 0, "color": [1, 1, 1]}, {"s": 7, "extinction": 7, "color": [1, 1, 1]}]}
        answer = self.json_of("eval", self.write("case.json", case))
        # From voxel (0, 0, 0) to (0, 0, 1) the scalar grows from 0 to 7, and stays for the last half: a depth of 7/2 + 7/2.
        self.assertEqual(answer["length"], 2)
        self.assertAlmostEqual(answer["reference"]["opacity"], 1 - numpy.exp(-7), places=14)

    def test_fields_of_experiments(self):
        numpy.save(self.folder / "v.npy", numpy.random.default_rng(1).random((16, 16, 16)))
        field = {"name": "white", "kind": "volume", "volume": "v.npy", "spacing": [1, 1, 2]}
        result = self.json_of("run", self.write("e.json", changed(EXPERIMENT, "/fields/0", field)))
        self.assertEqual((result["fields"]["white"]["file"], result["fields"]["white"]["size"]), ("v.npy", [16, 16, 16]))
        self.assertNotIn("warnings", result["fields"]["white"])

    def test_a_scene_without_spacing_says_so(self):
        numpy.save(self.folder / "v.npy", ARRAY)
        done = self.run_program("render", self.write("scene.json", {**SCENE, "volume": "v.npy"}), "-o", "i.npy")
        (warning,) = json.loads(done.stdout)["warnings"]
        self.assertIn('scene.json: /volume: warning: v.npy: the file states no spacing, so 1 is taken along every axis; "spacing": [x, y, z]', warning)
        self.assertEqual(done.stderr.decode(), f"raytruth: {warning}\n")
        self.assertIn("(the file states none)", self.output_of("info", "v.npy"))


class BesideTheFile(ProgramTest):
    """The members "nan", "time_step" and "spacing"."""

    def setUp(self):
        super().setUp()
        array = ARRAY.astype("f4")
        array[0, 0, 0] = array[2, 1, 3] = numpy.nan
        numpy.save(self.folder / "nan.npy", array)
        # Two volumes, one behind the other.
        header = "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 5 3 4 2\nkinds: space space space time\nencoding: raw\n\n"
        self.write("time.nrrd", header.encode() + bytes(ARRAY.size) + ARRAY.astype("u1").tobytes())

    def eval(self, *arguments, **members):
        case = {**CASE, "signal": {**CASE["signal"], **members}}
        return self.run_program("eval", self.write("case.json", case), *arguments)

    def test_nan(self):
        refused = "nan.npy: 2 of 60 voxels are NaN, the first is voxel (0, 0, 0); only finite values are allowed; --nan VALUE"
        self.assert_refused(self.eval(volume="nan.npy"), "case.json: /signal/volume: ", refused)
        inline = changed(CASE, "/signal/volume/values", numpy.nan_to_num(numpy.load(self.folder / "nan.npy"), nan=7).ravel().tolist())
        right = self.json_of("eval", "-", stdin=inline)
        for done in (self.eval(volume="nan.npy", nan=7), self.eval("--nan", "7", volume="nan.npy"), self.eval("--nan", "9", volume="nan.npy", nan=7)):
            answer = json.loads(done.stdout)
            (warning,) = answer.pop("warnings")
            self.assertIn("they are given the value 7", warning)
            self.assertEqual(answer, right)
            self.assertIn(warning, done.stderr.decode())
        cases = [{**CASE, "signal": {**CASE["signal"], "volume": "nan.npy", "nan": value}} for value in (7, 7, 8)]
        first, second, third = self.json_of("eval", self.write("cases.json", cases))
        self.assertEqual(first["schemes"], second["schemes"])
        self.assertNotEqual(second["schemes"], third["schemes"])
        self.assert_refused(self.eval(volume="nan.npy", nan="0"), "case.json: /signal/nan: ")
        scene = {**SCENE, "volume": "nan.npy", "spacing": [0.5, 1, 2]}
        self.assertIn("the value 7", self.json_of("render", self.write("scene.json", scene), "-o", "i.npy", "--nan", "7")["warnings"][0])

    def test_time_step(self):
        refused = "time.nrrd: axis 3 has the kind time: it holds 2 volumes; one volume is allowed: --time-step N"
        self.assert_refused(self.eval(volume="time.nrrd"), refused)
        self.assertEqual(json.loads(self.eval(volume="time.nrrd", time_step=1).stdout), self.json_of("eval", "-", stdin=CASE))
        self.assert_refused(self.eval(volume="time.nrrd", time_step=2), "the time step 2 is asked for; 0 to 1 are allowed")
        for wrong in (-1, 0.5, "0"):
            self.assert_refused(self.eval(volume="time.nrrd", time_step=wrong), "case.json: /signal/time_step: ")
        self.assertIn("5 x 3 x 4, a series of 2", self.output_of("list", "volumes", "--data", "."))

    def test_spacing(self):
        answer = json.loads(self.eval(volume="nan.npy", nan=0, spacing=[1, 2, 3]).stdout)
        self.assertIn("/signal/spacing: warning: it changes nothing: the rays of a case are in voxels", answer["warnings"][0])
        for wrong in ([1, 1], [1, 1, 0], 1, []):
            self.assert_refused(self.eval(volume="nan.npy", nan=0, spacing=wrong), "case.json: /signal/spacing")

    def test_they_are_of_files(self):
        for member, value in (("nan", 0), ("time_step", 0), ("spacing", [1, 1, 1])):
            self.assert_refused(self.eval(**{member: value}), f"case.json: /signal/{member}: ", f"{member} of a file only")

    def test_warnings_stand_in_results(self):
        numpy.save(self.folder / "v.npy", numpy.where(numpy.arange(4096) == 5, numpy.nan, 1.0 * (numpy.arange(4096) % 13)).reshape(16, 16, 16))
        field = {"name": "white", "kind": "volume", "volume": "v.npy", "nan": 3}
        result = self.json_of("run", self.write("e.json", changed(EXPERIMENT, "/fields/0", field)))
        self.assertIn("1 of 4096 voxels are NaN", result["fields"]["white"]["warnings"][0])
        self.assertEqual(result["experiment"]["fields"][0]["nan"], 3)

    def test_memory_limit(self):
        done = self.eval("--memory-limit", "479", volume="nan.npy", nan=0)
        self.assert_refused(done, "nan.npy: the header announces 5 x 3 x 4 voxels of type float32, which need 480 bytes of memory", "--memory-limit SIZE")
        self.assertEqual(self.eval("--memory-limit", "480", volume="nan.npy", nan=0).returncode, 0)
        self.assert_refused(self.eval("--memory-limit", "much", volume="nan.npy", nan=0), "--memory-limit")

    def test_memory_limit_of_what_is_no_volume(self):
        def refused(*arguments, words):
            self.assert_refused(self.run_program(*arguments), *words, "--memory-limit SIZE")

        self.write("field.json", changed(EXPERIMENT, "/fields/0/size", 2048))
        refused("run", "field.json", "--memory-limit", "1G", words=["field.json: /fields/0: ", "2048 x 2048 x 2048 voxels", "1073741824"])
        self.write("rays.json", changed(EXPERIMENT, "/rays/count", 10**8))
        refused("run", "rays.json", "--memory-limit", "1G", words=["rays.json: /rays/count: ", "100000000 rays", "1073741824"])
        self.write("lists.json", "[" + "[]," * 1000000 + "[]]")
        refused("run", "lists.json", "--memory-limit", "1M", words=["lists.json: ", "1048576"])
        # Whoever bounds volumes bounds no case that fits into 64 MiB.
        self.write("lists.json", "[" + "[]," * 100000 + "[]]")
        self.assert_refused(self.run_program("run", "lists.json", "--memory-limit", "1M"), "an object")
        self.write("scene.json", {**SCENE, "camera": {"size": [16384, 16384]}})
        refused("render", "scene.json", "-o", "a.npy", "--memory-limit", "1G", words=["scene.json: /camera/size: ", "16384 x 16384 pixels"])
        self.write("image.pfm", b"PF\n16384 16384\n-1\n")
        refused("compare", "image.pfm", "image.pfm", "--memory-limit", "1G", words=["image.pfm: ", "16384 x 16384 pixels"])


if __name__ == "__main__":
    unittest.main()
