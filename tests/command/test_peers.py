"""experiments/peers: the committed answers, results and texts belong together, and adapters that are installed still answer so.

Nothing here needs another renderer: what needs one is skipped where it is missing.
"""

import csv
import importlib
import json
import math
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy

from support import PROGRAM, SOURCE, ProgramTest
from test_schemas import validator

PEERS = SOURCE / "experiments/peers"
PYTHON = "/usr/bin/python3"
sys.path[:0] = [str(PEERS), str(PEERS / "defects")]

defect = importlib.import_module("defect")
questions = importlib.import_module("questions")
study = importlib.import_module("study")


def document(name):
    return json.loads((PEERS / name).read_text())


def is_there(module):
    return subprocess.run([PYTHON, "-c", f"import {module}"], capture_output=True).returncode == 0


def answers_of(path):
    with open(path, newline="") as file:
        return {row["id"]: [float(row[column]) for column in ("r", "g", "b", "opacity")] for row in csv.DictReader(file)}


class Documents(unittest.TestCase):
    def test_the_studies_are_ordinary_experiments(self):
        for name in study.STUDIES:
            validator("experiment").validate(document(f"{name}.json"))
            validator("result").validate(document(f"results/{name}.json"))
            self.assertFalse((SOURCE / f"experiments/{name}.json").exists(), "plain experiments/run must not run it")

    def test_results_are_of_the_studies_as_they_are(self):
        for name in study.STUDIES:
            asked, ran = document(f"{name}.json"), document(f"results/{name}.json")["experiment"]
            for member in ("question", "schemes", "measures", "fields", "transfer_functions"):
                self.assertEqual(asked.get(member), ran.get(member), f"{name}: {member}")

    def test_every_program_keeps_what_its_package_is(self):
        programs = [scheme for scheme in document("peers_vectors.json")["schemes"] if study.is_program(scheme)]
        programs += [variant["scheme"] for variant in document("peers_images.json")["measures"][0]["variants"] if study.is_program(variant["scheme"])]
        for program in programs:
            self.assertIn("package", program)
            self.assertEqual(program["version"][-1], "--version")
            script, = [word for word in program["program"] if word.endswith(".py")]
            self.assertTrue((PEERS / script).is_file())

    def test_conventions_say_the_same_of_each_program(self):
        conventions = document("conventions.json")
        for name, program in conventions["programs"].items():
            self.assertEqual(sorted(program), sorted(conventions["columns"]), name)
        self.assertEqual(set(conventions["tolerances"]), {"raytruth", "vtk", "miter", "vtkjs"})

    def test_npm_packages_are_exact(self):
        for version in document("package.json")["dependencies"].values():
            self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        self.assertFalse(list(PEERS.glob("*lock*")))


class Answers(ProgramTest):
    def test_scores_follow_from_the_committed_answers(self):
        """The study, its programs replaced by files of what they answered, has the rows that are committed."""
        experiment, names = document("peers_vectors.json"), {}
        for scheme in experiment["schemes"]:
            if study.is_program(scheme):
                file = questions.name_of_answers([word for word in scheme["program"] if word not in ("xvfb-run", "-a", PYTHON)])
                scheme["program"] = ["cat", str(PEERS / "answers" / file)]
                del scheme["version"]
                names[scheme["name"]] = file
        self.assertEqual(sorted(names.values()), sorted(path.name for path in (PEERS / "answers").iterdir()))
        self.write("again.json", experiment)
        again = self.json_of("run", "again.json", "--programs")["rows"]
        committed = document("results/peers_vectors.json")["rows"]
        self.assertEqual(len(again), len(committed))
        for new, old in zip(again, committed):
            for column in ("scheme", "level", "against", "answered", "status", "worst"):
                self.assertEqual(new[column], old[column])
            for column in ("digits_min", "digits_median", "error_mean"):
                if old[column] is not None:
                    self.assertAlmostEqual(new[column], old[column], delta=1e-6 * max(1, abs(old[column])), msg=f"{old['scheme']} {old['level']} {column}")

    def test_samples_are_those_of_the_question(self):
        vectors = json.loads((SOURCE / "results/vectors.json").read_text())["vectors"]
        ray = next(vector for vector in vectors if vector["id"] == "smooth_ray_01")
        samples = questions.samples_of(ray, 4)
        self.assertEqual(len(samples), 5)
        coefficients, end = ray["signal"]["coefficients"][0], ray["signal"]["breaks"][1]
        self.assertEqual(samples[0], coefficients[0])
        if len(ray["signal"]["breaks"]) == 2:
            self.assertAlmostEqual(samples[-1], sum(c * end**k for k, c in enumerate(coefficients)), places=12)

    def test_opacities_of_extinctions(self):
        points = questions.opacities_of([(0, 0), (1, 2), (1, 4), (2, 4)], 0.5, parts=4)
        self.assertEqual([s for s, _ in points], [0, 0.25, 0.5, 0.75, 1, 1, 2])
        for (_, a), x in zip(points, (0, 0.5, 1, 1.5, 2, 4, 4)):
            self.assertAlmostEqual(a, 1 - math.exp(-x / 2), places=15)
        self.assertEqual(questions.widened([(1, 5)], 0, 2), [(0, 5), (1, 5), (2, 5)])


