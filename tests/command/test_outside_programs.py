"""Methods from outside: programs that documents name in place of schemes, good ones and bad ones."""

import json
import os
import signal
import subprocess
import sys
import time
import unittest

import support
import test_images
import test_render
from support import PROGRAM, RAY, ProgramTest, changed

# Each is a program that reads the question and answers it, well or badly.
PRELUDE = "import json, os, sys, time\nquestion = json.load(sys.stdin)\n"
HEADER = "print('id,r,g,b,opacity')\n"
VECTORS = {
    "zeros": HEADER + "for vector in question['vectors']: print(vector['id'] + ',0,0,0,0')",
    "one": HEADER + "print(question['vectors'][0]['id'] + ',0.5,0.5,0.5,0.5')",
    "nonsense": "print('Hello, world')",
    "nothing": "",
    "unknown": HEADER + "print('no_such_ray,0,0,0,0')",
    "slow": "time.sleep(100)",
    "large": "sys.stdout.write('x' * 3_000_000)",
    "fails": "sys.exit('it is Tuesday')",
    "lacks": "print('libtuesday is missing', file=sys.stderr); sys.exit(3)",
    "dies": "os.kill(os.getpid(), 9)",
    "leaves": HEADER + "sys.stdout.flush()\nif os.fork() == 0: time.sleep(100)",
}
EXPERIMENT = {
    "raytruth": "experiment/1",
    "name": "outside",
    "question": "What do others say?",
    "source": "none",
    "measures": [{"kind": "conformance", "intervals": 4, "against": ["ray", "samples"], "emission": "associated"}],
}
# Half the opacity everywhere, as colours too.
IMAGES = {
    "half": "import numpy\nw, h = question['camera']['size']\nnumpy.save(sys.stdout.buffer, numpy.full((h, w, 4), 0.5))",
    "small": "import numpy\nnumpy.save(sys.stdout.buffer, numpy.zeros((2, 3, 4)))",
    "colours": "import numpy\nw, h = question['camera']['size']\nnumpy.save(sys.stdout.buffer, numpy.zeros((h, w, 3)))",
    "infinite": "import numpy\nw, h = question['camera']['size']\nnumpy.save(sys.stdout.buffer, numpy.full((h, w, 4), numpy.inf))",
    "words": "print('no image')",
    # Rendered by Raytruth: the question is a scene of its form, which asks for the true image.
    "raytruth": f"import subprocess, tempfile\nout = tempfile.mkdtemp() + '/o.npy'\nsubprocess.run(['{PROGRAM}', 'render', '-', '--binary64', '-o', out], input=json.dumps(question).encode(), check=True, stdout=subprocess.DEVNULL)\nsys.stdout.buffer.write(open(out, 'rb').read())",
}


class OutsideTest(ProgramTest):
    def program(self, name, text=None, **members):
        self.write(f"{name}.py", (PRELUDE + (text if text is not None else {**VECTORS, **IMAGES}[name])).encode())
        return {"program": [sys.executable, f"{name}.py"], "name": name, **members}

    def run_experiment(self, *schemes, options=("--programs",)):
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": list(schemes)}))
        return self.json_of("run", "outside.json", *options)

    def why(self, name, **members):
        """Why the program's row is refused."""
        (row,) = self.run_experiment(self.program(name, **members))["rows"]
        self.assertEqual((row["scheme"], row["level"], row["status"], row["answered"]), (name, "all", "refused", 0))
        return row["why"]


