"""Where a volume ends: half a voxel beyond the centres of its outermost voxels, or at these centres."""

import json
import math
import unittest

import numpy

from support import SOURCE, VOLUME_RAY, ProgramTest, changed

SIZE = numpy.array([6, 5, 7])
SPACING = numpy.array([1, 1.25, 0.8])
COLOR = [1, 0.5, 0.25]
EXTINCTION = 0.35

# Voxels are noise, but what the transfer function makes of them is the same everywhere: light tells the way alone.
SCENE = {
    "volume": {
        "size": SIZE.tolist(),
        "values": numpy.random.default_rng(1).random(SIZE.prod()).round(6).tolist(),
        "spacing": SPACING.tolist(),
    },
    "transfer_function": {"points": [{"s": s, "extinction": EXTINCTION, "color": COLOR} for s in (0, 0.4, 1)]},
    "camera": {"eye": [21, 13, -17], "target": [2.5, 2.5, 2.4], "up": [0, 1, 0], "fov_y": 16, "size": [20, 16]},
    "scheme": "reference",
}
PARALLEL = {"eye": [21, 13, -17], "target": [2.5, 2.5, 2.4], "up": [0, 1, 0], "height": 9, "size": [20, 16]}
LIGHT = {"light": [1, 1, -1], "ambient": 1, "diffuse": 0, "specular": 0, "shininess": 8}

# Every way to make a pixel, and how far it is from the truth by its own arithmetic.
WAYS = {
    "reference": ({}, 1e-13),
    "tricubic": ({"reconstruction": "catmull_rom"}, 1e-13),
    "prefiltered": ({"reconstruction": "bspline_prefiltered"}, 1e-13),
    "opacity": (
        {"transfer_function": {"unit_length": 2, "points": [{"s": 0, "opacity": 1 - math.exp(-2 * EXTINCTION), "color": COLOR}]}},
        1e-13,
    ),
    "scheme": ({"scheme": "order1", "step": 0.5}, 1e-12),
    "cells": ({"scheme": "order2"}, 1e-12),
    "tricubic scheme": ({"scheme": "order1", "step": 0.5, "reconstruction": "bspline"}, 1e-12),
    "cell march": ({"scheme": "cell_cubic"}, 1e-6),
    "cell march with blocks": ({"scheme": "cell_cubic", "empty_space": {"block": 2, "bounds": "corrected"}}, 1e-6),
    "table march": ({"scheme": "order1", "step": 0.5, "table": {"size": 16}}, 1e-5),
    "table march with blocks": (
        {"scheme": "order1", "step": 0.5, "table": {"size": 16}, "empty_space": {"block": 2, "bounds": "corrected"}},
        1e-5,
    ),
    "tricubic table": ({"scheme": "order1", "step": 0.5, "table": {"size": 16}, "reconstruction": "catmull_rom"}, 1e-5),
    "second order table": ({"scheme": "order2", "step": 0.5, "table": {"size": 8}}, 1e-5),
    "lit reference": ({"shading": LIGHT}, 1e-9),
    "lit scheme": ({"scheme": "order1", "step": 0.5, "shading": {**LIGHT, "method": "mean_gradient"}}, 1e-9),
    "lit table": ({"scheme": "order1", "step": 0.5, "table": {"size": 16}, "shading": {**LIGHT, "method": "mean_gradient"}}, 1e-5),
}


def ways_through(camera, border):
    """How far each pixel's ray goes in the volume, in world units: written down anew, from the documents alone."""
    eye, target, up = (numpy.array(camera[key], float) for key in ("eye", "target", "up"))
    width, height = camera["size"]
    forward = (target - eye) / numpy.linalg.norm(target - eye)
    right = numpy.cross(forward, up)
    right /= numpy.linalg.norm(right)
    half = camera["height"] / 2 if "height" in camera else math.tan(math.radians(camera["fov_y"] / 2))
    beyond = {"half_voxel": 0.5, "voxel_centres": 0}[border]
    low, high = -beyond * SPACING, (SIZE - 1 + beyond) * SPACING
    lengths = numpy.zeros((height, width))
    for row in range(height):
        for column in range(width):
            x = ((2 * column + 1) / width - 1) * half * width / height
            y = (1 - (2 * row + 1) / height) * half
            aside = x * right + y * numpy.cross(right, forward)
            origin, direction = (eye + aside, forward) if "height" in camera else (eye, forward + aside)
            direction = direction / numpy.linalg.norm(direction)
            planes = numpy.stack([(low - origin) / direction, (high - origin) / direction])
            lengths[row, column] = max(0, planes.max(axis=0).min() - max(0, planes.min(axis=0).max()))
    return lengths


