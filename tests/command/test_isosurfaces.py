"""Isosurfaces: hits and light of rays and images, against closed forms, and what is refused."""

import math
import unittest

import numpy
from support import RAY, SLAB, VOLUME_RAY, ProgramTest, changed
from test_render import NOISE, SCENE

WHITE = [1, 1, 1]


def surface(s, opacity=0.5, color=WHITE):
    return {"s": s, "opacity": opacity, "color": color}


def polynomial(breaks, coefficients, *surfaces, points=None):
    """A ray for the reference alone, in matter of these points or in empty space."""
    transfer = {"isosurfaces": list(surfaces)}
    if points is not None:
        transfer = {"points": points, **transfer}
    return {
        "signal": {"kind": "piecewise_polynomial", "breaks": breaks, "coefficients": coefficients},
        "transfer_function": transfer,
        "schemes": ["reference"],
    }


class Rays(ProgramTest):
    def reference_of(self, case):
        return self.json_of("eval", "-", stdin=case)["reference"]

    def test_hits_of_a_cubic(self):
        # s = (t - 1/4)(t - 1/2)(t - 3/4) crosses 0 three times.
        reference = self.reference_of(polynomial([0, 1], [[-0.09375, 0.6875, -1.5, 1]], surface(0)))
        self.assertEqual([hit["rising"] for hit in reference["hits"]], [True, False, True])
        for hit, t in zip(reference["hits"], (0.25, 0.5, 0.75)):
            self.assertLessEqual(abs(hit["t"] - t), hit["radius"])
            self.assertLessEqual(hit["radius"], 1e-13)
            self.assertEqual(hit["surface"], 0)
        self.assertEqual(reference["unresolved"], [])
        self.assertAlmostEqual(reference["opacity"], 1 - 0.5**3, delta=reference["error_bound"])
        self.assertLess(reference["error_bound"], 1e-14)

    def test_contacts_level_stretches_ends_and_jumps(self):
        for name, breaks, coefficients, surfaces, hits in (
            ("a double contact", [0, 1], [[0.25, -1, 1]], [surface(0)], []),
            ("a threefold one", [0, 1], [[-0.125, 0.75, -1.5, 1]], [surface(0)], [(0.5, 0)]),
            ("the ends of a ray", [0, 1], [[0, 1]], [surface(0), surface(1)], []),
            ("level, then on", [0, 1, 2, 3], [[0, 1], [1], [1, 1]], [surface(1)], [(1, 0)]),
            ("level, then back", [0, 1, 2, 3], [[0, 1], [1], [1, -1]], [surface(1)], []),
            ("a jump", [0, 1, 2], [[4], [0]], [surface(1), surface(2)], [(1, 1), (1, 0)]),
        ):
            with self.subTest(name):
                reference = self.reference_of(polynomial(breaks, coefficients, *surfaces))
                self.assertEqual([(round(hit["t"], 12), hit["surface"]) for hit in reference["hits"]], hits)
                self.assertEqual(reference["unresolved"], [])

    def test_order_of_surfaces_and_matter(self):
        # s = t: fog of extinction 2 from 0 to 1/2, an opaque yellow surface in a green one's shadow.
        fog = [{"s": 0, "extinction": 2, "color": [0, 0, 1]}]
        case = polynomial([0, 1], [[0, 1]], surface(0.25, 0.5, [0, 1, 0]), surface(0.5, 1, [1, 1, 0]), points=fog)
        reference = self.reference_of(case)
        quarter = math.exp(-0.5)
        expected = [
            quarter * 0.5 * quarter,
            quarter * (0.5 + 0.5 * quarter),
            (1 - quarter) * (1 + quarter * 0.5),
        ]
        for found, known in zip(reference["color"], expected):
            self.assertLessEqual(abs(found - known), reference["error_bound"] + 1e-16)
        self.assertEqual(reference["opacity"], 1)

    def test_a_ray_through_a_volume(self):
        # s = (t / sqrt 3)^3 is 1/8 half-way.
        transfer = {"isosurfaces": [surface(0.125)]}
        case = {**VOLUME_RAY, "transfer_function": transfer, "schemes": ["reference"]}
        reference = self.reference_of(case)
        (hit,) = reference["hits"]
        self.assertLessEqual(abs(hit["t"] - 3**0.5 / 2), hit["radius"] + 1e-15)
        self.assertLessEqual(hit["radius"], 1e-13)

    def test_schemes_that_see_no_surfaces_say_so(self):
        case = changed(RAY, "/transfer_function/isosurfaces", [surface(0.5)])
        answer = self.json_of("eval", "-", stdin=case)
        for scheme in answer["schemes"].values():
            self.assertEqual(scheme["status"], "refused")
            self.assertIn("isosurfaces", scheme["why"])

    def test_refusals(self):
        case = polynomial([0, 1], [[0, 1]], surface(0.25), surface(0.5))
        for pointer, value, words in (
            ("/transfer_function/isosurfaces/1/s", 0.25, "/transfer_function/isosurfaces/1: found s 0.25 after 0.25"),
            ("/transfer_function/isosurfaces/0/opacity", 1.5, "/transfer_function/isosurfaces/0/opacity: found 1.5"),
            ("/transfer_function/isosurfaces/0/color", [1, -1, 1], "/transfer_function/isosurfaces/0: found color"),
            ("/transfer_function/isosurfaces", [], "/transfer_function/isosurfaces: found"),
            ("/transfer_function/unit_length", 1, "/transfer_function/unit_length"),
            ("/signal", {"kind": "analytic", "name": "sine_slow"}, "isosurfaces with the signal analytic"),
        ):
            with self.subTest(pointer):
                self.assert_refused(self.run_program("eval", "-", stdin=changed(case, pointer, value)), words)
        slab = changed(SLAB, "/transfer_function/isosurfaces", [surface(0.5)])
        self.assert_refused(self.run_program("eval", "-", stdin=slab), "/transfer_function/isosurfaces: found isosurfaces here")

    def test_transfer_shows_and_writes_them(self):
        transfer = {"isosurfaces": [surface(0.25, 0.125, [1, 0.5, 0])]}
        self.write("t.json", transfer)
        self.assertIn("isosurface", self.output_of("transfer", "t.json"))
        written = self.json_of("transfer", "t.json", "--json")
        self.assertEqual(written["isosurfaces"], [surface(0.25, 0.125, [1, 0.5, 0])])


