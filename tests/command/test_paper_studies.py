"""Small studies of the publications' own sentences, against the same computed here."""

import json
import unittest

import numpy

from support import ProgramTest

WEIGHTS = {
    "linear_gradient": lambda s, c: s,
    "normalized_linear": lambda s, c: s / numpy.sqrt(0.5 + 0.5 * c + (2 * s - 1) ** 2 * (0.5 - 0.5 * c)),
    "quadratic_arc": lambda s, c: s * (1 + (2 * s - 1) ** 2 * (numpy.sqrt((1 + c) / 2) - 1)) / numpy.sqrt((1 + c) / 2),
}


class Studies(ProgramTest):
    def rows(self, *measures):
        experiment = {"raytruth": "experiment/1", "name": "study", "question": "Does it agree?", "source": "none", "seed": 1, "measures": measures}
        self.write("study.json", json.dumps(experiment))
        return self.json_of("run", "study.json")["rows"]

    def test_mirrored_gradients_add_light(self):
        lights = 500
        index = numpy.arange(lights)
        height = 1 - (2 * index + 1) / lights
        turn = 2 * numpy.pi * index / ((1 + 5**0.5) / 2) ** 2
        radius = numpy.sqrt(1 - height**2)
        light = numpy.stack([radius * numpy.cos(turn), radius * numpy.sin(turn), height], 1)
        s = (numpy.arange(256) + 0.5) / 256
        rows = self.rows({"kind": "mirrored_gradient", "angles": [40, 90, 150], "lights": lights})
        for row in rows:
            if row["curve"] not in WEIGHTS:
                continue
            half = numpy.radians(row["angle_degrees"]) / 2
            front, back = (light @ [side * numpy.sin(half), 0, numpy.cos(half)] for side in (-1, 1))
            across = front * back < 0
            front, back = front[across, None], back[across, None]
            mean = lambda curve, f, b, c: abs(f * WEIGHTS[curve](1 - s, c) + b * WEIGHTS[curve](s, c)).mean(1)
            cosine = numpy.cos(2 * half)
            added = mean(row["curve"], abs(front), abs(back), -cosine) - mean("normalized_linear", front, back, cosine)
            with self.subTest(curve=row["curve"], angle=row["angle_degrees"]):
                self.assertEqual(row["lights"], across.sum())
                self.assertAlmostEqual(row["added_mean"], added.mean(), 12)
                self.assertAlmostEqual(row["added_min"], added.min(), 12)
                self.assertAlmostEqual(row["added_max"], added.max(), 12)
                self.assertAlmostEqual(row["adding_share"], (added > 0).mean(), 12)
        self.assertEqual({row["curve"] for row in rows} & WEIGHTS.keys(), WEIGHTS.keys())

    def test_tones_are_negative_where_normals_are_too_long(self):
        rows = {(row["curve"], row["angle_degrees"]): row for row in self.rows({"kind": "gooch_tones", "angles": [0, 60, 90, 120]})}
        for angle in (60, 90, 120):
            # |N|^2 = ((1 - (1-c) x^2) / c)^2 (c^2 + x^2 (1 - c^2)), x = 2s - 1, c = cos(angle / 2); largest where its slope is 0.
            x = numpy.linspace(-1, 1, 4097)
            c = numpy.cos(numpy.radians(angle) / 2)
            norm = numpy.sqrt(((1 - (1 - c) * x**2) / c) ** 2 * (c**2 + x**2 * (1 - c**2))).max()
            row = rows["quadratic_arc", angle]
            self.assertAlmostEqual(row["norm_max"], norm, 12)
            self.assertAlmostEqual(row["weight_min"], (1 - norm) / 2, 12)
            self.assertAlmostEqual(row["color_min"], 0.4 * (1 - norm) / 2, 12)
            self.assertLess(row["color_min"], -1e-3)
            self.assertLess(abs(rows["linear_gradient", angle]["color_min"]), 1e-15)  # unit length at both ends

    def test_distances_of_second_order_tables(self):
        options = {"kind": "second_order_distance", "shapes": ["ramp"], "optical_depths": [1], "sizes": [8], "distances": [9, 17, 33], "look_ups": 512}
        rows = {(row["distance_axis"], row["distances"]): row for row in self.rows(options)}
        for (axis, count), row in rows.items():
            self.assertEqual(row["bytes_unorm8"], 4 * 8**3 * count)
            self.assertEqual(row["bytes_float32"], 16 * 8**3 * count)
            self.assertLess(row["radius"], 1e-12)
        # Linear interpolation of a smooth function: a quarter of the error with twice the entries.
        for count in (9, 17):
            ratio = rows["uniform", count]["distance_error_l1"] / rows["uniform", 2 * count - 1]["distance_error_l1"]
            self.assertTrue(3.5 < ratio < 4.5, ratio)
        # Between sqrt(3)/2 and sqrt(3) powers of two have no further entry, however many there are.
        powers = [rows["powers_of_two", count]["distance_error_max"] for count in (9, 17, 33)]
        self.assertEqual(powers[0], powers[1])
        self.assertGreater(powers[2], 10 * rows["uniform", 33]["distance_error_max"])
        # The scalars' axes add to it: nothing is closer than its distances alone.
        self.assertTrue(all(row["error_l1"] > row["distance_error_l1"] for row in rows.values()))


if __name__ == "__main__":
    unittest.main()
