"""Isosurfaces: hits and light of rays and images, against closed forms, and what is refused."""

import math
import unittest

import numpy
from support import RAY, SLAB, VOLUME_RAY, ProgramTest, changed
from test_render import NOISE, SCENE

WHITE = [1, 1, 1]
LIGHT = {"light": [0, 0, 1], "ambient": 0.1, "diffuse": 0.9, "specular": 0, "shininess": 20}


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

    def test_schemes_that_find_them(self):
        # s = 3 t and back again in steps of 1: both surfaces lie in each of the two slabs.
        colors = [[1, 0, 0], [0, 0, 1]]
        case = polynomial([0, 1, 2], [[0, 3], [3, -3]], surface(1, 0.5, colors[0]), surface(2, 0.5, colors[1]))
        names = ["every_crossing", "nearest_normal", "nearest_only", "one_per_step", "peak_finding", "threshold"]
        case.update(sampling={"kind": "constant", "step": 1}, schemes=["reference", *names], surface_tolerance=1.5)
        answer = self.json_of("eval", "-", stdin=case)
        third = 1 / 3
        for name, hits in (
            ("every_crossing", [(third, 0), (2 * third, 1), (4 * third, 1), (5 * third, 0)]),
            ("nearest_normal", [(third, 0), (2 * third, 1), (4 * third, 1), (5 * third, 0)]),
            ("nearest_only", [(third, 0), (4 * third, 1)]),
            ("one_per_step", [(1, 0), (2, 0)]),
            ("peak_finding", [(third, 0), (4 * third, 1)]),
            ("threshold", [(0, 0), (1, 1), (2, 0)]),
        ):
            with self.subTest(name):
                scheme = answer["schemes"][name]
                self.assertEqual([hit["surface"] for hit in scheme["hits"]], [index for _, index in hits])
                color, left = numpy.zeros(3), 1
                for hit, (t, index) in zip(scheme["hits"], hits):
                    self.assertAlmostEqual(hit["t"], t, delta=1e-14)
                    color += left * 0.5 * numpy.array(colors[index])
                    left /= 2
                numpy.testing.assert_allclose(scheme["color"], color, atol=1e-15)
                self.assertAlmostEqual(scheme["opacity"], 1 - left, delta=1e-15)
                self.assertAlmostEqual(scheme["opacity_error"], 1 - left - answer["reference"]["opacity"], delta=1e-15)
        self.assertLess(abs(answer["schemes"]["every_crossing"]["opacity_error"]), 1e-15)

    def test_isoslabs(self):
        # s = 3 t up and down again: each surface is passed whole, twice, per length at the slope 3.
        case = polynomial([0, 1, 2], [[0, 3], [3, -3]], surface(1, 0.5), surface(2, 0.25))
        case.update(sampling={"kind": "constant", "step": 0.25}, schemes=["isoslab_per_crossing", "isoslab_per_length"])
        case["isoslab"] = {"size": 61, "width": 3, "slope": 1.5}
        schemes = self.json_of("eval", "-", stdin=case)["schemes"]
        through = (0.5 * 0.75) ** 2
        self.assertAlmostEqual(schemes["isoslab_per_crossing"]["opacity"], 1 - through, delta=1e-12)
        self.assertAlmostEqual(schemes["isoslab_per_crossing"]["opacity_error"], 0, delta=1e-12)
        self.assertAlmostEqual(schemes["isoslab_per_length"]["opacity"], 1 - through**0.5, delta=1e-12)
        self.assertAlmostEqual(schemes["isoslab_per_length"]["isoslab_width"], 0.15, delta=1e-15)
        cells = self.json_of("eval", "-", stdin={**case, "sampling": {"kind": "cells"}})["schemes"]
        self.assertIn("constant step", cells["isoslab_per_length"]["why"])
        self.assertAlmostEqual(cells["isoslab_per_crossing"]["opacity"], 1 - through, delta=1e-12)

    def test_refusals_of_isoslabs(self):
        case = polynomial([0, 1], [[0, 1]], surface(0.25), surface(0.75, 1))
        case.update(sampling={"kind": "cells"}, schemes=["isoslab_per_crossing"])
        self.assert_refused(self.run_program("eval", "-", stdin=case), "isoslab")
        case["isoslab"] = {"size": 64, "width": 2}
        self.assert_refused(self.run_program("eval", "-", stdin=case), "found opacity 1")
        wide = changed(changed(case, "/isoslab/width", 40), "/transfer_function/isosurfaces/1/opacity", 0.5)
        self.assert_refused(self.run_program("eval", "-", stdin=wide), "which touch")
        slope = changed(case, "/isoslab/slope", 1)
        self.assert_refused(self.run_program("eval", "-", stdin=slope), "/isoslab/slope: found it without")
        needless = changed(case, "/schemes", ["every_crossing"])
        self.assert_refused(self.run_program("eval", "-", stdin=needless), "/isoslab: found it without")

    def test_refusals_of_schemes(self):
        case = polynomial([0, 1], [[0, 1]], surface(0.5))
        case.update(sampling={"kind": "cells"}, schemes=["threshold"])
        self.assert_refused(self.run_program("eval", "-", stdin=case), "surface_tolerance")
        other = {**case, "schemes": ["every_crossing"], "surface_tolerance": 0.1}
        self.assert_refused(self.run_program("eval", "-", stdin=other), "/surface_tolerance: found it without")
        none = self.json_of("eval", "-", stdin={**RAY, "schemes": ["every_crossing"]})
        self.assertIn("no isosurfaces", none["schemes"]["every_crossing"]["why"])

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

    def test_lit_surfaces(self):
        # The surface of s = z at 1/2, whose normal, away from what is brighter, is -z.
        volume = {"size": [2, 2, 2], "values": [0] * 4 + [1] * 4}
        scene = {"volume": volume, "transfer_function": {"isosurfaces": [surface(0.5, 0.5, [1, 0.5, 0.25])]},
                 "camera": {"eye": [0.5, 0.5, 5], "target": [0.5, 0.5, 0.5], "up": [0, 1, 0], "height": 0.5, "size": [2, 2]},
                 "scheme": "reference"}
        for light, diffuse in (([0, 0, -1], 0.9), ([0, 0, 1], 0), ([0, 3, -4], 0.9 * 0.8)):
            for scheme in ("reference", "every_crossing", "peak_finding"):
                with self.subTest(light=light, scheme=scheme):
                    lit = changed(changed(scene, "/shading", {**LIGHT, "light": light}), "/scheme", scheme)
                    image, answer = self.image_of(lit if scheme == "reference" else changed(lit, "/step", 0.3))
                    expected = [0.5 * (0.1 + diffuse) * color for color in (1, 0.5, 0.25)] + [0.5]
                    numpy.testing.assert_allclose(image, numpy.broadcast_to(expected, (2, 2, 4)), atol=1e-7)
                    if scheme == "reference":
                        self.assertFalse(answer["certified"])
                        self.assertEqual(answer["not_converged"], 0)

    def test_schemes_come_near_the_truth(self):
        # NOISE's rays by ever more samples; the lit ones too.
        for shading in ({}, {"shading": LIGHT}):
            scene = {**NOISE, "transfer_function": {"isosurfaces": [surface(0.45), surface(0.6)]}, **shading}
            truth, _ = self.image_of(scene)
            errors = []
            for step in (0.5, 0.01):
                image, _ = self.image_of({**scene, "scheme": "every_crossing", "step": step})
                errors.append(numpy.abs(image - truth).mean())
            self.assertGreater(errors[0], 10 * errors[1])

    def test_isoslabs_come_near_lit_surfaces(self):
        # A ramp whose normals are all the same: every method of shading has the surface's own light.
        volume = {"size": [2, 2, 9], "values": [z / 8 for z in range(9) for _ in range(4)]}
        scene = {"volume": volume, "transfer_function": {"isosurfaces": [surface(0.4, 0.5, [1, 0.5, 0.25])]},
                 "camera": {"eye": [0.5, 0.5, 12], "target": [0.5, 0.5, 0.5], "up": [0, 1, 0], "height": 0.5, "size": [2, 2]},
                 "scheme": "isoslab_per_crossing", "step": 0.5, "isoslab": {"size": 129, "width": 4},
                 "shading": {**LIGHT, "light": [0, 3, -4]}}
        for method in ("mean_gradient", "linear_intensity", "quadratic_arc"):
            with self.subTest(method):
                image, _ = self.image_of(changed(scene, "/shading/method", method))
                expected = [0.5 * (0.1 + 0.9 * 0.8) * color for color in (1, 0.5, 0.25)] + [0.5]
                numpy.testing.assert_allclose(image, numpy.broadcast_to(expected, (2, 2, 4)), atol=1e-6)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=scene), "/shading: found the shading pointwise on isoslabs")

    def test_refusals_and_warnings(self):
        scene = {**NOISE, "transfer_function": {"isosurfaces": [surface(0.5)]}}
        step = changed(changed(scene, "/scheme", "order1"), "/step", 0.5)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=step), "/scheme: found order1 with isosurfaces")
        points = [{"s": 0, "extinction": 1, "color": WHITE}]
        lit = changed(changed(scene, "/shading", LIGHT), "/transfer_function/points", points)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=lit), "/shading: found light on matter")
        method = changed(scene, "/shading", {**LIGHT, "method": "quadratic_arc"})
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=method), "/shading: found the shading quadratic_arc")
        threshold = changed(scene, "/scheme", "threshold")
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=threshold), "surface_tolerance")
        early = changed(changed(scene, "/scheme", "every_crossing"), "/early_termination", 0.9)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=early), "/early_termination: found it")
        without = changed(changed(NOISE, "/scheme", "every_crossing"), "/step", 0.5)
        self.assert_refused(self.run_program("render", "-", "-o", "x.npy", stdin=without), "/scheme: found every_crossing without")
        missed = self.run_program("render", "-", "-o", "x.npy", stdin=changed(scene, "/transfer_function/isosurfaces/0/s", 2))
        self.assertIn(b"no isosurface is crossed", missed.stderr)


if __name__ == "__main__":
    unittest.main()