class Images(ProgramTest):
    def render(self, scene, *options):
        answer = self.json_of("render", self.write("scene.json", scene), "-o", "image.npy", *options)
        return answer, numpy.load(self.folder / "image.npy")

    def test_every_way_to_make_a_pixel(self):
        for camera in (SCENE["camera"], PARALLEL):
            for border in ("half_voxel", "voxel_centres"):
                depth = EXTINCTION * ways_through(camera, border) / SPACING.min()
                opacity = -numpy.expm1(-depth)
                self.assertTrue(0.2 < (opacity > 0).mean() < 1, (opacity > 0).mean())
                for name, (members, tolerance) in WAYS.items():
                    with self.subTest(way=name, border=border):
                        answer, image = self.render({**SCENE, "camera": camera, "border": border, **members}, "--binary64")
                        self.assertEqual(answer["border"], border)
                        numpy.testing.assert_allclose(image[..., 3], opacity, rtol=0, atol=tolerance)
                        for channel in range(3):
                            numpy.testing.assert_allclose(image[..., channel], COLOR[channel] * opacity, rtol=0, atol=tolerance)
                        if answer.get("certified"):
                            radii = numpy.load(self.folder / "image.radius.npy")
                            self.assertTrue((abs(image[..., 3] - opacity) <= radii + 1e-14).all())

    def test_borders_differ_by_half_a_voxel_on_every_side(self):
        across = {"eye": [2.5, 2.5, -9], "target": [2.5, 2.5, 0], "up": [0, 1, 0], "height": 1, "size": [1, 1]}
        for border, voxels in (("half_voxel", 7), ("voxel_centres", 6)):
            _, image = self.render({**SCENE, "camera": across, "border": border}, "--binary64")
            self.assertAlmostEqual(image[0, 0, 3], 1 - math.exp(-EXTINCTION * voxels), 13)

    def test_half_voxel_is_the_default(self):
        answer, image = self.render(SCENE)
        self.assertEqual(answer["border"], "half_voxel")
        _, stated = self.render({**SCENE, "border": "half_voxel"})
        self.assertEqual(image.tobytes(), stated.tobytes())
        self.assertEqual(list(answer)[:5], ["image", "size", "scheme", "volume", "border"])

    def test_camera_beside_the_volume(self):
        """A ray between the two borders meets the volume or does not; the warning says where the volume lies."""
        beside = {"eye": [-0.25, 2.5, -9], "target": [-0.25, 2.5, 0], "up": [0, 1, 0], "height": 0.1, "size": [1, 1]}
        answer, image = self.render({**SCENE, "camera": beside})
        self.assertNotIn("warnings", answer)
        self.assertGreater(image[0, 0, 3], 0.9)
        answer, image = self.render({**SCENE, "camera": beside, "border": "voxel_centres"})
        self.assertEqual(image[0, 0, 3], 0)
        (warning,) = answer["warnings"]
        self.assertIn("x = 0 to 5, y = 0 to 5, z = 0 to 4.8", warning)

    def test_flat_volume_has_no_extent_between_its_centres(self):
        flat = {**SCENE, "volume": {"size": [2, 2, 1], "values": [0, 1, 1, 0]}, "border": "voxel_centres"}
        answer, image = self.render(changed(flat, "/camera", {"size": [8, 8]}))
        self.assertEqual(image.max(), 0)
        self.assertIn("an axis of one voxel has no extent with the border voxel_centres", answer["warnings"][1])
        answer, image = self.render(changed({**flat, "border": "half_voxel"}, "/camera", {"size": [8, 8]}))
        self.assertGreater(image.max(), 0)
        self.assertNotIn("warnings", answer)

    def test_words_that_are_no_border(self):
        for wrong in ("voxel_centers", "", 0.5, None, ["half_voxel"]):
            done = self.run_program("render", self.write("scene.json", {**SCENE, "border": wrong}), "-o", "image.npy")
            self.assert_refused(done, "scene.json: /border: found ")

    def test_help_says_so(self):
        for command in ("render", "eval"):
            for word in ("border", "half_voxel", "voxel_centres"):
                self.assertIn(word, self.output_of(command, "--help"))

    def test_scene_for_eval(self):
        for border in ("half_voxel", "voxel_centres"):
            answer = self.json_of("eval", "-", stdin={**SCENE, "border": border, "scheme": "cell_cubic"})
            self.assertEqual(answer["border"], border)
            self.assertLess(answer["error"]["rmse"], 1e-6)


