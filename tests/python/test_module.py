"""The Python module: the program's numbers to the bit, numpy in and out, and what is refused."""

import inspect
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy
import raytruth

PROGRAM = os.environ["RAYTRUTH"]
SOURCE = pathlib.Path(os.environ["RAYTRUTH_SOURCE"])

POINTS = {
    "points": [
        {"s": 0, "extinction": 0, "color": [0, 0, 0]},
        {"s": 0.4, "extinction": 0.1, "color": [1, 0.5, 0.2]},
        {"s": 1, "extinction": 3, "color": [0.2, 0.5, 1]},
    ]
}
RAY = {
    "signal": {"kind": "piecewise_polynomial", "breaks": [0, 1, 2.5], "coefficients": [[0.1, 0.5], [0.6, -0.2, 0.05, 0.01]]},
    "transfer_function": POINTS,
    "sampling": {"kind": "constant", "step": 0.25},
    "schemes": ["reference", "order0_mid", "order1", "order2", "simpson"],
}
TABLE = {"transfer_function": POINTS, "builder": "exact", "size": 24, "length": 1, "range": [0, 1], "format": "float16"}
CAMERA = {"eye": [20, -30, 14], "target": [3.5, 4, 4.5], "up": [0, 0, 1], "height": 14, "size": [12, 9]}


def noise(shape=(10, 9, 8)):
    """Voxels [z, y, x] in [0, 1], every one a multiple of 2^-20."""
    return numpy.random.default_rng(7).integers(0, 1 << 20, size=shape) / (1 << 20)


def inline(array):
    """The array [z, y, x] as documents state it."""
    return {"size": list(array.shape[::-1]), "values": array.ravel().tolist()}


class ModuleTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def program(self, *arguments, document=None):
        """What the program writes to standard output."""
        done = subprocess.run(
            [PROGRAM, *arguments], cwd=self.folder, capture_output=True, input=json.dumps(document).encode() if document else None
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def refusal(self, *arguments, document=None):
        """The line with which the program refuses, without its name."""
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, input=json.dumps(document).encode())
        self.assertEqual(done.returncode, 2)
        return done.stderr.decode().removeprefix("raytruth: ").strip()

    def assert_refused(self, call, *words):
        with self.assertRaises(raytruth.InputError) as caught:
            call()
        for word in words:
            self.assertIn(word, str(caught.exception))


