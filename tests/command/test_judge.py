"""`raytruth judge`: the rows of a result by claims, checks and a plot that came later."""

import json
import unittest

from support import EXPERIMENT, ProgramTest, changed
from test_schemas import validator


class Judge(ProgramTest):
    def setUp(self):
        super().setUp()
        self.result = self.json_of("run", self.write("experiment.json", EXPERIMENT))
        self.write("result.json", self.result)

    def judged(self, experiment):
        self.output_of("judge", self.write("changed.json", experiment), "result.json", "-o", "judged.json")
        return json.loads((self.folder / "judged.json").read_text())

    def test_nothing_changed(self):
        judged = self.judged(EXPERIMENT)
        self.assertTrue(validator("result").is_valid(judged))
        self.assertIn("judged", judged["provenance"])
        del judged["provenance"]["judged"]
        self.assertEqual(judged, self.result)

    def test_other_claims_checks_and_words(self):
        experiment = changed(EXPERIMENT, "/published/0/stated", 1e6)
        experiment = changed(experiment, "/question", "Another one?")
        experiment = changed(experiment, "/checks", [])
        judged = self.judged(experiment)
        self.assertEqual(judged["published"][0]["verdict"], "contradicted")
        self.assertEqual(judged["checks"], [])
        self.assertEqual(judged["experiment"]["question"], "Another one?")
        self.assertEqual(judged["rows"], self.result["rows"])

    def test_in_place(self):
        self.output_of("judge", self.write("changed.json", changed(EXPERIMENT, "/checks", [])), "result.json")
        self.assertEqual(json.loads((self.folder / "result.json").read_text())["checks"], [])

    def test_rows_of_another_experiment(self):
        other = self.write("other.json", changed(EXPERIMENT, "/rays/count", 65))
        self.assert_refused(self.run_program("judge", other, "result.json"), "result.json: /experiment: ")
        self.write("result.json", changed(self.result, "/experiment/gl", "osmesa"))  # which the experiment does not have
        self.assert_refused(self.run_program("judge", "experiment.json", "result.json"), "result.json: /experiment: ", "gl")


if __name__ == "__main__":
    unittest.main()
