"""The measure `images`: its numbers are those that `raytruth compare` gives for rendered files."""

import json

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

    def test_refuses_bad_variants_with_their_place(self):
        for change, place in (({"scheme": "best"}, "scheme"), ({"table": {"size": 1}}, "table/size"), ({"volume": "x"}, "volume")):
            bad = json.loads(json.dumps(EXPERIMENT))
            bad["measures"][0]["variants"][2].update(change)
            self.write("images.json", json.dumps(bad))
            self.assert_refused(self.run_program("run", "images.json"), f"/measures/0/variants/2/{place}: ")
