"""`raytruth plot` with matplotlib, and what an experiment may ask of its plot."""

import re
import unittest
from xml.etree import ElementTree

from support import EXPERIMENT, ProgramTest, changed
from test_schemas import mutations, validator

ROWS = {"rows": {"measure": "signal_error"}, "series": "scheme"}
POINTS = {"kind": "points", "value": "xi_p50", "low": "xi_p05", "high": "xi_p95", "group": "field", "label": "points of xi", "log": True,
          "title": "title of points", **ROWS}
LINES = {"kind": "lines", "x": "fetches_mean", "y": "xi_p50", "label_x": "fetches", "label_y": "lines of xi", "log_y": True,
         "x_range": [0, 100], "floor": 1e-9, **ROWS}
SCATTER = {"kind": "scatter", "x": "fetches_mean", "y": "xi_p50", "label_x": "fetches", "label_y": "marks of xi", "log_x": True,
           "log_y": True, "diagonal": True, **ROWS}
IMAGE = {"kind": "image", "rows": {"measure": "cell_cubic"}, "line": "fetches_mean", "pixels": "scheme", "turned": "left",
         "is_color": True, "label": "no picture"}
PANELS = changed(
    EXPERIMENT,
    "/plot",
    {"title": "all", "columns": 2, "image_columns": 3, "names": {"white": "White noise"},
     "panels": [*EXPERIMENT["plot"]["panels"], {**POINTS, "part": [1, 2]}, LINES, SCATTER, IMAGE]},
)
SVG = "{http://www.w3.org/2000/svg}"