class Study(unittest.TestCase):
    def test_peers_are_chosen_by_their_first_word(self):
        experiment = study.chosen(document("peers_vectors.json"), ["miter"])
        self.assertEqual([scheme["name"] for scheme in experiment["schemes"] if study.is_program(scheme)], ["miter"])
        self.assertIn("order1", experiment["schemes"])
        images = study.chosen(document("peers_images.json"), ["vtkjs"])["measures"][0]
        self.assertEqual({variant["scheme"]["name"] for variant in images["variants"] if study.is_program(variant["scheme"])}, {"vtkjs"})
        self.assertEqual(images["pictures"]["errors"], ["vtkjs 0.0625"])

    def test_nothing_is_said_of_others(self):
        for name in ("peers_vectors.json", "peers_images.json"):
            for peers in (["miter"], ["vtk"], ["povray"]):
                chosen = study.chosen(document(name), peers)
                others = {"vtk_linear", "miter", "vtkjs 0.0625", "vtk_gpu 0.25"} - {
                    item["name"] for item in chosen.get("schemes", []) if isinstance(item, dict)
                } - {variant["name"] for measure in chosen["measures"] for variant in measure.get("variants", [])}
                said = json.dumps([chosen["published"], chosen.get("checks", []), chosen["plot"]["panels"]])
                self.assertTrue(others)
                for other in others:
                    self.assertNotIn(f'"{other}"', said)

    def test_differences_are_told(self):
        result = {"columns": {"scheme": {"key": True}, "rmse": {}}, "rows": [{"scheme": "miter", "rmse": 0.1, "status": "ok", "why": None}]}
        tolerances = {"raytruth": {}, "miter": {"rmse": [0, 0.01]}}
        near, far, refused = ({**result, "rows": [{**result["rows"][0], **new}]} for new in ({"rmse": 0.1005}, {"rmse": 0.102}, {"status": "refused", "why": "lacks"}))
        self.assertEqual(study.differences(result, near, tolerances), [])
        self.assertEqual(len(study.differences(result, far, tolerances)), 1)
        self.assertEqual(len(study.differences(result, refused, tolerances)), 1)


class Defects(unittest.TestCase):
    def modules(self):
        for script in study.scripts():
            yield script.stem, importlib.import_module(script.stem), script.with_suffix(".json"), script.with_suffix(".txt")

    def test_every_script_was_run_and_its_text_is_that_of_its_numbers(self):
        count = 0
        for name, module, numbers, text in self.modules():
            with self.subTest(name):
                found = json.loads(numbers.read_text())
                self.assertEqual(text.read_text(), defect.text_of(module.DEFECT, found["version"], found["rows"]))
                self.assertLess(max(map(len, text.read_text().splitlines())), 140)
                count += 1
        self.assertGreaterEqual(count, 17)

    def test_a_mended_version_is_told(self):
        for name, module, numbers, _ in self.modules():
            with self.subTest(name):
                rows = json.loads(numbers.read_text())["rows"]
                self.assertTrue(defect.is_there(module.DEFECT, rows), "the committed version has it")
                mended = [(case, expected, expected) for case, expected, _ in rows]
                self.assertFalse(defect.is_there(module.DEFECT, mended))
                self.assertIn("no longer there", defect.text_of(module.DEFECT, "a later version", mended))
                nonsense = [(case, expected, math.nan) for case, expected, _ in rows]
                self.assertTrue(defect.is_there(module.DEFECT, nonsense))

    def test_what_needs_no_program_is_right(self):
        """The registration finds a stretch that was made on purpose."""
        module = importlib.import_module("vtk_image_stretched")
        x = (numpy.arange(96) - 47.5)[None, :]
        y = (numpy.arange(96) - 47.5)[:, None]
        blob = lambda wide: numpy.exp(-((x / wide) ** 2 + y**2) / 300)
        wider, taller = module.registered(blob(1), blob(1 + 1 / 96))
        self.assertAlmostEqual(wider, 1, delta=0.05)
        self.assertAlmostEqual(taller, 0, delta=0.05)


