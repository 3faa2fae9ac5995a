"""The measures of images: their numbers are those that `raytruth compare` gives for rendered files."""

import json
import unittest

import numpy

from support import ProgramTest

POINTS = [
    {"s": 0, "extinction": 0, "color": [0.2, 0.4, 1]},
    {"s": 0.4, "extinction": 0, "color": [0.2, 0.4, 1]},
    {"s": 1, "extinction": 1.5, "color": [1, 0.8, 0.3]},
]
SIDE = 11  # samples of the field along each axis
DRAWN = {"scheme": "order1", "step": 1, "table": {"size": 24, "format": "unorm8"}}
VARIANTS = {"coarse": {"scheme": "riemann_mid", "step": 2}, "fine": {"scheme": "riemann_mid", "step": 1}, "drawn": DRAWN}

EXPERIMENT = {
    "raytruth": "experiment/1",
    "name": "images",
    "question": "Does it agree?",
    "source": "none",
    "fields": [{"name": "signal", "kind": "marschner_lobb", "samples": SIDE}],
    "rays": {"count": 1, "length": 1},
    "transfer_functions": [{"name": "points", "kind": "points", "transfer_function": {"points": POINTS}}],
    "measures": [
        {
            "kind": "images",
            "size": [20, 12],
            "views": [
                {
                    "name": "view",
                    "field": "signal",
                    "transfer": "points",
                    "camera": {"kind": "orthographic", "from": [0.5, -1, 0.3], "up": [0, 0, 1], "height": 0.7},
                }
            ],
            "variants": [{"name": name, **scene} for name, scene in VARIANTS.items()],
            "against": ["coarse"],
            "baselines": ["coarse"],
            "pictures": {"views": ["view"], "images": ["drawn"], "errors": ["drawn"], "against": "certified", "gain": 2},
        }
    ],
}