class SameAsTheProgram(ModuleTest):
    def test_cases(self):
        cases = [RAY, {**RAY, "emission": "plain"}]
        self.assertEqual(raytruth.evaluate(cases), json.loads(self.program("eval", "-", document=cases)))

    def test_integrals(self):
        answer = json.loads(self.program("eval", "-", document=RAY))
        signal = raytruth.Signal(RAY["signal"]["breaks"], RAY["signal"]["coefficients"])
        transfer = raytruth.TransferFunction(POINTS)
        truth = raytruth.integral(signal, transfer)
        reference = answer["reference"]
        self.assertEqual((truth.color, truth.opacity, truth.radius), (reference["color"], reference["opacity"], reference["error_bound"]))
        self.assertTrue(truth.converged)
        for scheme, row in answer["schemes"].items():
            found = raytruth.integral(signal, transfer, scheme=scheme, step=0.25)
            self.assertEqual((found.color, found.opacity, found.fetches), (row["color"], row["opacity"], row["samples"]), scheme)
            self.assertIsNone(found.radius)

    def test_rays(self):
        voxels = noise()
        random = numpy.random.default_rng(1)
        origins, directions = random.uniform(-2, 9, size=(20, 3)), random.normal(size=(20, 3))
        for interpolation, signal in {
            "trilinear": {"kind": "trilinear"},
            "bspline_prefiltered": {"kind": "tricubic", "kernel": "bspline", "prefilter": True},
        }.items():
            cases = [
                {
                    **RAY,
                    "signal": {**signal, "volume": inline(voxels), "origin": list(o), "direction": list(d), "border": "voxel_centres"},
                    "schemes": ["reference", "order1"],
                }
                for o, d in zip(origins, directions)
            ]
            answers = json.loads(self.program("eval", "-", document=cases))
            options = {"interpolation": interpolation, "border": "voxel_centres"}
            volume = raytruth.Volume(voxels)
            truth = raytruth.rays(volume, POINTS, origins, directions, **options)
            found = raytruth.rays(volume, POINTS, origins, directions, scheme="order1", step=0.25, **options)
            self.assertEqual(len(truth), 20)
            for i, answer in enumerate(answers):
                reference, row = answer["reference"], answer["schemes"]["order1"]
                self.assertEqual((truth.color[i].tolist(), truth.opacity[i]), (reference["color"], reference["opacity"]))
                self.assertEqual((truth.radius[i], truth.length[i]), (reference["error_bound"], answer["length"]))
                self.assertEqual((found.color[i].tolist(), found.opacity[i], found.fetches[i]), (row["color"], row["opacity"], row["samples"]))
            alone = raytruth.signal_along(volume, origins[3], directions[3], **options)
            self.assertEqual(raytruth.integral(alone, POINTS).color, truth.color[3].tolist())
            self.assertTrue(numpy.isnan(found.radius).all())

    def test_slabs(self):
        table = raytruth.table({**TABLE, "format": "float64"}).values
        for front, back in ((0, 23), (5, 5), (20, 3)):
            found = raytruth.slab(POINTS, front / 23, back / 23)
            self.assertLess(numpy.abs([*found.color, found.opacity] - table[back, front]).max(), 1e-13)
            self.assertLess(found.radius, 1e-13)

    def test_tables(self):
        self.program("table", "-", "-o", "table.npy", document=TABLE)
        expected = numpy.load(self.folder / "table.npy")
        found = raytruth.table(TABLE)
        self.assertEqual((found.values.dtype, found.values.tobytes()), (expected.dtype, expected.tobytes()))
        self.assertEqual({**found.description, "table": "table.npy"}, json.loads((self.folder / "table.npy.json").read_text()))

    def test_images(self):
        voxels = noise()
        for scheme in ({"scheme": "reference"}, {"scheme": "order1", "step": 0.5}):
            scene = {"volume": inline(voxels), "transfer_function": POINTS, "camera": CAMERA, **scheme}
            info = json.loads(self.program("render", "-", "-o", "image.npy", "--binary64", document=scene))
            calls = []
            found = raytruth.render({**scene, "volume": raytruth.Volume(voxels)}, progress=lambda done, of: calls.append((done, of)))
            self.assertEqual(found.pixels.tobytes(), numpy.load(self.folder / "image.npy").tobytes())
            self.assertEqual(found.info["size"], [12, 9])
            self.assertEqual(found.info["volume"], "array")
            self.assertTrue(calls)
            if found.radius is not None:
                self.assertEqual(found.radius.tobytes(), numpy.load(self.folder / "image.radius.npy").tobytes())
                self.assertEqual((found.info["error_bound"], found.info["certified"]), (info["error_bound"], True))
            found.save(str(self.folder / "saved.npy"), binary64=True)
            self.assertEqual((self.folder / "saved.npy").read_bytes(), (self.folder / "image.npy").read_bytes())

    def test_comparisons(self):
        random = numpy.random.default_rng(3)
        a, b = random.uniform(size=(2, 16, 20, 4))
        for name, pixels in (("a.npy", a), ("b.npy", b)):
            numpy.save(self.folder / name, pixels)
        answer = json.loads(self.program("compare", "a.npy", "b.npy"))
        found = raytruth.compare(a, b)
        self.assertEqual({key: answer[key] for key in found}, found)
        self.assertEqual(raytruth.compare(str(self.folder / "a.npy"), b), found)
        self.assertEqual(raytruth.read_image(self.folder / "a.npy").tobytes(), a.tobytes())

    def test_vectors_and_scores(self):
        document = json.loads(self.program("vectors"))
        self.assertEqual(raytruth.vectors(), document)
        answers = {vector["id"]: [0.25, 0.5, 0.125, 0.5] for vector in document["vectors"][::2]}
        lines = ["id,r,g,b,opacity", *(f"{name},{','.join(map(str, answer))}" for name, answer in answers.items())]
        (self.folder / "answers.csv").write_text("\n".join(lines) + "\n")
        (self.folder / "vectors.json").write_text(json.dumps(document))
        for options, arguments in (({}, []), ({"per_vector": True}, ["--per-vector"]), ({"emission": "plain"}, ["--emission", "plain"])):
            expected = json.loads(self.program("score", "vectors.json", "answers.csv", "--json", *arguments))
            self.assertEqual(raytruth.score(document, answers, **options), expected)
        self.assertEqual(raytruth.score(self.folder / "vectors.json", self.folder / "answers.csv"), raytruth.score(document, answers))

    def test_experiments(self):
        experiment = json.loads((SOURCE / "experiments/orders.json").read_text())
        (self.folder / "orders.json").write_text(json.dumps(experiment))
        expected = json.loads(self.program("run", "orders.json", "--profile", "quick"))
        found = raytruth.run(experiment, profile="quick")
        for member in ("rows", "columns", "published", "experiment"):
            self.assertEqual(found[member], expected[member])
        with_folder = raytruth.run(str(self.folder / "orders.json"), profile="quick", folder=str(self.folder / "out"))
        self.assertEqual(json.loads((self.folder / "out/orders.json").read_text()), with_folder)

    def test_lists(self):
        everything = json.loads(self.program("list", "--json"))
        for kind in ("schemes", "shadings", "tables", "measures", "signals"):
            self.assertEqual(raytruth.available(kind), everything[kind])
        self.assertEqual(raytruth.schemes(), everything["schemes"])
        self.assertIn(raytruth.__version__, self.program("--version").decode())