class Images(ProgramTest):
    def image_of(self, scene):
        answer = self.json_of("render", self.write("scene.json", scene), "-o", "image.npy")
        return numpy.load(self.folder / "image.npy"), answer

    def test_an_image_in_empty_space(self):
        # Each ray sees s rise from 0 to 1 or fall again: SCENE's rows are the same along y and z.
        volume = {"size": [2, 2, 3], "values": [0] * 4 + [1] * 4 + [0] * 4}
        scene = {**SCENE, "volume": volume, "transfer_function": {"isosurfaces": [surface(0.5, 0.5, [1, 0.5, 0.25])]}}
        image, answer = self.image_of(changed(scene, "/camera/target", [0.5, 0.5, 0.5]))
        self.assertEqual(answer["unresolved_contacts"], 0)
        self.assertTrue(answer["certified"])
        self.assertGreater(numpy.count_nonzero(image[..., 3]), 0)
        for pixel in image.reshape(-1, 4):
            if pixel[3]:
                numpy.testing.assert_allclose(pixel, [0.75, 0.375, 0.1875, 0.75], atol=1e-7)

    def test_matter_alone_is_what_it_was(self):
        points = [{"s": s, "extinction": extinction, "color": WHITE} for s, extinction in ((0.3, 0), (0.8, 3))]
        plain, _ = self.image_of({**NOISE, "transfer_function": {"points": points}})
        clear = {"points": points, "isosurfaces": [surface(0.45, 0), surface(0.6, 0)]}
        cut, answer = self.image_of({**NOISE, "transfer_function": clear})
        numpy.testing.assert_allclose(cut, plain, atol=1e-6)
        self.assertEqual(answer["unresolved_contacts"], 0)

    def test_refusals_and_warnings(self):
        scene = {**NOISE, "transfer_function": {"isosurfaces": [surface(0.5)]}}
        step = changed(changed(scene, "/scheme", "order1"), "/step", 0.5)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=step), "/scheme: found order1 with isosurfaces")
        light = {"light": [0, 0, 1], "ambient": 0.1, "diffuse": 0.9, "specular": 0, "shininess": 20}
        lit = changed(scene, "/shading", light)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=lit), "/shading: found light on isosurfaces")
        missed = self.run_program("render", "-", "-o", "x.npy", stdin=changed(scene, "/transfer_function/isosurfaces/0/s", 2))
        self.assertIn(b"no isosurface is crossed", missed.stderr)


if __name__ == "__main__":
    unittest.main()
