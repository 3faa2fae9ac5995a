"""`raytruth diff`: what changed between two results, beyond both radii."""

import json
import unittest

from support import EXPERIMENT, SOURCE, ProgramTest, changed


class Differences(ProgramTest):
    def setUp(self):
        super().setUp()
        self.result = self.json_of("run", self.write("small.json", EXPERIMENT))
        self.write("before.json", self.result)

    def diff(self, after):
        self.write("after.json", after)
        return self.json_of("diff", "before.json", "after.json", "--json")

    def test_nothing(self):
        self.assertEqual(set(map(tuple, self.diff(self.result).values())), {()})
        self.assertIn("nothing changed", self.output_of("diff", "before.json", "after.json", "--check"))

    def test_numbers_count_beyond_both_radii(self):
        row = self.result["rows"][0]
        inside = changed(self.result, "/rows/0/xi_p50", row["xi_p50"] + 1.9 * row["xi_radius"])
        self.assertEqual(self.diff(inside)["changed"], [])
        beyond = changed(self.result, "/rows/0/xi_p50", row["xi_p50"] + 2.1 * row["xi_radius"])
        (change,) = self.diff(beyond)["changed"]
        self.assertEqual(change["column"], "xi_p50")
        self.assertEqual(change["row"]["scheme"], "order0_mid")
        self.assertEqual(change["before"], row["xi_p50"])
        wide = changed(beyond, "/rows/0/xi_radius", 1.2 * row["xi_radius"])
        self.assertNotIn("xi_p50", [change["column"] for change in self.diff(wide)["changed"]])

    def test_exact_columns_and_words(self):
        after = changed(changed(self.result, "/rows/0/rays_constant", 1), "/rows/1/why", "because")
        self.assertEqual([change["column"] for change in self.diff(after)["changed"]], ["rays_constant", "why"])

    def test_rows_are_matched_by_their_keys(self):
        after = changed(self.result, "/rows", self.result["rows"][:0:-1])
        differences = self.diff(after)
        self.assertEqual(len(differences["removed"]), 1)
        self.assertEqual(differences["removed"][0]["scheme"], "order0_mid")
        self.assertEqual((differences["added"], differences["changed"]), ([], []))

    def test_experiments_that_are_not_the_same(self):
        other = changed(changed(self.result, "/experiment/name", "other"), "/experiment/rays/count", 7)
        self.write("other.json", other)
        done = self.run_program("diff", "before.json", "other.json", "--json")
        self.assertEqual(done.stderr, b"raytruth: warning: these are results of different experiments: before.json of small, other.json of other\n")
        self.assertEqual(json.loads(done.stdout)["experiment"], [{"place": "/name", "before": "small", "after": "other"},
                                                                 {"place": "/rays/count", "before": 64, "after": 7}])
        longer = changed(self.result, "/experiment/plot/title", "x" * 1000)
        self.write("longer.json", longer)
        done = self.run_program("diff", "before.json", "longer.json", "--check")
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        said, nothing = done.stdout.decode().splitlines()
        self.assertTrue(said.startswith('experiment /plot/title: "small" -> "xxx'))
        self.assertLess(len(said), 200)
        self.assertEqual(nothing, "nothing changed beyond both radii")

    def test_verdicts_and_checks(self):
        after = changed(self.result, "/published/0/verdict", "contradicted")
        after = changed(after, "/checks/0/holds", False)
        differences = self.diff(after)
        self.assertEqual(differences["verdicts"], [{"claim": "figure", "before": "reproduced", "after": "contradicted"}])
        self.assertEqual(differences["checks"], [{"bound": "continuous", "before": True, "after": False}])
        done = self.run_program("diff", "before.json", "after.json", "--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn("verdict figure", done.stdout.decode())
        self.assertEqual(self.run_program("diff", "before.json", "after.json").returncode, 0)

    def test_parts_of_a_claim_are_told_apart(self):
        first = dict(self.result["published"][0], part="one")
        second = dict(first, part="two", verdict="contradicted")
        self.result["published"] = [first, second, dict(second)]
        self.write("before.json", self.result)
        self.assertEqual(self.diff(self.result)["verdicts"], [])
        after = changed(self.result, "/published/1/verdict", "compatible")
        expected = {"claim": "figure", "part": "two", "before": "contradicted", "after": "compatible"}
        self.assertEqual(self.diff(after)["verdicts"], [expected])

    def test_committed_results_do_not_differ_from_themselves(self):
        for file in sorted(SOURCE.glob("results/*.json")):
            if file.stem == "vectors":
                continue
            with self.subTest(result=file.stem):
                same = self.output_of("diff", str(file), str(file), "--check")
                self.assertEqual(same, "nothing changed beyond both radii\n")

    def test_what_is_no_result(self):
        for document, pointer in [
            ({}, "/raytruth"),
            (changed(self.result, "/raytruth", "result/2"), "/raytruth"),
            (changed(self.result, "/rows/0/xi_p50", [1]), "/rows/0/xi_p50"),
            (changed(self.result, "/rows/1", self.result["rows"][0]), "/rows/1"),
            (changed(self.result, "/columns", {}), "/columns"),
            (changed(self.result, "/checks/0/holds", 1), "/checks/0/holds"),
        ]:
            with self.subTest(pointer=pointer):
                self.write("bad.json", document)
                self.assert_refused(self.run_program("diff", "before.json", "bad.json"), f"bad.json: {pointer}: ")
        self.assert_refused(self.run_program("diff", "before.json"), "command line")


if __name__ == "__main__":
    unittest.main()