class Arrays(ModuleTest):
    def test_orders_and_types(self):
        voxels = (noise() * 255).astype(numpy.uint8)
        volume = raytruth.Volume(voxels, spacing=(1, 2, 3), name="mine")
        self.assertEqual((volume.size, volume.spacing, volume.name), ((8, 9, 10), (1, 2, 3), "mine"))
        self.assertEqual(volume.range, (voxels.min(), voxels.max()))
        numpy.testing.assert_array_equal(volume.array, voxels)
        self.assertFalse(volume.array.flags.writeable)
        for array, order in ((voxels.T, "xyz"), (numpy.asfortranarray(voxels), "zyx"), (voxels[::-1][::-1], "zyx")):
            numpy.testing.assert_array_equal(raytruth.Volume(array, order=order).array, voxels)
        for kind in (bool, numpy.int8, ">i2", numpy.uint64, numpy.float16, numpy.float32, ">f8"):
            numpy.testing.assert_array_equal(raytruth.Volume(voxels.astype(kind)).array, voxels.astype(kind).astype(float))

    def test_an_array_outlives_its_volume(self):
        array = raytruth.Volume(noise()).array
        numpy.testing.assert_array_equal(array, noise())

    def test_volumes_of_files(self):
        numpy.save(self.folder / "v.npy", noise())
        with self.assertWarnsRegex(raytruth.InputWarning, "states no spacing"):
            volume = raytruth.read_volume(str(self.folder / "v.npy"))
        numpy.testing.assert_array_equal(volume.array, noise())
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(raytruth.read_volume(str(self.folder / "v.npy"), spacing=(1, 1, 2)).spacing, (1, 1, 2))
        self.assert_refused(lambda: raytruth.read_volume("nowhere.nrrd"), "nowhere.nrrd")

    def test_two_volumes_of_one_name(self):
        scenes = [
            {"volume": raytruth.Volume(voxels), "transfer_function": POINTS, "camera": CAMERA, "scheme": "order1", "step": 1}
            for voxels in (numpy.zeros((4, 4, 4)), noise())
        ]
        empty, full = raytruth.evaluate(scenes)
        self.assertNotEqual(empty, full)

    def test_what_arrays_are_refused(self):
        for array, words in (
            (numpy.zeros((2, 2)), ("array", "2 axes")),
            (numpy.zeros((2, 0, 2)), ("array", "no voxels")),
            (numpy.zeros((2, 2, 2), complex), ("array", "complex128")),
            (numpy.array([[["a"]]]), ("array", "<U1")),
            (numpy.full((2, 3, 4), numpy.inf), ("array", "inf", "x 0, y 0, z 0")),
        ):
            self.assert_refused(lambda array=array: raytruth.Volume(array), *words)
        holed = noise()
        holed[3, 2, 1] = numpy.nan
        self.assert_refused(lambda: raytruth.Volume(holed), "x 1, y 2, z 3", "nan=")
        self.assertEqual(raytruth.Volume(holed, nan=-1).array[3, 2, 1], -1)
        self.assert_refused(lambda: raytruth.Volume(noise(), spacing=(1, 0, 1)), "spacing")
        self.assert_refused(lambda: raytruth.Volume(noise(), order="yxz"), "order")
        with self.assertWarnsRegex(raytruth.InputWarning, "2\\^53"):
            raytruth.Volume(numpy.full((1, 1, 1), 2**53 + 1))

    def test_transfer_functions(self):
        extinctions = raytruth.TransferFunction.from_extinctions([0, 0.4, 1], [0, 0.1, 3], [(0, 0, 0), (1, 0.5, 0.2), (0.2, 0.5, 1)])
        self.assertEqual(extinctions.document, POINTS)
        extinction, color = extinctions.at([[0.2], [2]])
        self.assertEqual((extinction.shape, color.shape), ((2, 1), (2, 1, 3)))
        numpy.testing.assert_allclose(extinction, [[0.05], [3]])
        numpy.testing.assert_allclose(color, [[[0.5, 0.25, 0.1]], [[0.2, 0.5, 1]]])
        opacities = raytruth.TransferFunction.from_opacities([0, 1], [0, 0.75], [(1, 1, 1)] * 2, unit_length=2)
        numpy.testing.assert_allclose(opacities.at(1)[0], -numpy.log(0.25) / 2)
        self.assertEqual(opacities.document["unit_length"], 2)
        again = raytruth.TransferFunction(opacities.document)
        ray = raytruth.Signal([0, 1], [[0, 1]])
        self.assertEqual(raytruth.integral(ray, again).opacity, raytruth.integral(ray, opacities).opacity)
        self.assert_refused(lambda: raytruth.TransferFunction.from_extinctions([0, 1], [0, -1], [(0, 0, 0)] * 2), "point 1")
        self.assert_refused(lambda: raytruth.TransferFunction.from_extinctions([0, 1], [0], [(0, 0, 0)] * 2), "extinction")
        self.assert_refused(lambda: raytruth.TransferFunction.from_opacities([0, 1], [0, 2], [(0, 0, 0)] * 2), "point 1")


