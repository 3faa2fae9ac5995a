"""Fields that are generated: the same ones in scenes, cases and experiments, which read them in one way."""

import unittest

import numpy

from support import EXPERIMENT, ProgramTest, changed
from test_schemas import validator

KINDS = [
    {"kind": "random_field", "size": 12, "smoothing": 1, "seed": 5},
    {"kind": "marschner_lobb", "samples": 12},
    {"kind": "hydrogen_orbital", "size": 12, "n": 4, "l": 3, "m": -2, "extent": 30},
    {"kind": "molecule", "size": 12, "atoms": 7, "seed": 5},
    {"kind": "ct_phantom", "size": 12, "spread": 0.5, "noise": 0.02, "seed": 5},
]
POINTS = {"points": [{"s": 0, "extinction": 0.1, "color": [1, 1, 1]}, {"s": 1, "extinction": 0.5, "color": [1, 0.5, 0]}]}


def scene(field):
    """A picture of one pixel, whose ray is that of `case`."""
    camera = {"eye": [-4, 5, 5], "target": [5, 5, 5], "up": [0, 0, 1], "height": 1, "size": [1, 1]}
    return {"volume": field, "transfer_function": POINTS, "camera": camera, "scheme": "reference"}


def case(field):
    signal = {"kind": "trilinear", "volume": field, "origin": [-1, 5, 5], "direction": [1, 0, 0]}
    return {"signal": signal, "transfer_function": POINTS, "sampling": {"kind": "cells"}, "schemes": ["reference"]}


def experiment(field):
    return changed(EXPERIMENT, "/fields/1", {"name": "smooth", **field})


class GeneratedFields(ProgramTest):
    def test_are_the_same_in_scenes_and_cases(self):
        for field in KINDS:
            with self.subTest(kind=field["kind"]):
                self.output_of("render", self.write("scene.json", scene(field)), "-o", "image.npy")
                pixel = numpy.load(self.folder / "image.npy")[0, 0]
                truth = self.json_of("eval", self.write("case.json", case(field)))["reference"]
                for value, of_pixel in zip([*truth["color"], truth["opacity"]], pixel):
                    self.assertAlmostEqual(value, of_pixel, delta=1e-6)

    def test_are_fields_of_experiments(self):
        for field in KINDS:
            with self.subTest(kind=field["kind"]):
                result = self.json_of("run", self.write("small.json", experiment(field)))
                described = result["fields"]["smooth"]
                self.assertEqual((described["size"], described["data_min"], described["data_max"]), ([12] * 3, 0, 1))

    def test_defaults_are_filled_in(self):
        result = self.json_of("run", self.write("small.json", experiment({"kind": "hydrogen_orbital"})))
        self.assertEqual(result["experiment"]["fields"][1],
                         {"name": "smooth", "kind": "hydrogen_orbital", "size": 64, "n": 3, "l": 2, "m": 0, "extent": 20})

    def test_seed_is_that_of_the_experiment_unless_stated(self):
        field = {"kind": "molecule", "size": 16}
        rows = [self.json_of("run", self.write("small.json", document))["rows"]
                for document in (experiment(field), experiment({**field, "seed": 1}), experiment({**field, "seed": 2}))]
        self.assertEqual(rows[0], rows[1])
        self.assertNotEqual(rows[0], rows[2])

    def test_are_refused_in_one_way(self):
        for change, option in [({"size": 2049}, "size"), ({"size": 0}, "size"), ({"l": 4}, "l"), ({"m": 4}, "m"), ({"extent": 0}, "extent"),
                               ({"spread": 1}, "spread"), ({"kind": "hydrogen"}, "kind")]:
            field = {**KINDS[2], **change}
            for command, document, place in [("run", experiment(field), "/fields/1"), ("eval", case(field), "/signal/volume")]:
                with self.subTest(command=command, change=change):
                    self.assert_refused(self.run_program(command, self.write("bad.json", document)), f"bad.json: {place}/{option}: ")
            with self.subTest(command="render", change=change):
                done = self.run_program("render", self.write("bad.json", scene(field)), "-o", "image.npy")
                self.assert_refused(done, f"bad.json: /volume/{option}: ")

    def test_schemas_know_them(self):
        for field in KINDS:
            for name, document in [("scene", scene(field)), ("case", case(field)), ("experiment", experiment(field))]:
                with self.subTest(kind=field["kind"], schema=name):
                    self.assertTrue(validator(name).is_valid(document))
                    unknown = {"scene": scene, "case": case, "experiment": experiment}[name]({**field, "unknown": 1})
                    self.assertFalse(validator(name).is_valid(unknown))


if __name__ == "__main__":
    unittest.main()