class Rays(ProgramTest):
    RAY = {
        "signal": {
            "kind": "trilinear",
            "volume": {"size": [4, 2, 2], "values": [0, 1, 2, 3] * 4},
            "origin": [-7, 0.5, 0.25],
            "direction": [1, 0, 0],
        },
        "transfer_function": {"points": [{"s": 0, "extinction": 0, "color": COLOR}, {"s": 4, "extinction": 1, "color": COLOR}]},
        "sampling": {"kind": "cells"},
        "schemes": ["reference", "order1", "order2"],
    }

    def test_ramp_has_the_closed_form(self):
        """s = x between centres; beyond them s is 0 on one side and 3 on the other, for half a voxel each."""
        for border, length, depth in (("half_voxel", 4, 9 / 8 + 3 / 8), ("voxel_centres", 3, 9 / 8), (None, 4, 9 / 8 + 3 / 8)):
            self.check(self.RAY, border, length, depth)

    def test_tricubic_rays(self):
        """A constant, for cubic kernels continue a ramp as constants next to its ends."""
        tricubic = {"kind": "tricubic", "kernel": "catmull_rom", "volume": {"size": [4, 2, 2], "values": [1] * 16}}
        case = {**self.RAY, "signal": {**self.RAY["signal"], **tricubic}}
        for border, length in (("half_voxel", 4), ("voxel_centres", 3), (None, 4)):
            self.check(case, border, length, length / 4)

    def check(self, case, border, length, depth):
        answer = self.json_of("eval", "-", stdin=changed(case, "/signal/border", border) if border else case)
        self.assertEqual((answer["length"], answer["border"]), (length, border or "half_voxel"))
        reference = answer["reference"]
        self.assertLess(reference["error_bound"], 2e-14)
        self.assertLessEqual(abs(reference["opacity"] + math.expm1(-depth)), reference["error_bound"] + 1e-16)
        for scheme in answer["schemes"].values():
            self.assertAlmostEqual(scheme["opacity"], reference["opacity"], 12)
            self.assertAlmostEqual(scheme["xi"], 0, 12)

    def test_rays_without_a_volume_have_no_border(self):
        polynomial = changed(VOLUME_RAY, "/signal", {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[0, 1]]})
        self.assertNotIn("border", self.json_of("eval", "-", stdin=polynomial))
        self.assert_refused(
            self.run_program("eval", self.write("ray.json", changed(polynomial, "/signal/border", "half_voxel"))), "ray.json: /signal/border: "
        )
        self.assert_refused(
            self.run_program("eval", self.write("ray.json", changed(VOLUME_RAY, "/signal/border", "centres"))),
            "ray.json: /signal/border: found ", "half_voxel", "voxel_centres",
        )

    def test_row_of_voxels_with_another_ray(self):
        signal = {"kind": "trilinear", "volume": {"size": [3, 1, 1], "values": [0, 1, 0]}, "direction": [0, 1, 0], "origin": [1, -3, 0]}
        done = self.run_program("eval", "-", stdin={**self.RAY, "signal": {**signal, "border": "voxel_centres"}})
        answer = json.loads(done.stdout)
        self.assertEqual(answer["length"], 0)
        self.assertIn("the ray is empty: an axis of one voxel has no extent", answer["warnings"][0])

    def test_vectors_are_rows_of_voxels_that_end_at_their_centres(self):
        """What the vectors' schema tells renderers, and a second way to their answers: with the samples as voxels, one step
        being one voxel."""
        vectors = json.loads((SOURCE / "results/vectors.json").read_text())["vectors"]
        rays = [vector for vector in vectors if vector["level"] in ("linear_rays", "separate_lists", "opacity_linear", "isoslab") and "signal" in vector]
        self.assertEqual(len(rays), 48)
        cases = []
        for vector in rays:
            breaks, pieces = vector["signal"]["breaks"], vector["signal"]["coefficients"]
            step = breaks[1]
            values = [piece[0] for piece in pieces] + [pieces[-1][0] + pieces[-1][1] * step]
            transfer = json.loads(json.dumps(vector["transfer_function"]))
            if "unit_length" in transfer:
                transfer["unit_length"] /= step
            for point in transfer["points"]:
                if "extinction" in point:
                    point["extinction"] *= step
                if vector["emission"] == "plain":
                    point["color"] = [step * channel for channel in point["color"]]
            cases.append(
                {
                    "signal": {
                        "kind": "trilinear",
                        "border": "voxel_centres",
                        "volume": {"size": [len(values), 1, 1], "values": values},
                        "origin": [-1, 0, 0],
                        "direction": [1, 0, 0],
                    },
                    "transfer_function": transfer,
                    "emission": vector["emission"],
                    "sampling": {"kind": "cells"},
                    "schemes": ["reference"],
                }
            )
        for vector, answer in zip(rays, self.json_of("eval", "-", stdin=cases), strict=True):
            with self.subTest(id=vector["id"]):
                here, there = answer["reference"], vector["reference"]
                bound = here["error_bound"] + there["error_bound"]
                for x, y in zip([*here["color"], here["opacity"]], [*there["color"], there["opacity"]]):
                    self.assertLessEqual(abs(x - y), bound)


if __name__ == "__main__":
    unittest.main()