# What no schema can say: names of columns and their values, and which of two numbers is greater.
BEYOND_SCHEMA = re.compile(
    r"""
      /plot/panels/\d/(group|series|x|y|low|high|line|pixels)\ =\ "word"
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
        for text in ("all", "points of xi", "title of points", "lines of xi", "marks of xi", "White noise", "smooth", "order0 mid"):
            self.assertIn(f">{text}</text>", image)
        self.assertEqual(self.drawn(PANELS), image)

    def test_title_and_description_are_in_the_file(self):
        root = ElementTree.fromstring(self.drawn(changed(PANELS, "/question", "Is 1 < 2 & true?")))
        self.assertEqual([child.tag for child in root[:2]], [SVG + "title", SVG + "desc"])
        self.assertEqual(root[0].text, "all")
        for words in ("Is 1 < 2 & true? Panels: xi;", "title of points: points of xi", "lines of xi against fetches"):
            self.assertIn(words, root[1].text)

    def test_fonts_of_pdf_are_truetype(self):
        self.drawn(PANELS)
        self.output_of("plot", "small.json", "--format", "pdf", "-o", "plots")
        image = (self.folder / "plots/small.pdf").read_bytes()
        self.assertIn(b"/FontFile2", image)
        self.assertNotIn(b"/Type3", image)
        self.output_of("plot", "small.json", "--format", "pdf", "-o", "again")
        self.assertEqual((self.folder / "again/small.pdf").read_bytes(), image)

    def redrawn(self, result, *options):
        """The SVG of a result."""
        self.write("result.json", result)
        self.output_of("plot", "result.json", "-o", "plots", *options)
        return (self.folder / "plots/result.svg").read_text()

    def result(self):
        return self.json_of("run", self.write("experiment.json", PANELS))

    def test_width_columns_and_font_size(self):
        result = self.result()

        def size_and_fonts(*options):
            image = self.redrawn(result, *options)
            width, height = map(float, re.search(r'width="([\d.]+)pt" height="([\d.]+)pt"', image).groups())
            return width, height, set(re.findall(r"font: ([\d.]+)px", image))

        width, height, fonts = size_and_fonts()
        self.assertAlmostEqual(width, 2 * 3.7 * 72)
        self.assertIn("8", fonts)
        narrow = size_and_fonts("--width", "3.25", "--columns", "1", "--font-size", "6")
        self.assertAlmostEqual(narrow[0], 3.25 * 72)
        self.assertGreater(narrow[1], 1.2 * height)  # panels below one another
        self.assertIn("6", narrow[2])
        self.assertNotIn("8", narrow[2])
        self.assertAlmostEqual(size_and_fonts("--columns", "3")[0], 3 * 3.7 * 72)
        for options in (["--width", "1"], ["--columns", "0"], ["--columns", "9"], ["--font-size", "3"], ["--columns", "1.5"]):
            self.assert_refused(self.run_program("plot", "result.json", *options), options[0])

    def test_another_specification_needs_no_run(self):
        quick = self.json_of("run", self.write("experiment.json", PANELS), "--profile", "quick")
        self.write("quick.json", quick)
        own = changed(changed(PANELS, "/plot/title", "told anew"), "/quick/plot", {"note": "of the quick one"})
        self.write("own.json", own)
        image = self.redrawn(self.result(), "--spec", "own.json")
        self.assertIn(">told anew</text>", image)
        self.assertNotIn(">of the quick one</text>", image)
        self.output_of("plot", "result.json", "quick.json", "--spec", "own.json", "-o", "plots")
        self.assertEqual((self.folder / "plots/result.svg").read_text(), image)
        self.assertIn(">of the quick one</text>", (self.folder / "plots/quick.svg").read_text())

        def refusal(path, value, *results):
            self.write("own.json", changed(own, path, value))
            return self.run_program("plot", *(results or ["result.json"]), "--spec", "own.json", "-o", "refused")

        self.assert_refused(refusal("/name", "other"), 'result.json: /experiment/name: found "small"; a result of "other"', "own.json")
        self.assert_refused(refusal("/plot", ...), "own.json: /plot: ")
        self.assert_refused(refusal("/plot/panels/1/value", "xi_p51"), "own.json: /plot/panels/1/value: ")
        del quick["columns"]["xi_p50"]
        self.write("quick.json", quick)
        self.assert_refused(refusal("/seed", 1, "result.json", "quick.json"), "own.json: /plot/panels/0/value: ",
                            'the column "xi_p50", which quick.json does not have')
        self.assertFalse((self.folder / "refused").exists())

    def test_numbers_of_short_log_axes_stand_in_line(self):
        result = self.result()
        result["experiment"]["plot"]["panels"] = [{**POINTS, "low": "xi_p50", "high": "xi_p50"}]
        rows = [row for row in result["rows"] if row["measure"] == "signal_error"]
        for low, high in ((0.9, 1.1), (0.97, 1.01), (0.2, 6.5), (1, 20), (3, 4), (1e-3, 1e-1), (1e-9, 1)):
            with self.subTest(low=low, high=high):
                for index, row in enumerate(rows):
                    row["xi_p50"] = low if index % 2 else high
                root = ElementTree.fromstring(self.redrawn(result))
                ticks = [group for group in root.iter(SVG + "g") if group.get("id", "").startswith("xtick_")]
                # A number is a text at x and y, or a group that is moved there, as 10^2 is.
                parts = [part for tick in ticks for part in tick.iter() if part.tag in (SVG + "text", SVG + "g")]
                places = [part.get("y") or part.get("transform", "") for part in parts]
                heights = [float(re.sub(r"translate\(\S+ (\S+)\)", r"\1", place)) for place in places if re.match(r"[-\d]|translate", place)]
                self.assertGreaterEqual(len(heights), 2)
                self.assertLess(max(heights) - min(heights), 0.75)

    def test_a_hidden_curve_is_wider_than_those_on_it(self):
        result = self.result()
        result["experiment"]["plot"]["panels"] = [LINES]
        self.assertEqual(set(re.findall(r"stroke-width: (2.9|4.7)", self.redrawn(result))), set())
        for row in result["rows"]:
            row["fetches_mean"] = 10 if row["field"] == "white" else 20
            if row.get("scheme") in ("order1", "order2"):
                row["xi_p50"] = 0.25 if row["field"] == "white" else 0.5
        self.assertEqual(set(re.findall(r"stroke-width: (2.9|4.7)", self.redrawn(result))), {"2.9"})

    def test_a_legend_stands_once(self):
        result = self.result()

        def legends(*panels):
            result["experiment"]["plot"]["panels"] = panels
            return self.redrawn(result).count('id="legend_')

        by_field = {**LINES, "series": "field"}
        self.assertEqual(legends(LINES, LINES, LINES, LINES), 1)
        self.assertEqual(legends(LINES, by_field, LINES, by_field), 2)  # above each column
        self.assertEqual(legends(LINES, LINES, by_field, by_field), 2)  # above each row
        self.assertEqual(legends(LINES, by_field, by_field, LINES), 4)

    def test_pale_colours_and_thin_markers_show_on_white(self):
        result = self.result()
        result["styles"]["order1"] = {"color": "#ffff99", "marker": "1", "label": "pale"}
        image = self.redrawn(result)
        self.assertNotIn("#ffff99", image)
        result["styles"]["order1"] = {"color": "#ffff99", "marker": "8", "label": "pale"}
        self.assertEqual(self.redrawn(result), image)

    def test_a_picture_can_be_turned(self):
        result = self.result()

        def picture(lines, **options):
            result["experiment"]["plot"]["panels"] = [
                {"kind": "image", "rows": {"measure": "picture"}, "line": "line", "pixels": "pixels", "label": "p", **options}
            ]
            rows = [{"measure": "picture", "line": line, "pixels": pixels} for line, pixels in enumerate(lines)]
            return self.redrawn({**result, "rows": rows})

        self.assertEqual(picture(["00408a", "ff2010"], turned="left"), picture(["8a10", "4020", "00ff"]))
        self.assertEqual(picture(["00408a", "ff2010"], turned="right"), picture(["ff00", "2040", "108a"]))

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