class Images(ProgramTest):
    def rows(self, **wanted):
        return [row for row in self.result["rows"] if all(row.get(key) == value for key, value in wanted.items())]

    def row(self, **wanted):
        (row,) = self.rows(line=None, **wanted)
        return row

    def render(self, name, scene):
        """The same view as a scene file: lengths are in the grid's diagonals, from its middle."""
        middle, diagonal = (SIDE - 1) / 2, 3**0.5 * SIDE
        camera = EXPERIMENT["measures"][0]["views"][0]["camera"]
        document = {
            "volume": {"kind": "marschner_lobb", "samples": SIDE},
            "transfer_function": {"points": POINTS},
            "camera": {
                "eye": [middle + diagonal * x for x in camera["from"]],
                "target": [middle] * 3,
                "up": camera["up"],
                "height": diagonal * camera["height"],
                "size": [20, 12],
            },
            **scene,
        }
        self.write("scene.json", json.dumps(document))
        for extension in ("pfm", "png"):
            self.json_of("render", "scene.json", "-o", f"{name}.{extension}")

    def setUp(self):
        super().setUp()
        self.write("images.json", json.dumps(EXPERIMENT))
        self.result = self.json_of("run", "images.json")

    def test_errors_are_those_of_compare(self):
        for name, scene in {"certified": {"scheme": "reference"}, **VARIANTS}.items():
            self.render(name, scene)
        for against in ("certified", "coarse"):
            for frame, extension in (("linear", "pfm"), ("srgb8", "png")):
                expected = self.json_of("compare", f"{against}.{extension}", f"drawn.{extension}")
                row = self.row(variant="drawn", against=against, frame=frame)
                # Files of 8 bits hold the same frames; .pfm rounds light to 24 bits.
                places = 12 if frame == "srgb8" else 6
                for key in ("rmse", "maximum", "bias"):
                    self.assertAlmostEqual(row[key], expected[key], places, (against, frame, key))
                for key in ("danskin_hanrahan", "psnr"):
                    self.assertAlmostEqual(row[key], expected[key], places - 3, (against, frame, key))
                self.assertEqual([row["column"], row["row"]], expected["maximum_pixel"])
        self.assertGreater(self.row(variant="drawn", against="certified", frame="linear")["maximum"], 1e-3)

    def test_orders_and_gains_come_from_the_errors(self):
        coarse = self.row(variant="coarse", against="certified", frame="linear")
        fine = self.row(variant="fine", against="certified", frame="linear")
        ratio = coarse["rmse"] / fine["rmse"]
        self.assertAlmostEqual(2 ** fine["order"], ratio)
        self.assertAlmostEqual(fine["gain_over_coarse"], fine["psnr"] - coarse["psnr"])
        self.assertIsNone(coarse.get("order"))

    def test_pictures_hold_the_frame_and_the_error(self):
        lines = self.rows(variant="drawn", against=None)
        errors = [row for row in self.rows(variant="drawn", against="certified") if row.get("line") is not None]
        self.assertEqual([row["line"] for row in lines], list(range(12)))
        self.assertEqual({len(row["pixels"]) for row in lines}, {20 * 6})
        largest = max(max(bytes.fromhex(row["pixels"])) for row in errors)
        row = self.row(variant="drawn", against="certified", frame="linear")
        self.assertEqual(largest, int(255 * min(1, 2 * row["maximum"]) + 0.5))
        self.assertEqual(bytes.fromhex(errors[row["row"]]["pixels"])[row["column"]], largest)

    def test_variants_have_the_light_of_their_view(self):
        """An image of a lit view is that of a scene whose shading the variant changes in a member."""
        light = {"light": [0.3, -1, 0.5], "ambient": 0.2, "diffuse": 0.8, "specular": 0.4, "shininess": 10, "highlight": "cone"}
        lit = json.loads(json.dumps(EXPERIMENT))
        (measure,) = lit["measures"]
        measure["views"].append({**measure["views"][0], "name": "lit", "shading": light})
        measure["variants"] = [
            {"name": "mean", "scheme": "order1", "step": 1, "views": ["lit"], "shading": {"method": "mean_gradient"}},
            {"name": "coarse", "scheme": "order1", "step": 2, "shading": {**light, "method": "mean_gradient"}},
            {"name": "lobe", "scheme": "reference", "views": ["lit"], "shading": {"highlight": "lobe"}},
        ]
        measure["banding_window"] = 8
        measure.pop("pictures")
        self.write("images.json", json.dumps(lit))
        self.result = self.json_of("run", "images.json")
        self.assertEqual({row["variant"] for row in self.rows(view="view")}, {"certified", "coarse"})
        self.render("truth", {"scheme": "reference", "shading": light})
        self.render("mean", {"scheme": "order1", "step": 1, "shading": {**light, "method": "mean_gradient"}})
        self.render("coarse", {"scheme": "order1", "step": 2, "shading": {**light, "method": "mean_gradient"}})
        self.render("lobe", {"scheme": "reference", "shading": {**light, "highlight": "lobe"}})
        for variant in ("mean", "lobe"):
            row = self.row(view="lit", variant=variant, against="certified", frame="linear")
            expected = self.json_of("compare", "truth.pfm", f"{variant}.pfm")
            self.assertAlmostEqual(row["rmse"], expected["rmse"], 6)
            self.assertGreater(row["rmse"], 1e-3)
        self.assertEqual(self.row(view="lit", variant="lobe", against="certified", frame="linear")["shading"], "pointwise")
        self.check_share_of_closer_pixels()

    def check_share_of_closer_pixels(self):
        truth, mean, coarse = (numpy.clip(self.pixels(name), 0, 1) for name in ("truth", "mean", "coarse"))
        distance = lambda a, b: abs(a - b).max(axis=2)
        different = distance(mean, coarse) > 1 / 510
        closer = different & (distance(mean, truth) < distance(coarse, truth))
        row = self.row(view="lit", variant="mean", against="certified", frame="linear")
        self.assertTrue(0 < closer.sum() < different.sum())
        self.assertAlmostEqual(row["closer_than_coarse"], 100 * closer.sum() / different.sum())

    def pixels(self, name):
        """Of a .pfm file, whose lowest row comes first."""
        header, size, scale, data = (self.folder / f"{name}.pfm").read_bytes().split(b"\n", 3)
        self.assertEqual((header, size, float(scale) < 0), (b"PF", b"20 12", True))
        return numpy.frombuffer(data, "<f4").reshape(12, 20, 3)[::-1].astype(float)

    def test_stripes_at_the_borders_of_slabs(self):
        """Of a plane that is askew, whose samples are held for a step: all that is wrong follows its place in the step."""
        z, y, x = numpy.indices((24, 24, 24)).astype("<f8")
        numpy.save(self.folder / "ramp.npy", x + 0.5 * y + 0.3 * z)
        # Its scalars become 0 to 1. From the surface on it turns from white to black.
        points = [{"s": s, "extinction": e, "color": [c] * 3} for s, e, c in ((0, 0, 1), (0.46, 0, 1), (0.46, 2000, 1), (0.56, 2000, 0))]
        ramp = json.loads(json.dumps(EXPERIMENT))
        ramp["fields"] = [{"name": "signal", "kind": "volume", "volume": "ramp.npy", "spacing": [1, 1, 1]}]
        ramp["transfer_functions"][0]["transfer_function"] = {"points": points}
        (measure,) = ramp["measures"]
        measure["size"] = [40, 40]
        measure["views"][0]["camera"] = {"kind": "orthographic", "from": [-1, 0.33, 0.21], "up": [0, 0, 1], "height": 0.3}
        measure["variants"] = [
            {"name": "held", "scheme": "riemann_left", "step": 1}, {"name": "exact", "scheme": "order1", "step": 1},
            {"name": "cells", "scheme": "order0_mid", "sampling": "cells"},
        ]
        for key in ("against", "baselines", "pictures"):
            measure.pop(key)
        measure["slab_banding_window"] = 20
        self.write("images.json", json.dumps(ramp))
        self.result = self.json_of("run", "images.json")
        held, exact, cells = (self.row(variant=name, against="certified", frame="linear") for name in ("held", "exact", "cells"))
        # The first sample in matter lies 0 to 1 behind its surface, so all colours are taken from so far behind.
        self.assertGreater(held["slab_banding"], 0.98)
        self.assertGreater(held["slab_windows"], 1)
        self.assertGreater(held["slab_jump"], 0.1)
        self.assertLess(held["slab_jump"], 2 * held["maximum"])
        self.assertLess(exact["rmse"], 1e-9)  # the ramp is a line along every ray
        self.assertIsNone(cells.get("slab_banding"))  # no step
        measure["slab_banding_window"] = 41
        self.write("images.json", json.dumps(ramp))
        self.assert_refused(self.run_program("run", "images.json"), "/measures/0/slab_banding_window: ")

    def test_refuses_bad_variants_with_their_place(self):
        for change, place in (({"scheme": "best"}, "scheme"), ({"table": {"size": 1}}, "table/size"), ({"volume": "x"}, "volume")):
            bad = json.loads(json.dumps(EXPERIMENT))
            bad["measures"][0]["variants"][2].update(change)
            self.write("images.json", json.dumps(bad))
            self.assert_refused(self.run_program("run", "images.json"), f"/measures/0/variants/2/{place}: ")