class Refusals(ModuleTest):
    def test_the_text_is_the_programs(self):
        for document in ({**RAY, "schemes": ["ordre1"]}, {**RAY, "sampling": {"kind": "constant", "step": -1}}, {"nonsense": 1}):
            expected = self.refusal("eval", "-", document=document)
            with self.assertRaises(raytruth.InputError) as caught:
                raytruth.evaluate(document)
            self.assertEqual(str(caught.exception).split(": ", 1)[1], expected.split(": ", 1)[1])
        self.assertTrue(issubclass(raytruth.InputError, ValueError))

    def test_what_has_no_json(self):
        self.assert_refused(lambda: raytruth.evaluate({**RAY, "schemes": {1, 2}}), "/schemes", "set")
        self.assert_refused(lambda: raytruth.evaluate({1: 2}), "key")
        self.assert_refused(lambda: raytruth.evaluate({**RAY, "sampling": {"kind": "constant", "step": float("nan")}}), "/sampling/step", "nan")
        endless = []
        endless.append(endless)
        self.assert_refused(lambda: raytruth.evaluate(endless), "64")

    def test_rays(self):
        volume = raytruth.Volume(noise())
        three = numpy.zeros((3, 3))
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, [[1, 0, 0], [0, 0, 0], [1, 0, 0]]), "ray 1", "direction")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, numpy.ones((2, 3))), "directions", "2")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, [0, 0], [1, 0, 0]), "origins")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, [1, 0, 0], lengths=[1, -1, 1]), "ray 1", "length")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, [1, 0, 0], scheme="ordre1"), "scheme", "ordre1")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, [1, 0, 0], interpolation="cubic"), "interpolation", "trilinear")
        self.assert_refused(lambda: raytruth.rays(volume, POINTS, three, [1, 0, 0], threads=-1), "threads")
        self.assertEqual(len(raytruth.rays(volume, POINTS, numpy.zeros((0, 3)), [1, 0, 0])), 0)

    def test_images(self):
        self.assert_refused(lambda: raytruth.compare(numpy.zeros((2, 2)), numpy.zeros((2, 2, 3))), "reference")
        self.assert_refused(lambda: raytruth.compare(numpy.zeros((2, 2, 3)), numpy.zeros((2, 3, 3))), "size")

    def test_the_limit_of_memory(self):
        before = raytruth.memory_limit()
        try:
            raytruth.memory_limit(1000)
            self.assert_refused(lambda: raytruth.Volume(numpy.zeros((10, 10, 10))), "array", "memory")
        finally:
            raytruth.memory_limit(before)