class Vectors(OutsideTest):
    def test_a_program_stands_beside_schemes(self):
        result = self.run_experiment("order1", self.program("zeros", version=[sys.executable, "-c", "print('Zeros 1.0'); print('more')"]))
        rows = {(row["scheme"], row["level"], row["against"]): row for row in result["rows"]}
        self.assertEqual({row["status"] for row in result["rows"]}, {"ok"})
        zeros = rows["zeros", "smooth", "ray"]
        self.assertEqual((zeros["version"], zeros["answered"], zeros["digits_min"]), ("Zeros 1.0", zeros["cases"], 0))
        self.assertGreater(zeros["error_mean"], 0.1)
        self.assertLessEqual(zeros["error_mean"], max(zeros["color_error_max"], zeros["opacity_error_max"]))
        # Only first order is exact where the signal is linear between the samples.
        self.assertGreater(rows["order1", "smooth", "samples"]["digits_min"], 11)
        self.assertLess(rows["order1", "smooth", "ray"]["digits_min"], 5)
        self.assertIsNone(rows["order1", "smooth", "ray"]["version"])
        self.assertTrue(result["provenance"]["programs"])
        self.assertEqual(result["columns"]["against"]["key"], True)

    def test_the_question_has_samples_and_no_answers(self):
        tell = "open('question.json', 'w').write(json.dumps(question))\n" + VECTORS["zeros"]
        self.run_experiment(self.program("tells", tell))
        question = json.loads((self.folder / "question.json").read_text())
        self.assertEqual(question["raytruth"], "vectors/2")
        for vector in question["vectors"]:
            self.assertNotIn("reference", vector)
            self.assertEqual(vector["emission"], "associated")
            self.assertEqual(len(vector["samples"]), 2 if "slab" in vector else 5)
            if "slab" in vector:
                self.assertEqual(vector["samples"], [vector["slab"]["front"], vector["slab"]["back"]])

    def test_what_is_left_out_is_counted(self):
        rows = self.run_experiment(self.program("one"))["rows"]
        self.assertEqual(rows[-1]["answered"], 1)
        self.assertGreater(rows[-1]["cases"], 50)

    def test_without_the_option_nothing_runs(self):
        touch = "open('touched', 'w')"
        result = self.run_experiment(self.program("touch", touch, version=[sys.executable, "-c", touch]), "order1", options=())
        refused = [row for row in result["rows"] if row["scheme"] == "touch"]
        self.assertEqual([row["why"] for row in refused], ["it is a program, and programs run with --programs only"])
        self.assertEqual(len(result["rows"]) - 1, len([row for row in result["rows"] if row["scheme"] == "order1"]))
        self.assertFalse((self.folder / "touched").exists())
        self.assertNotIn("programs", result["provenance"])

    def test_bad_answers_are_refused(self):
        self.assertRegex(self.why("nonsense"), "its answer: line 1: found 2 fields; id,r,g,b,opacity is allowed")
        self.assertRegex(self.why("nothing"), "its answer: found no lines")
        self.assertRegex(self.why("unknown"), "found the id 'no_such_ray'")

    def test_bad_ends_are_refused(self):
        self.assertRegex(self.why("fails"), "ended with exit code 1: it is Tuesday$")
        self.assertRegex(self.why("lacks", package="tuesday-dev"), "lacks something: libtuesday is missing; the package tuesday-dev has it$")
        self.assertRegex(self.why("dies"), "was ended by signal 9")

    def test_time_is_bounded(self):
        begin = time.monotonic()
        self.assertRegex(self.why("slow", seconds=1), "took more than 1 s")
        self.assertLess(time.monotonic() - begin, 30)

    def test_output_is_bounded(self):
        self.assertRegex(self.why("large", megabytes=2), "wrote more than 2 MB")
        self.assertRegex(self.why("large", megabytes=3), "its answer")

    def test_what_a_program_leaves_behind_ends_with_it(self):
        begin = time.monotonic()
        self.assertEqual(self.run_experiment(self.program("leaves"))["rows"][-1]["answered"], 0)
        self.assertLess(time.monotonic() - begin, 60)

    def test_a_missing_program_is_named_with_its_package(self):
        missing = {"program": ["no_such_program"], "name": "missing", "package": "no-such-package"}
        (row,) = self.run_experiment(missing)["rows"]
        self.assertEqual(row["why"], "no_such_program cannot be started: No such file or directory; the package no-such-package has it")
        row = self.run_experiment({**self.program("zeros"), "version": ["no_such_program"]})["rows"][-1]
        self.assertEqual(row["status"], "refused")

    def test_no_shell_reads_the_words(self):
        echo = HEADER + "open('words', 'w').write(json.dumps(sys.argv[1:]))"
        program = self.program("words", echo)
        program["program"] += ["$HOME", "a b", "; touch touched"]
        self.run_experiment(program)
        self.assertEqual(json.loads((self.folder / "words").read_text()), ["$HOME", "a b", "; touch touched"])
        self.assertFalse((self.folder / "touched").exists())

    def test_an_interruption_ends_the_program_too(self):
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": [self.program("waits", "open('here', 'w').write(str(os.getpid()))\ntime.sleep(100)")]}))
        started = subprocess.Popen([PROGRAM, "run", "outside.json", "--programs"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        here = self.folder / "here"
        for _ in range(600):
            if here.exists() and here.read_text():
                break
            time.sleep(0.1)
        started.send_signal(signal.SIGINT)
        self.assertEqual(started.wait(30), -signal.SIGINT)
        for _ in range(100):
            try:
                os.kill(int(here.read_text()), 0)
            except ProcessLookupError:
                return
            time.sleep(0.1)
        self.fail("the program is still there")

    def test_programs_are_for_measures_of_answers(self):
        document = changed(support.EXPERIMENT, "/schemes", ["order1", self.program("zeros")])
        self.write("outside.json", json.dumps(document))
        self.assert_refused(self.run_program("run", "outside.json"), "/measures/0: found a measure of schemes beside the program zeros")

    def test_names_are_their_own(self):
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": [{**self.program("zeros"), "name": "order1"}]}))
        self.assert_refused(self.run_program("run", "outside.json"), "/schemes/0/name: ")
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": [self.program("zeros"), self.program("zeros")]}))
        self.assert_refused(self.run_program("run", "outside.json"), "/schemes/1/name: ")

    def test_resuming_with_programs_does_not_keep_refused_rows(self):
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": [self.program("zeros")]}))
        for options, status in (([], "refused"), (["--programs"], "ok")):
            self.run_program("run", "outside.json", "-o", "out", "--resume", *options)
            rows = json.loads((self.folder / "out/outside.json").read_text())["rows"]
            self.assertEqual({row["status"] for row in rows}, {status})

    def test_parts_are_merged_with_what_was_allowed(self):
        self.write("outside.json", json.dumps({**EXPERIMENT, "schemes": [self.program("zeros")]}))
        whole = self.output_of("run", "outside.json", "--programs", "--without-times")
        for number in ("1/2", "2/2"):
            self.output_of("run", "outside.json", "--programs", "--shard", number, "-o", "parts")
        merge = ("merge", "parts", "-o", "merged.json", "--without-times")
        self.output_of(*merge)
        self.assertEqual((self.folder / "merged.json").read_text(), whole)
        self.assert_refused(self.run_program(*merge, "--recheck", "100%"), "units that ran programs", "--programs")
        self.output_of(*merge, "--recheck", "100%", "--programs")
        self.output_of("run", "outside.json", "--shard", "1/2", "-o", "refused")
        self.assert_refused(self.run_program("merge", "parts", "refused", "-o", "merged.json"), '"programs"')


class Cases(OutsideTest):
    def test_a_ray(self):
        halves = HEADER + "print('ray,0.5,0.25,0.125,0.5')"
        case = {**RAY, "schemes": ["order1", self.program("halves", halves)]}
        self.write("case.json", json.dumps(case))
        answer = self.json_of("eval", "case.json", "--programs")
        found = answer["schemes"]["halves"]
        self.assertEqual((found["color"], found["opacity"], found["intervals"]), ([0.5, 0.25, 0.125], 0.5, 10))
        self.assertEqual(found["opacity_error"], 0.5 - answer["reference"]["opacity"])
        self.assertEqual(found["color_error"], [x - y for x, y in zip(found["color"], answer["reference"]["color"])])
        refused = self.json_of("eval", "case.json")["schemes"]
        self.assertEqual(refused["halves"], {"status": "refused", "why": "it is a program, and programs run with --programs only"})
        self.assertIn("color", refused["order1"])

    def test_a_ray_through_a_volume_is_asked_as_a_polynomial(self):
        tell = "open('question.json', 'w').write(json.dumps(question))\n" + VECTORS["zeros"]
        signal_ = {"kind": "trilinear", "volume": {"size": [2, 2, 2], "values": [0, 0, 0, 0, 0, 0, 0, 1]}, "origin": [0, 0, 0], "direction": [1, 1, 1], "length": 3**0.5}
        self.write("case.json", json.dumps({"signal": signal_, "transfer_function": RAY["transfer_function"], "schemes": [self.program("tells", tell)]}))
        self.json_of("eval", "case.json", "--programs")
        (vector,) = json.loads((self.folder / "question.json").read_text())["vectors"]
        # The signal is (t / sqrt(3))^3.
        for found, expected in zip(vector["signal"]["coefficients"][0], (0, 0, 0, 3**-1.5), strict=True):
            self.assertAlmostEqual(found, expected, places=14)
        self.assertAlmostEqual(vector["samples"][32], 0.125, places=14)

    def test_a_scene(self):
        scene = {**test_render.SCENE, "scheme": self.program("half")}
        self.write("scene.json", json.dumps(scene))
        answer = self.json_of("eval", "scene.json", "--programs")
        self.assertEqual(answer["scheme"], "half")
        self.assertGreater(answer["error"]["maximum"], 0.01)
        self.assertEqual(self.json_of("eval", "scene.json")["error"]["status"], "refused")


class Images(OutsideTest):
    def render(self, program, *options):
        self.write("scene.json", json.dumps({**test_render.SCENE, "scheme": program}))
        return self.run_program("render", "scene.json", "-o", "image.npy", *options)

    def test_a_scene_is_rendered(self):
        done = self.render(self.program("half", version=[sys.executable, "-c", "print('Half 2')"]), "--programs")
        self.assertEqual(done.returncode, 0, done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual((answer["scheme"], answer["version"]), ("half", "Half 2"))
        import numpy

        image = numpy.load(self.folder / "image.npy")
        self.assertEqual(image.shape[2], 4)
        self.assertTrue((image == 0.5).all())

    def test_only_with_the_option(self):
        self.assert_refused(self.render(self.program("half")), "/scheme: found a program")

    def test_bad_images_are_refused(self):
        for name, why in (("small", "found 3 x 2 pixels"), ("colours", "without opacity"), ("infinite", "its answer"), ("words", "its answer: no header")):
            done = self.render(self.program(name), "--programs")
            self.assertEqual(done.returncode, 2, name)
            self.assertIn(why, done.stderr.decode())
            self.assertEqual(done.stderr.count(b"\n"), 1)
        done = self.render({"program": ["no_such_program"], "name": "missing", "package": "no-such-package"}, "--programs")
        self.assertEqual(done.returncode, 3)
        self.assertIn(b"no-such-package", done.stderr)

    def test_the_question_is_a_scene(self):
        """Raytruth itself answers it: the true image, so that no error is left."""
        experiment = changed(test_images.EXPERIMENT, "/measures/0/variants/0", {"name": "coarse", "step": 2, "scheme": self.program("raytruth")})
        experiment = changed(experiment, "/measures/0/views/0/border", "voxel_centres")
        self.write("images.json", json.dumps(experiment))
        rows = self.json_of("run", "images.json", "--programs")["rows"]
        (row,) = [row for row in rows if row["variant"] == "coarse" and row["against"] == "certified" and row["frame"] == "linear"]
        self.assertEqual((row["status"], row["scheme"], row["step"]), ("ok", "raytruth", 2))
        self.assertLess(max(row["rmse"], row["opacity_rmse"], row["maximum"]), 1e-12)
        (other,) = [row for row in rows if row["variant"] == "fine" and row["against"] == "certified" and row["frame"] == "linear"]
        self.assertGreater(other["opacity_rmse"], 1e-6)

    def test_a_refused_image_costs_its_rows_only(self):
        experiment = changed(test_images.EXPERIMENT, "/measures/0/variants/1", {"name": "fine", "step": 1, "scheme": self.program("words")})
        self.write("images.json", json.dumps(experiment))
        for options, why in (([], "--programs"), (["--programs"], "its answer")):
            rows = self.json_of("run", "images.json", *options)["rows"]
            (row,) = [row for row in rows if row["variant"] == "fine"]
            self.assertEqual((row["status"], row["against"]), ("refused", "certified"))
            self.assertIn(why, row["why"])
            self.assertTrue([row for row in rows if row["variant"] == "coarse" and row["status"] == "ok"])


if __name__ == "__main__":
    unittest.main()