class Waterfall(ProgramTest):
    STAGES = ("frame", "arithmetic", "early_termination", "shading", "quadrature", "classification", "reconstruction")

    def setUp(self):
        super().setUp()
        view = {**EXPERIMENT["measures"][0]["views"][0], "shading": {"method": "mean_gradient", "light": [0.3, -1, 0.5], **self.LIGHT}}
        measure = {"kind": "error_waterfall", "size": [20, 12], "renderer": {"step": 1, "early_termination": 0.9}, "entries": 32}
        self.write("w.json", json.dumps({**EXPERIMENT, "name": "w", "measures": [{**measure, "views": [view], "gain": 4}]}))
        self.rows = [row for row in self.json_of("run", "w.json")["rows"] if row.get("line") is None]

    LIGHT = {"ambient": 0.2, "diffuse": 0.8, "specular": 0.4, "shininess": 10}

    def test_shares_add_up_to_all_of_the_error(self):
        for part in ("alone", "mended", "in turn"):
            shares = [row["share"] for row in self.rows if row["part"] == part]
            self.assertEqual(len(shares), len(self.STAGES) + (part != "in turn"))
            self.assertAlmostEqual(sum(shares), 100, 9)

    def test_every_stage_shows_and_mending_all_leaves_nothing(self):
        rows = {(row["part"], row["stage"]): row for row in self.rows}
        for stage in self.STAGES:
            self.assertGreater(rows["alone", stage]["rmse"], 1e-9, stage)
        self.assertEqual(rows["in turn", self.STAGES[-1]]["rmse_left"], 0)
        # What mending one stage changes is what is left of the error then, apart from the sign.
        self.assertAlmostEqual(rows["in turn", "frame"]["rmse"], rows["mended", "frame"]["rmse"], 12)
        # The frame alone: half a step of 255 where sRGB is steepest in light, 2.4 / 1.055.
        self.assertLess(rows["alone", "frame"]["maximum"], 2.4 / 1.055 / 510 + 1e-9)
        self.assertLess(rows["alone", "arithmetic"]["maximum"], 1e-5)  # some 20 slabs of 2^-24 each, with a margin

    def test_without_light_there_is_no_shading_to_mend(self):
        document = json.loads((self.folder / "w.json").read_text())
        document["measures"][0]["views"][0].pop("shading")
        self.write("w.json", json.dumps(document))
        stages = {row["stage"] for row in self.json_of("run", "w.json")["rows"] if row.get("stage")}
        self.assertEqual(stages, {*self.STAGES, "interaction", "all"} - {"shading"})


