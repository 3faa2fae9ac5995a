"""`raytruth plot` with matplotlib, and what an experiment may ask of its plot."""

import re
import unittest

from support import EXPERIMENT, ProgramTest, changed
from test_schemas import mutations, validator

ROWS = {"rows": {"measure": "signal_error"}, "series": "scheme"}
POINTS = {"kind": "points", "value": "xi_p50", "low": "xi_p05", "high": "xi_p95", "group": "field", "label": "points of xi", "log": True, **ROWS}
LINES = {"kind": "lines", "x": "fetches_mean", "y": "xi_p50", "label_x": "fetches", "label_y": "lines of xi", "log_y": True,
         "x_range": [0, 100], "floor": 1e-9, **ROWS}
SCATTER = {"kind": "scatter", "x": "fetches_mean", "y": "xi_p50", "label_x": "fetches", "label_y": "marks of xi", "log_x": True,
           "log_y": True, "diagonal": True, **ROWS}
PANELS = changed(
    EXPERIMENT, "/plot", {"title": "all", "columns": 2, "panels": [*EXPERIMENT["plot"]["panels"], POINTS, LINES, SCATTER]}
)

# What no schema can say: names of columns and their values, and which of two numbers is greater.
BEYOND_SCHEMA = re.compile(
    r"""
      /plot/panels/\d/(group|series|x|y|low|high)\ =\ "word"
    | /plot/panels/1/value\ =\ "word"
    | /plot/panels/\d/rows(\ =\ {"a":\ 1}|/unknown)
    | /plot/panels/2/x_range/(0\ =\ 1e\+300|1\ =\ -1)
    """,
    re.VERBOSE,
)


class Panels(ProgramTest):
    def drawn(self, document):
        """The SVG of an experiment's plot."""
        self.write("small.json", self.json_of("run", self.write("experiment.json", document)))
        self.output_of("plot", "small.json", "-o", "plots")
        return (self.folder / "plots/small.svg").read_text()

    def test_every_kind_is_drawn_with_the_same_bytes_again(self):
        image = self.drawn(PANELS)
        for text in ("all", "points of xi", "lines of xi", "marks of xi", "white", "order0 mid"):
            self.assertIn(f">{text}</text>", image)
        self.assertEqual(self.drawn(PANELS), image)

    def test_exact_zeros_stand_hollow_on_the_floor_of_a_log_axis(self):
        hollow = "fill: #ffffff; stroke: #"
        zeros = len(EXPERIMENT["fields"]) * len(EXPERIMENT["schemes"])
        for panel in ({**POINTS, "value": "rays_constant", "low": "rays_constant"}, {**LINES, "y": "rays_constant"}):
            with self.subTest(kind=panel["kind"]):
                image = self.drawn(changed(PANELS, "/plot/panels", [panel]))
                self.assertEqual(len(re.findall(f'<use [^>]*style="{hollow}', image)), zeros)

    def test_a_panel_without_rows_says_why(self):
        absent = {"name": "absent", "kind": "volume", "volume": "no_such_volume"}
        panels = [{**POINTS, "rows": {"measure": "signal_error", "field": "absent"}}, {**LINES, "rows": {"measure": "cell_cubic", "field": "white"}},
                  {"kind": "image", "rows": {"field": "absent"}, "line": "fetches_mean", "pixels": "field", "label": "picture"}, POINTS]
        image = self.drawn(changed(changed(PANELS, "/fields/2", absent), "/plot/panels", panels))
        self.assertEqual(image.count(">No data</text>"), 3)
        self.assertIn(">absent: no_such_volume: no such volume in</text>", image)
        self.assertIn(">no row with measure cell cubic, field white</text>", image)
        self.assertEqual(image.count(">points of xi</text>"), 2)

    def test_a_plot_that_fails_stops_no_other(self):
        result = self.json_of("run", self.write("experiment.json", PANELS))
        self.write("good.json", result)
        del result["experiment"]["plot"]["title"]
        self.write("bad.json", result)
        del result["experiment"]["plot"]
        self.write("none.json", result)
        done = self.run_program("plot", "none.json", "bad.json", "good.json", "-o", "plots")
        self.assertEqual(done.returncode, 0)
        lines = done.stderr.decode().splitlines()
        self.assertEqual(len(lines), 2)
        self.assertEqual(lines[0], "raytruth: none.json: its experiment asks for no plot")
        self.assertTrue(lines[1].startswith("raytruth: bad.json: cannot be plotted: KeyError"), lines[1])
        self.assertEqual([path.name for path in (self.folder / "plots").iterdir()], ["good.svg"])
        self.assert_refused(self.run_program("plot", "bad.json", "-o", "plots"), "bad.json: cannot be plotted: KeyError")

    def test_schema_and_program_agree_on_panels(self):
        schema = validator("experiment")
        for what, document in mutations(PANELS):
            if not what.startswith("/plot/"):
                continue
            with self.subTest(what=what):
                accepts = self.run_program("run", self.write("experiment.json", document)).returncode == 0
                verdicts = schema.is_valid(document), accepts
                self.assertEqual(*((verdicts, (True, False)) if BEYOND_SCHEMA.fullmatch(what) else verdicts))


if __name__ == "__main__":
    unittest.main()
