"""The measure `costs`: ratios out of benchmarks' reports, and verdicts on what a publication says of times."""

import json

from support import ProgramTest


def entry(name, aggregate, **counters):
    return {"name": f"{name}_{aggregate}", "run_name": name, "aggregate_name": aggregate, "real_time": 1.0, **counters}


REPORT = {
    "context": {"num_cpus": 2},
    "benchmarks": [
        entry("paired/7/min_time:0.050/manual_time", "mean", speedup=3.5),
        entry("paired/7/min_time:0.050/manual_time", "median", speedup=3.0),
        entry("paired/7/min_time:0.050/manual_time", "stddev", speedup=0.25),
        entry("seconds_only", "median", items_per_second=9.0),
    ],
}
EXPERIMENT = {
    "raytruth": "experiment/1",
    "name": "costs",
    "question": "How much faster?",
    "source": "none",
    "measures": [{"kind": "costs", "reports": "reports", "counters": ["speedup"]}],
    "published": [
        {
            "claim": "speed",
            "stated": 2.25,
            "resolution": 0.6,
            "row": {"report": "own", "benchmark": "paired/7"},
            "measured": "ratio",
            "low": "low",
            "high": "high",
        }
    ],
}


class Costs(ProgramTest):
    def result(self):
        return self.json_of("run", self.write("experiment.json", EXPERIMENT))

    def test_a_ratio_is_the_median_and_meets_a_figure_within_two_deviations(self):
        (self.folder / "reports").mkdir()
        self.write("reports/own.json", REPORT)
        result = self.result()
        (row,) = result["rows"]
        self.assertEqual((row["report"], row["benchmark"], row["counter"]), ("own", "paired/7", "speedup"))
        self.assertEqual((row["low"], row["ratio"], row["high"]), (2.5, 3.0, 3.5))
        (claim,) = result["published"]
        self.assertEqual(claim["verdict"], "reproduced")

    def test_without_reports_it_says_so_and_judges_nothing(self):
        result = self.result()
        (row,) = result["rows"]
        self.assertEqual(row["status"], "refused")
        self.assertIn("no reports of benchmarks", row["why"])
        self.assertEqual(result["published"][0]["verdict"], "not comparable")

    def test_a_broken_report_gets_one_line(self):
        (self.folder / "reports").mkdir()
        for text, place in ((json.dumps(REPORT)[:-40], "own.json"), ('{"benchmarks": 3}', "/benchmarks")):
            (self.folder / "reports/own.json").write_text(text)
            self.assert_refused(self.run_program("run", self.write("experiment.json", EXPERIMENT)), place)