@unittest.skipUnless(is_there("vtkmodules.all"), "VTK's Python modules are missing")
class Vtk(unittest.TestCase):
    def test_integrators_answer_as_committed(self):
        with open(SOURCE / "results/vectors.json", "rb") as file:
            done = subprocess.run([PYTHON, PEERS / "vtk_integrators.py", "linear"], stdin=file, capture_output=True, check=True)
        committed = answers_of(PEERS / "answers/vtk_integrators_linear.csv")
        lines = list(csv.DictReader(done.stdout.decode().splitlines()))
        self.assertEqual({line["id"] for line in lines}, set(committed))
        for line in lines:
            if line["id"].startswith("faint"):
                continue  # what its cancellation leaves is anything
            for column, number in zip(("r", "g", "b", "opacity"), committed[line["id"]]):
                self.assertAlmostEqual(float(line[column]), number, delta=1e-4, msg=line["id"])

    @unittest.skipUnless(shutil.which("xvfb-run"), "xvfb is missing")
    def test_a_ray_caster_renders_a_known_block(self):
        scene = importlib.import_module("matter").slab(opacity=0.1)
        question = {"raytruth": "scene/1", "volume": {"size": list(scene["voxels"].shape[::-1]), "values": scene["voxels"].ravel().tolist()}, "spacing": [1, 1, 1], "camera": scene["camera"], "step": 0.05,
                    "transfer_function": {"unit_length": 1, "points": [{"s": s, "opacity": 0.1, "color": [1, 1, 1]} for s in (0, 1)]}}
        done = subprocess.run(["xvfb-run", "-a", PYTHON, PEERS / "vtk_raycasters.py", "gpu"], input=json.dumps(question).encode(), capture_output=True, check=True)
        import io

        pixel = importlib.import_module("matter").middle(numpy.load(io.BytesIO(done.stdout)))
        self.assertAlmostEqual(pixel[3], 1 - 0.9**8, delta=0.01)


@unittest.skipUnless(shutil.which("teem-miter"), "teem-miter is missing")
class Miter(ProgramTest):
    def test_it_renders_as_the_certified_image(self):
        # A blob that does not reach the border, where rays end at whole steps.
        x, y, z = numpy.meshgrid(*3 * [numpy.arange(17) - 8.0])
        volume = {"size": [17, 17, 17], "values": numpy.exp(-(x**2 + y**2 + z**2) / 20).ravel().tolist()}
        transfer = {"unit_length": 1, "points": [{"s": s, "opacity": a, "color": [1, 0.5, s]} for s, a in ((0, 0), (0.1, 0), (1, 0.2))]}
        camera = {"eye": [40, 30, 50], "target": [8, 8, 8], "up": [0, 1, 0], "height": 18, "size": [24, 24]}
        scene = {"volume": volume, "border": "voxel_centres", "transfer_function": transfer, "camera": camera}
        errors = []
        for step in (1, 0.25):
            program = {"program": [PYTHON, str(PEERS / "miter.py")], "name": "miter"}
            self.write("scene.json", {**scene, "step": step, "scheme": program})
            errors.append(self.json_of("eval", "scene.json", "--programs")["error"]["rmse"])
        self.assertLess(errors[0], 0.02)
        self.assertLess(errors[1], errors[0] / 8, "the second order")


if __name__ == "__main__":
    unittest.main()
