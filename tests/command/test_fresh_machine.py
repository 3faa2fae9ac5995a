"""What works where there is no volume at all: every experiment and its plot, and the examples."""

import json
import os
import subprocess
import unittest

import numpy

from support import PROGRAM, SOURCE, ProgramTest
from test_schemas import validator

EXAMPLES = SOURCE / "experiments/examples"


class FreshMachine(ProgramTest):
    def run_bare(self, *arguments):
        """Runs the program with no data folder named, and no home."""
        environment = {key: value for key, value in os.environ.items() if key not in ("RAYTRUTH_DATA", "HOME")}
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def test_every_experiment_and_its_plot(self):
        experiments = sorted(SOURCE.glob("experiments/*.json"))
        self.run_bare("run", *experiments, "--profile", "quick", "-o", "out")
        results = [self.folder / "out" / path.name for path in experiments]
        words = self.run_bare("plot", *results, "-o", "plots")
        self.assertNotIn("cannot be plotted", words)
        self.assertEqual({path.stem for path in (self.folder / "plots").glob("*.svg")}, {path.stem for path in experiments})
        for path in results:
            with self.subTest(experiment=path.stem):
                rows = json.loads(path.read_text())["rows"]
                self.assertTrue(any(row["status"] != "refused" for row in rows), "every row is refused")

    def test_every_study_has_a_field_that_needs_no_file(self):
        for path in sorted(SOURCE.glob("experiments/*.json")):
            fields = json.loads(path.read_text()).get("fields")
            with self.subTest(experiment=path.stem):
                self.assertTrue(fields is None or any(field["kind"] != "volume" for field in fields))


class Examples(ProgramTest):
    def test_scene(self):
        validator("scene").validate(json.loads((EXAMPLES / "scene.json").read_text()))
        self.output_of("render", EXAMPLES / "scene.json", "-o", "image.npy")
        opacity = numpy.load(self.folder / "image.npy")[..., 3]
        self.assertGreater(opacity.max(), 0.9)
        self.assertLess(opacity.min(), 0.1)

    def test_ray(self):
        validator("case").validate(json.loads((EXAMPLES / "ray.json").read_text()))
        answer = self.json_of("eval", EXAMPLES / "ray.json")
        self.assertGreater(answer["reference"]["opacity"], 0.1)
        for scheme in answer["schemes"].values():
            self.assertLess(abs(scheme["opacity_error"]), 0.05)

    def test_table(self):
        validator("table").validate(json.loads((EXAMPLES / "table.json").read_text()))
        self.output_of("table", EXAMPLES / "table.json", "-o", "table.npy")
        self.assertEqual(numpy.load(self.folder / "table.npy").shape[:2], (256, 256))

    def test_each_has_a_test(self):
        self.assertEqual({path.stem for path in EXAMPLES.glob("*.json")}, {"scene", "ray", "table"})


if __name__ == "__main__":
    unittest.main()