class OptimalTable(ProgramTest):
    SIZES = [4, 8, 16, 32, 64]

    def setUp(self):
        super().setUp()
        fields = [{"name": f"signal_{side}", "kind": "marschner_lobb", "samples": side} for side in (7, 9, 11)]
        fields.append({"name": "absent", "kind": "volume", "volume": "no_such_volume"})
        gentle = [{**point, "extinction": point["extinction"] / 20} for point in POINTS]
        transfers = [
            {"name": name, "kind": "points", "transfer_function": {"points": points}}
            for name, points in (("points", POINTS), ("gentle", gentle), ("steep", POINTS[:2] + [{**POINTS[2], "s": 0.45}]))
        ]
        camera = EXPERIMENT["measures"][0]["views"][0]["camera"]
        measure = {"kind": "optimal_table", "size": [20, 12], "camera": camera, "sizes": self.SIZES, "reference": 64}
        measure |= {"threshold": 0.5, "slabs": 200, "slab_table": 32}
        document = {**EXPERIMENT, "name": "o", "fields": fields, "transfer_functions": transfers, "measures": [measure]}
        self.write("o.json", json.dumps(document))
        self.rows = self.json_of("run", "o.json")["rows"]

    def part(self, part, **wanted):
        return [row for row in self.rows if row.get("part") == part and all(row.get(key) == value for key, value in wanted.items())]

    def test_the_smallest_size_is_that_from_which_errors_stay_below_the_threshold(self):
        for case in self.part("case"):
            keys = {"field": case["field"], "transfer": case["transfer"]}
            errors = {row["table_size"]: row["error"] for row in self.part("size", **keys)}
            self.assertEqual(list(errors), self.SIZES)
            enough = [size for size in self.SIZES if all(errors[other] < 0.5 for other in self.SIZES if other >= size)]
            self.assertEqual(case["smallest"], enough[0] if enough else None)
        self.assertGreater(len({case["smallest"] for case in self.part("case")}), 1)

    def test_mean_opacity_is_the_integral(self):
        for case in self.part("case", transfer="points"):
            s = (numpy.arange(200_000) + 0.5) / 200_000
            self.assertAlmostEqual(case["mean_opacity"], (1 - numpy.exp(-1.5 * numpy.clip((s - 0.4) / 0.6, 0, 1))).mean(), 9)

    def test_predictions_do_not_know_what_they_predict(self):
        cases = {(row["field"], row["transfer"]): numpy.log2(row["smallest"]) for row in self.part("case") if row["smallest"]}
        for held_out in ("volume", "volume and transfer function"):
            rows = self.part("prediction", model="mean", held_out=held_out)
            self.assertEqual(len(rows), len(cases))
            for row in rows:
                others = [
                    value
                    for (field, transfer), value in cases.items()
                    if field != row["volume"] and (held_out == "volume" or transfer != row["transfer"])
                ]
                self.assertAlmostEqual(row["octaves"], sum(others) / len(others) - numpy.log2(row["smallest"]))

    def test_skill_is_against_the_mean(self):
        for held_out in ("volume", "volume and transfer function"):
            squares = {
                model: sum(row["octaves"] ** 2 for row in self.part("prediction", model=model, held_out=held_out))
                for model in ("mean", "interpolated", "slabs")
            }
            for model, sum_of_squares in squares.items():
                (row,) = self.part("model", model=model, held_out=held_out)
                self.assertAlmostEqual(row["skill"], 1 - sum_of_squares / squares["mean"])

    def test_an_absent_volume_is_refused_and_the_others_go_on(self):
        (row,) = [row for row in self.rows if row["field"] == "absent"]
        self.assertEqual(row["status"], "refused")
        self.assertTrue(self.part("model"))


if __name__ == "__main__":
    unittest.main()