class Manners(ModuleTest):
    def test_the_lock_is_released(self):
        volume = raytruth.Volume(numpy.random.default_rng(0).uniform(size=(48, 48, 48)))
        origins = numpy.random.default_rng(1).uniform(0, 47, size=(4000, 3))
        worker = threading.Thread(target=raytruth.rays, args=(volume, POINTS, origins, [1, 0.3, 0.2]), kwargs={"threads": 1})
        worker.start()
        longest, last = 0, time.perf_counter()
        while worker.is_alive():
            time.sleep(0.001)
            now = time.perf_counter()
            longest, last = max(longest, now - last), now
        # With the lock held, this thread would sleep for all of the call, which is seconds.
        begin = time.perf_counter()
        raytruth.rays(volume, POINTS, origins, [1, 0.3, 0.2], threads=1)
        self.assertLess(longest, 0.5 * (time.perf_counter() - begin))

    def test_any_number_of_threads_gives_the_same_bytes(self):
        volume = raytruth.Volume(noise())
        origins = numpy.random.default_rng(1).uniform(0, 7, size=(300, 3))
        results = [raytruth.rays(volume, POINTS, origins, [1, 2, 3], threads=threads).color.tobytes() for threads in (1, 2, 0)]
        self.assertEqual(len(set(results)), 1)

    def test_everything_says_what_it_is(self):
        for name, member in vars(raytruth).items():
            if not name.startswith("_"):
                self.assertTrue(inspect.getdoc(member), name)

    def test_the_stubs_are_the_modules(self):
        if not shutil.which("stubtest"):
            self.skipTest("stubtest of mypy is not installed (package mypy)")
        # Of every class of pybind11's the metaclass is its own; those that nobody makes have an initialiser that refuses.
        classes = "Image|Integral|Rays|Signal|Table|TransferFunction|Volume"
        (self.folder / "allowed").write_text(f"raytruth\\.({classes})\nraytruth\\.(Image|Integral|Rays|Table)\\.__init__\n")
        environment = {**os.environ, "MYPYPATH": os.environ["PYTHONPATH"], "MYPY_CACHE_DIR": str(self.folder)}
        done = subprocess.run([shutil.which("stubtest"), "raytruth", "--allowlist", "allowed"], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Examples(ModuleTest):
    def example(self, name):
        """What the example prints, line by line."""
        script = SOURCE / "experiments/examples" / name
        done = subprocess.run([sys.executable, "-W", "error", script], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_small_enough_step(self):
        lines = self.example("small_enough_step.py")
        errors = [float(line.split()[1]) for line in lines[2:]]
        self.assertEqual(len(errors), 5)
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertIn("not seen", lines[-1])

    def test_table_for_my_viewer(self):
        lines = self.example("table_for_my_viewer.py")
        self.assertEqual(len(lines), 13)
        self.assertLess(float(lines[-1].split()[-1]), float(lines[1].split()[-1]))
        self.assertEqual(numpy.load(self.folder / "table.npy").shape, (256, 256, 4))

    def test_score_my_renderer(self):
        lines = self.example("score_my_renderer.py")
        self.assertIn("all", lines[-1])
        self.assertGreater(float(lines[-1].split()[3]), 1)

    def test_my_scheme_against_all(self):
        lines = self.example("my_scheme_against_all.py")
        names = [line.replace("->", "").split()[0] for line in lines[1:]]
        self.assertIn("mine", names)
        self.assertLess(names.index("cell_cubic"), names.index("mine"))
        self.assertGreater(len(names), 20)


if __name__ == "__main__":
    unittest.main()
