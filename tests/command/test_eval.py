"""`raytruth eval`: what it answers, and what it refuses."""

import json
import math
import unittest

import exact_integral
from support import RAY, SLAB, VOLUME_RAY, ProgramTest, changed

EMISSIONS = ("associated", "plain")


def colored(ray, *points, emission="associated"):
    """The case under a transfer function of points (s, extinction, color)."""
    points = [dict(zip(("s", "extinction", "color"), point)) for point in points]
    return {**ray, "transfer_function": {"points": points}, "emission": emission}


def polynomial(breaks, *coefficients):
    """A case whose signal is this one."""
    signal = {"kind": "piecewise_polynomial", "breaks": breaks, "coefficients": coefficients}
    return {"signal": signal, "sampling": {"kind": "cells"}, "schemes": ["order1"]}


class Answers(ProgramTest):
    def test_ray_of_polynomials(self):
        answer = self.json_of("eval", "-", stdin=RAY)
        self.assertEqual(answer["length"], 2.5)
        self.assertEqual(list(answer["schemes"]), RAY["schemes"][1:])
        samples = {name: scheme["samples"] for name, scheme in answer["schemes"].items()}
        self.assertEqual(samples, {"order0_mid": 21, "order1": 11, "order2": 11, "virtual_catmull_rom": 11})
        # The first piece has the slope 1/2: off the midpoint of an interval by 1/8 the held value is wrong by 1/16.
        self.assertAlmostEqual(answer["schemes"]["order0_mid"]["xi_max"], 0.0625, places=14)
        for scheme in answer["schemes"].values():
            self.assertAlmostEqual(scheme["xi_per_length"], scheme["xi"] / 2.5, places=15)
            self.assertAlmostEqual(scheme["xi_max_per_length"], scheme["xi_max"] / 2.5, places=15)

    def test_cubic_against_closed_forms(self):
        # s = x^3 on [0, 1], one interval: order 1 errs by x - x^3, whose integral is 1/4, its maximum 2 / (3 sqrt 3).
        ray = {
            "signal": {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[0, 0, 0, 1]]},
            "sampling": {"kind": "constant", "step": 1},
            "schemes": ["order1"],
        }
        scheme = self.json_of("eval", "-", stdin=ray)["schemes"]["order1"]
        self.assertAlmostEqual(scheme["xi"], 0.25, places=15)
        self.assertAlmostEqual(scheme["xi_max"], 2 / (3 * math.sqrt(3)), places=15)

    def test_ray_through_an_inline_volume(self):
        # s = (t / L)^3, L = sqrt 3, with integral L/4; the samples 0, 1/8, 1 at t = 0, L/2, L, each held over L/2.
        schemes = self.json_of("eval", "-", stdin=VOLUME_RAY)["schemes"]
        self.assertAlmostEqual(schemes["order0_left"]["xi"], 3**0.5 * (1 / 4 - 1 / 16), places=15)
        self.assertAlmostEqual(schemes["order0_right"]["xi"], 3**0.5 * (1 / 16 + 1 / 2 - 1 / 4), places=15)

    def test_volume_file_relative_to_the_case(self):
        (self.folder / "inner").mkdir()
        self.write("inner/v.nrrd", b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n" + bytes(7) + b"\1")
        self.write("inner/case.json", changed(VOLUME_RAY, "/signal/volume", "v.nrrd"))
        from_file = self.json_of("eval", "inner/case.json")
        self.assertEqual(from_file, self.json_of("eval", "-", stdin=VOLUME_RAY))
        by_name = changed(VOLUME_RAY, "/signal/volume", "v")
        self.assertEqual(self.json_of("eval", "-", "--data", "inner", stdin=by_name), from_file)
        self.assertEqual(self.json_of("eval", "-", stdin=by_name, environment={"RAYTRUTH_DATA": "x:inner"}), from_file)

    def test_lost_first_byte_is_repaired_or_warned_of(self):
        self.write("v.nrrd", b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n" + bytes(6) + b"\1\n")
        case = changed(VOLUME_RAY, "/signal/volume", "v.nrrd")
        done = self.run_program("eval", "-", stdin=case)
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"first_byte", done.stderr)
        repaired = self.run_program("eval", "-", stdin=changed(case, "/signal/repair", "first_byte"))
        self.assertEqual(repaired.stderr, b"")
        self.assertEqual(json.loads(repaired.stdout), self.json_of("eval", "-", stdin=VOLUME_RAY))

    def test_empty_ray(self):
        for case in [changed(VOLUME_RAY, "/signal/length", 0), changed(VOLUME_RAY, "/signal/origin", [9, 0, 0])]:
            answer = self.json_of("eval", "-", stdin=case)
            self.assertEqual(answer["length"], 0)
            for scheme in answer["schemes"].values():
                self.assertEqual((scheme["xi"], scheme["xi_max"], scheme["samples"]), (0, 0, 0))
                self.assertIsNone(scheme["xi_per_length"])

    def test_array_of_cases_is_answered_by_an_array(self):
        one = self.json_of("eval", "-", stdin=RAY)
        self.assertEqual(self.json_of("eval", "-", stdin=[RAY]), [one])
        two = self.json_of("eval", "-", "-j", "2", stdin=[RAY, VOLUME_RAY, RAY])
        self.assertEqual([two[0], two[2]], [one, one])

    def test_scheme_that_cannot_answers_why(self):
        case = changed(RAY, "/sampling", {"kind": "cells"})
        answer = self.json_of("eval", "-", stdin=case)["schemes"]
        self.assertEqual(answer["virtual_catmull_rom"]["status"], "refused")
        self.assertIn("constant step", answer["virtual_catmull_rom"]["why"])
        self.assertIn("xi", answer["order1"])

    def test_errors_beyond_binary64_are_refused_not_infinite(self):
        jump = {"kind": "piecewise_polynomial", "breaks": [0, 1e-300, 2e-300], "coefficients": [[0], [1e200]]}
        case = changed(changed(RAY, "/signal", jump), "/sampling", {"kind": "constant", "step": 2e-300})
        text = self.output_of("eval", "-", stdin=case)
        self.assertEqual(json.loads(text)["schemes"]["order1"]["status"], "refused")
        for word in ("nan", "inf", "NaN", "Infinity"):
            self.assertNotIn(word, text)

    def test_transfer_functions(self):
        opacity = {"points": [{"s": 0, "opacity": 1, "color": [1, 1, 1]}], "unit_length": 2}
        done = self.run_program("eval", "-", stdin=changed(RAY, "/transfer_function", opacity))
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assertEqual(json.loads(done.stdout)["reference"]["opacity"], 1)
        self.write("tf.json", RAY["transfer_function"])
        self.output_of("eval", "-", stdin=changed(RAY, "/transfer_function", "tf.json"))


class Truth(ProgramTest):
    """Colours and opacities against closed forms, written here a second time."""

    def reference(self, case):
        return self.json_of("eval", "-", stdin=case)["reference"]

    def test_opacity_is_linear_between_points(self):
        # s = t; 1 - a = 1 - m t, whose mean logarithm is ((1 - m) ln(1 - m) + m) / -m; m = 1: a depth of 1.
        line = {"kind": "piecewise_polynomial", "breaks": [0, 1], "coefficients": [[0, 1]]}
        white = {"color": [1, 1, 1]}
        for most in (0.01, 0.5, 0.99, 1):
            points = [{"s": 0, "opacity": 0, **white}, {"s": 1, "opacity": most, **white}]
            case = {
                "signal": line,
                "transfer_function": {"points": points, "unit_length": 1},
                "emission": "associated",
                "sampling": {"kind": "cells"},
                "schemes": ["reference"],
            }
            rest = 1 - most
            depth = ((rest * math.log(rest) if rest else 0) + most) / most
            self.assert_encloses(self.reference(case), [1 - math.exp(-depth)] * 3, 1 - math.exp(-depth))

    def assert_encloses(self, reference, color, opacity, wide=1e-13):
        """Within the bound, and 1e-15 for the rounding of what is expected."""
        self.assertEqual(list(reference), ["color", "opacity", "error_bound"])
        self.assertLess(reference["error_bound"], wide)
        for found, exact in zip([*reference["color"], reference["opacity"]], [*color, opacity]):
            self.assertLessEqual(abs(found - exact), reference["error_bound"] + 1e-15)

    def test_constant_signal(self):
        # q (1 - e^(-tau L)) / tau, with tau = 2, L = 3/2.
        ray = polynomial([0, 0.5, 1.5], [0.25], [0.25])
        for emission, q in (("associated", 2), ("plain", 1)):
            case = colored(ray, (0, 1, [1, 0.5, 0]), (0.5, 3, [0, 0.5, 1]), emission=emission)
            light = -math.expm1(-3) / 2 * q
            self.assert_encloses(self.reference(case), [light / 2] * 3, -math.expm1(-3))

    def test_ramp_of_the_extinction_along_the_ray(self):
        # tau = 8 t on [0, 1]: T = exp(-4 t^2), and the plain colour 1 gathers sqrt(pi) erf(2) / 4.
        case = colored(polynomial([0, 1], [0, 1]), (0, 0, [1, 1, 1]), (1, 8, [1, 1, 1]))
        opacity = -math.expm1(-4)
        self.assert_encloses(self.reference(case), [opacity] * 3, opacity)
        light = math.sqrt(math.pi) * math.erf(2) / 4
        self.assert_encloses(self.reference({**case, "emission": "plain"}), [light] * 3, opacity)
        # And where the colour rises too, c = t: integral t exp(-4 t^2) dt = (1 - e^-4) / 8.
        rising = colored(polynomial([0, 1], [0, 1]), (0, 0, [0, 0, 0]), (1, 8, [1, 1, 1]), emission="plain")
        self.assert_encloses(self.reference(rising), [opacity / 8] * 3, opacity)

    def test_step_of_the_transfer_function(self):
        # The signal is above 1/2 from t = 1/2 on.
        case = colored(polynomial([0, 1], [0, 1]), (0.5, 0, [1, 1, 1]), (0.5, 2, [0.5, 0.25, 0]))
        opacity = -math.expm1(-1)
        self.assert_encloses(self.reference(case), [opacity / 2, opacity / 4, 0], opacity)

    def test_faint_ray_keeps_its_digits(self):
        case = colored(polynomial([0, 1], [0.5]), (0, 1e-9, [1, 1, 1]))
        reference = self.reference(case)
        self.assertLess(reference["error_bound"], 1e-19)
        self.assertLessEqual(abs(reference["opacity"] - -math.expm1(-1e-9)), reference["error_bound"] + 1e-24)

    def test_ray_of_the_interface(self):
        for emission in EMISSIONS:
            case = {**RAY, "emission": emission}
            color, opacity = exact_integral.integrate({key: case[key] for key in ("signal", "transfer_function", "emission")})
            answer = self.json_of("eval", "-", stdin=case)
            self.assert_encloses(answer["reference"], map(float, color), float(opacity))
            for scheme in answer["schemes"].values():
                for channel, error, exact in zip(scheme["color"], scheme["color_error"], color):
                    self.assertLessEqual(abs(channel - error - float(exact)), scheme["error_bound"] + 1e-15)
                self.assertLessEqual(abs(scheme["opacity"] - scheme["opacity_error"] - float(opacity)), scheme["error_bound"] + 1e-15)

    def test_opacity_of_a_trilinear_ray(self):
        # s = (t / L)^3 from corner to corner: the depth under tau = 4 s is L.
        case = colored(VOLUME_RAY, (0, 0, [1, 1, 1]), (1, 4, [1, 1, 1]))
        opacity = -math.expm1(-(3**0.5))
        self.assert_encloses(self.reference(case), [opacity] * 3, opacity)

    def test_opacity_of_a_tricubic_ray(self):
        # A ramp along x is reproduced: Catmull-Rom passes through it, the B-spline keeps linear data.
        volume = {"size": [8, 1, 1], "values": [i / 8 for i in range(8)]}
        ray = {"kind": "tricubic", "volume": volume, "origin": [2, 0, 0], "direction": [2, 0, 0], "length": 2}
        for kernel in ("catmull_rom", "bspline"):
            case = colored({**VOLUME_RAY, "signal": {**ray, "kernel": kernel}}, (0, 0, [1, 1, 1]), (1, 4, [1, 1, 1]))
            opacity = -math.expm1(-4 * 2 * 3 / 8)
            self.assert_encloses(self.reference(case), [opacity] * 3, opacity)

    def test_signals_that_are_no_polynomials(self):
        # On the axis of Marschner and Lobb's signal rho = (1 - sin(pi z / 2) + (1 + cos(12 pi)) / 4) / 2.5.
        ray = {"kind": "marschner_lobb", "origin": [0, 0, -1], "direction": [0, 0, 3]}
        case = colored({**VOLUME_RAY, "signal": ray, "schemes": ["order1"]}, (0, 0, [1, 1, 1]), (1, 4, [1, 1, 1]))
        opacity = -math.expm1(-4 * 2 * 1.5 / 2.5)
        self.assert_encloses(self.reference(case), [opacity] * 3, opacity)
        for name in ("sine_slow", "gaussian_narrow", "step_between_samples"):
            case = colored({**VOLUME_RAY, "signal": {"kind": "analytic", "name": name}, "schemes": ["order1"]}, (0, 0.5, [1, 1, 1]))
            answer = self.json_of("eval", "-", stdin=case)
            opacity = -math.expm1(-answer["length"] / 2)
            self.assert_encloses(answer["reference"], [opacity] * 3, opacity)

    def test_empty_ray(self):
        case = colored(changed(VOLUME_RAY, "/signal/length", 0), (0, 1, [1, 1, 1]))
        answer = self.json_of("eval", "-", stdin=case)
        self.assertEqual(answer["reference"], {"color": [0, 0, 0], "opacity": 0, "error_bound": 0})
        for scheme in answer["schemes"].values():
            self.assertEqual((scheme["color"], scheme["opacity"], scheme["opacity_error"]), ([0, 0, 0], 0, 0))

    def test_without_a_transfer_function(self):
        answer = self.json_of("eval", "-", stdin=changed(VOLUME_RAY, "/schemes", ["order1", "riemann_left"]))
        self.assertEqual(answer["reference"]["status"], "refused")
        self.assertIn("transfer function", answer["reference"]["why"])
        self.assertIn("xi", answer["schemes"]["order1"])
        self.assertNotIn("color", answer["schemes"]["order1"])
        self.assertEqual(answer["schemes"]["riemann_left"], answer["reference"])

    def test_contacts_with_a_jump_are_decided(self):
        # The signal touches a jump from below, with a contact of order 8: its numbers say how much of the ray is above.
        powers = [math.comb(8, k) * 2**k * (-1) ** (8 - k) for k in range(9)]
        signal = polynomial([0, 1], [0.5 - powers[0] / 3, *(-power / 3 for power in powers[1:])])
        case = colored(signal, (0.5, 0, [0, 0, 0]), (0.5, 10, [1, 1, 1]))
        reference = self.reference(case)
        self.assertNotIn("status", reference)
        color, opacity = exact_integral.integrate({key: case[key] for key in ("signal", "transfer_function", "emission")})
        self.assertLessEqual(abs(reference["opacity"] - float(opacity)), reference["error_bound"])

    def test_wide_bounds_say_so_and_hold(self):
        # s = (2 t - 1)^8 meets opacity 1 in the middle: the mean depth is the integral of -ln (1 - a) = -8 ln |2 t - 1|, 8.
        powers = [math.comb(8, k) * 2**k * (-1) ** (8 - k) for k in range(9)]
        points = [{"s": 0, "opacity": 1, "color": [1, 1, 1]}, {"s": 1, "opacity": 0, "color": [1, 1, 1]}]
        case = {
            **polynomial([0, 1], powers),
            "transfer_function": {"points": points, "unit_length": 1},
        }
        reference = self.reference(case)
        self.assertEqual(reference["status"], "not_converged")
        self.assertIn("error_bound", reference["why"])
        self.assertIn("opacity of 1", reference["why"])
        self.assertLessEqual(abs(reference["opacity"] - (1 - math.exp(-8))), reference["error_bound"])

    def test_reference_is_there_unasked(self):
        self.assertEqual(self.reference(RAY), self.reference(changed(RAY, "/schemes", ["order1"])))
        only = self.json_of("eval", "-", stdin=changed(RAY, "/schemes", ["reference"]))
        self.assertEqual((only["reference"], only["schemes"]), (self.reference(RAY), {}))


class Budget(ProgramTest):
    def test_parts_add_up(self):
        schemes = ["order1", "riemann_left", "order1_no_attenuation", "order1_iterations_64", "simpson"]
        for name, scheme in self.json_of("eval", "-", stdin=changed(RAY, "/schemes", schemes))["schemes"].items():
            with self.subTest(scheme=name):
                parts = scheme["budget"]
                for channel in range(3):
                    sums = sum(part["color"][channel] for cause, part in parts.items() if cause != "round32")
                    self.assertAlmostEqual(sums, scheme["color_error"][channel], places=14)
                sums = sum(part["opacity"] for cause, part in parts.items() if cause != "round32")
                self.assertAlmostEqual(sums, scheme["opacity_error"], places=14)
                self.assertEqual("round32" in parts, name in ("riemann_left", "simpson"))

    def test_left_riemann_by_hand(self):
        # Two homogeneous halves, with the extinctions 0 and 4 s = 2 of their front samples.
        case = colored(polynomial([0, 1], [0, 1]), (0, 0, [1, 1, 1]), (1, 4, [1, 1, 1]))
        case = {**case, "sampling": {"kind": "constant", "step": 0.5}, "schemes": ["riemann_left", "order1"]}
        schemes = self.json_of("eval", "-", stdin=case)["schemes"]
        self.assertAlmostEqual(schemes["riemann_left"]["opacity"], -math.expm1(-1), places=15)
        self.assertAlmostEqual(schemes["riemann_left"]["opacity_error"], math.expm1(-2) - math.expm1(-1), places=15)
        self.assertNotIn("xi", schemes["riemann_left"])
        self.assertAlmostEqual(schemes["order1"]["opacity_error"], 0, places=15)


class Slabs(ProgramTest):
    """Shaded slabs against closed forms."""

    TERMS = ("ambient", "diffuse", "specular")

    def test_slab_of_the_interface(self):
        answer = self.json_of("eval", "-", stdin=SLAB)
        reference = answer["reference"]
        self.assertEqual(list(reference), [*self.TERMS, "opacity", "error_bound"])
        self.assertLess(reference["error_bound"], 1e-14)
        self.assertEqual(list(answer["schemes"]), SLAB["schemes"][1:])
        self.assertAlmostEqual(reference["opacity"], -math.expm1(-8 * 0.45), places=14)
        for scheme in answer["schemes"].values():
            self.assertEqual(list(scheme), [*self.TERMS, "opacity", *(f"{term}_error" for term in (*self.TERMS, "opacity"))])
            for term in self.TERMS:
                for found, error, truth in zip(scheme[term], scheme[f"{term}_error"], reference[term]):
                    self.assertAlmostEqual(found - error, truth, places=15)
            # What lights no normal is the same for all.
            self.assertAlmostEqual(max(map(abs, scheme["ambient_error"])), 0, places=14)
        # The chord is shorter than the circle, the arc longer.
        errors = [answer["schemes"][name]["diffuse_error"][0] for name in ("linear_gradient", "quadratic_arc")]
        self.assertLess(errors[0], -1e-3)
        self.assertGreater(errors[1], 1e-4)

    def test_homogeneous_slab_between_normals_at_right_angles(self):
        # N.L = (1 - x) / sqrt((1-x)^2 + x^2), whose integral is asinh(1) / sqrt 2; its chord's is 1/2, the mean's
        # 1 / sqrt 2. Nothing absorbs.
        points = [{"s": 0, "extinction": 0, "color": [1, 0.5, 0.25]}]
        case = {**SLAB, "transfer_function": {"points": points}, "lighting": {**SLAB["lighting"], "light": [0, 0, 1]}}
        answer = self.json_of("eval", "-", stdin=case)
        for term, light in (("ambient", 0.1), ("diffuse", math.asinh(1) / math.sqrt(2))):
            for found, color in zip(answer["reference"][term], points[0]["color"]):
                self.assertLessEqual(abs(found - color * light), answer["reference"]["error_bound"] + 2e-16)
        self.assertEqual(len(set(answer["reference"]["specular"])), 1)  # white
        self.assertAlmostEqual(answer["schemes"]["linear_gradient"]["diffuse"][1], 0.25, places=15)
        self.assertAlmostEqual(answer["schemes"]["mean_gradient"]["diffuse"][2], 0.25 / math.sqrt(2), places=15)

    def test_every_shading_and_highlight_answers(self):
        names = [entry["name"] for entry in self.json_of("list", "shadings", "--json")]
        for highlight in ("lobe", "cone"):
            for emission in EMISSIONS:
                case = {**SLAB, "emission": emission, "lighting": {**SLAB["lighting"], "highlight": highlight}, "schemes": names}
                answer = self.json_of("eval", "-", stdin=case)
                self.assertEqual(list(answer["schemes"]), names)
                refused = {name for name, scheme in answer["schemes"].items() if "status" in scheme}
                # The fades are made for cones, the gradient of the extinction for lobes.
                fades = {name for name in names if "fades" in name}
                self.assertEqual(refused, fades if highlight == "lobe" else {"opacity_gradient", "opacity_gradient_linear"})
                errors = answer["schemes"]["normalized_linear"]
                for term in self.TERMS:
                    self.assertLess(max(map(abs, errors[f"{term}_error"])), 1e-13)

    def test_powers_of_falling_opacity_are_not_numbers(self):
        falling = changed(SLAB, "/transfer_function/points/0/extinction", 9)
        case = changed(changed(falling, "/lighting/shininess", 10.5), "/schemes", ["opacity_gradient"])
        scheme = self.json_of("eval", "-", stdin=case)["schemes"]["opacity_gradient"]
        self.assertEqual(scheme["status"], "refused")
        self.assertIn("not a number", scheme["why"])
        whole = self.json_of("eval", "-", stdin=changed(case, "/lighting/shininess", 3))["schemes"]["opacity_gradient"]
        self.assertLess(max(whole["diffuse"]), 0)

    def test_no_length_no_light(self):
        answer = self.json_of("eval", "-", stdin=changed(SLAB, "/slab/length", 0))
        self.assertEqual(answer["reference"]["error_bound"], 0)
        self.assertEqual(answer["schemes"]["mean_gradient"]["diffuse"], [0, 0, 0])

    def test_rays_and_slabs_in_one_list(self):
        both = self.json_of("eval", "-", stdin=[RAY, SLAB])
        self.assertEqual(both, [self.json_of("eval", "-", stdin=case) for case in (RAY, SLAB)])


class Refusals(ProgramTest):
    """(document, JSON pointer named, words of the message)"""

    points = "/transfer_function/points"
    point = {"s": 2, "extinction": 0, "color": [0, 0, 0]}
    bad = [
        (changed(RAY, "/schemes/1", "order4"), "/schemes/1", "order2"),
        (changed(RAY, "/schemes/1", "order0mid"), "/schemes/1", "(perhaps order0_mid)"),
        (changed(RAY, "/schemes/1", "reference"), "/schemes/1", "each scheme once"),
        (changed(RAY, "/schemes", []), "/schemes", "list"),
        (changed(RAY, "/schemes", ...), "/schemes", "found nothing"),
        (changed(RAY, "/schemes/0", 3), "/schemes/0", "found 3"),
        (changed(RAY, "/scheme", []), "/scheme", "unknown key"),
        (changed(RAY, "/new\nline", 1), "/new\\nline", "unknown key"),
        (changed(RAY, "/a~1b~0c", 1), "/a~1b~0c", "unknown key"),
        (changed(RAY, "/sampling/step", 0), "/sampling/step", "a number > 0"),
        (changed(RAY, "/sampling/step", -1), "/sampling/step", "found -1"),
        (changed(RAY, "/sampling/step", "x" * 500), "/sampling/step", "..."),
        (changed(RAY, "/sampling/step", 1e-9), "/sampling", "10000000 samples"),
        (changed(RAY, "/sampling/step", None), "/sampling/step", "found null"),
        (changed(RAY, "/sampling/kind", "cells"), "/sampling/step", "unknown key"),
        (changed(RAY, "/sampling", []), "/sampling", "an object"),
        (changed(RAY, "/signal/kind", "trilinaer"), "/signal/kind", "perhaps trilinear"),
        (changed(RAY, "/signal/breaks/0", 0.5), "/signal/breaks/0", "found 0.5"),
        (changed(RAY, "/signal/breaks/1", 0), "/signal/breaks/1", "a number > 0"),
        (changed(RAY, "/signal/breaks", [0]), "/signal/breaks", "at least 2"),
        (changed(RAY, "/signal/breaks/2", []), "/signal/breaks/2", "a number"),
        (changed(RAY, "/signal/coefficients/0", []), "/signal/coefficients/0", "found a list of 0 items"),
        (changed(RAY, "/signal/coefficients/1", [1] * 11), "/signal/coefficients/1", "1 to 10"),
        (changed(RAY, "/signal/coefficients/2", [1]), "/signal/coefficients", "3 lists"),
        (changed(RAY, "/signal/coefficients/1/3", 1.7e308), "/signal/coefficients", "overflow"),
        (changed(RAY, "/signal/coefficients/1/0", 1e300), "/signal", "2^900"),
        (changed(RAY, "/emission", "glow"), "/emission", "associated"),
        (changed(RAY, points, []), points, "at least 1"),
        (changed(RAY, points + "/0/s", 5), points + "/1", "sorted"),
        (changed(changed(RAY, points + "/0/s", 1), points + "/2", {**point, "s": 1}), points + "/2", "third"),
        (changed(RAY, points + "/1/extinction", -1), points + "/1/extinction", ">= 0"),
        (changed(RAY, points + "/1/color", [1, 1]), points + "/1/color", "3"),
        (changed(RAY, points + "/1/color/1", -1), points + "/1", "color"),
        (changed(RAY, points + "/0", {"s": 0, "opacity": 0, "color": [0, 0, 0]}), points + "/0/opacity", "unknown"),
        (changed(RAY, "/transfer_function/unit_length", 1), points + "/0/extinction", "unknown"),
        (changed(RAY, "/transfer_function", "no.json"), "/transfer_function", "no.json"),
        (changed(RAY, points + "/1/extinction", 1e300), "/transfer_function", "2^500"),
        (changed(RAY, points + "/1/color/1", 1e300), "/transfer_function", "2^500"),
        (changed(RAY, points + "/1/s", 1e300), "/transfer_function", "2^500"),
        (changed(VOLUME_RAY, "/signal/length", -1), "/signal/length", "found -1"),
        (changed(VOLUME_RAY, "/signal/origin", [1, 2]), "/signal/origin", "3 numbers"),
        (changed(VOLUME_RAY, "/signal/origin/1", "a"), "/signal/origin/1", "a number"),
        (changed(VOLUME_RAY, "/signal/origin/1", 1e30), "/signal/origin", "2^40"),
        (changed(VOLUME_RAY, "/signal/direction", [0, 0, 0]), "/signal/direction", "direction"),
        (changed(VOLUME_RAY, "/signal/volume/size/0", 3), "/signal/volume/values", "12 numbers"),
        (changed(VOLUME_RAY, "/signal/volume/size/0", 0), "/signal/volume/size/0", "found 0"),
        (changed(VOLUME_RAY, "/signal/volume/size/0", 1.5), "/signal/volume/size/0", "found 1.5"),
        (changed(VOLUME_RAY, "/signal/volume/size", [2**33, 2, 2]), "/signal/volume/size", "2^33"),
        (changed(VOLUME_RAY, "/signal/volume/size/0", 10**30), "/signal/volume/size/0", "found 1e+30"),
        (changed(VOLUME_RAY, "/signal/volume/size", [2, 2]), "/signal/volume/size", "3 sizes"),
        (changed(VOLUME_RAY, "/signal/volume/values/3", None), "/signal/volume/values/3", "found null"),
        (changed(VOLUME_RAY, "/signal/volume", "nowhere"), "/signal/volume", "nowhere"),
        (changed(VOLUME_RAY, "/signal/volume", "./nowhere.nrrd"), "/signal/volume", "nowhere.nrrd"),
        (changed(VOLUME_RAY, "/signal/repair", "first_byte"), "/signal/repair", "file"),
        (changed(SLAB, "/slab/back_normal", [0, 0, -1]), "/slab/back_normal", "antiparallel"),
        (changed(SLAB, "/slab/front_normal", [0, 0, 1.00001]), "/slab/front_normal", "1e-6"),
        (changed(SLAB, "/slab/front_normal", [0, 0]), "/slab/front_normal", "3 numbers"),
        (changed(SLAB, "/slab/length", -1), "/slab/length", "found -1"),
        (changed(SLAB, "/slab/depth", 1), "/slab/depth", "unknown key"),
        (changed(SLAB, "/lighting/light", [0, 0, 0]), "/lighting/light", "length 0"),
        (changed(SLAB, "/lighting/half/0", "x"), "/lighting/half/0", "a number"),
        (changed(SLAB, "/lighting/diffuse", -1), "/lighting/diffuse", "found -1"),
        (changed(SLAB, "/lighting/shininess", 0.5), "/lighting/shininess", "found 0.5"),
        (changed(SLAB, "/lighting/highlight", "phong"), "/lighting/highlight", "lobe"),
        (changed(SLAB, "/lighting/negative", "fade"), "/lighting/negative", "mirror"),
        (changed(SLAB, "/lighting", {**SLAB["lighting"], "negative": "none", "shininess": 2.5}), "/lighting/shininess", "whole"),
        (changed(SLAB, "/lighting/half", ...), "/lighting/half", "found nothing"),
        (changed(SLAB, "/schemes/1", "order1"), "/schemes/1", "quadratic_arc"),
        (changed(SLAB, "/transfer_function", ...), "/transfer_function", "found nothing"),
        (changed(SLAB, "/sampling", {"kind": "cells"}), "/sampling", "unknown key"),
        ([RAY, changed(RAY, "/sampling/step", 0)], "/1/sampling/step", "found 0"),
        ([], "/", "list"),
        (5, "/", "an object"),
    ]

    def test_place_and_reason_in_one_line(self):
        for document, pointer, words in self.bad:
            with self.subTest(pointer=pointer, words=words):
                file = self.write("case.json", document)
                self.assert_refused(self.run_program("eval", file), f"case.json: {pointer}: ", words)

    def test_text_that_is_no_json(self):
        ray = json.dumps(RAY)
        for text, words in [
            ("", "line 1, column 1"),
            ("{", "line 1, column 2"),
            ('{\n  "a": nan}', "line 2, column 9"),
            ('{"a": Infinity}', "line 1"),
            ('{"a": 1e999}', "1e999"),
            ('{"a": 01}', "line 1"),
            ("{'a': 1}", "line 1"),
            ('{"a": 1,}', "line 1"),
            (ray + "x", "line 1"),
            ("// comment\n" + ray, "line 1"),
            (b'"\xff\xfe"', "UTF-8"),
            (b"\xef\xbb\xbf" + ray.encode(), "byte order mark"),
            (b"\x00\x01\x02", "line 1"),
            ('{"a": 1, "a": 2}', 'the key "a" twice'),
            ('{"signal": {"b": [{"a": 1, "a": 2}]}}', "/signal/b/0: "),
            ("[" * 65 + "]" * 65, "deeper than 64"),
            ("[" * 100000, "deeper than 64"),
            ("{" + ",".join(f'"k{i}":0' for i in range(2000)) + "}", "1000 members"),
            ('"' + "long" * 100000, "line 1"),
        ]:
            with self.subTest(text=text[:40]):
                file = self.write("case.json", text)
                done = self.run_program("eval", file)
                self.assert_refused(done, "case.json: ", words)
                self.assertLess(len(done.stderr), 400)

    def test_files_that_cannot_be_read(self):
        self.assert_refused(self.run_program("eval", "absent.json"), "absent.json: ", "No such file")
        self.assert_refused(self.run_program("eval", "."), "a folder")
        self.assert_refused(self.run_program("eval", "a\nb"), "a\\nb")
        self.assert_refused(self.run_program("eval", "-", stdin=b""), "standard input")

    def test_integers_written_as_floats_count(self):
        case = json.dumps(VOLUME_RAY).replace("[2, 2, 2]", "[2.0, 2e0, 2]")
        self.output_of("eval", self.write("case.json", case))

    def test_damaged_volume(self):
        header = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n"
        case = self.write("case.json", changed(VOLUME_RAY, "/signal/volume", "v.nrrd"))
        self.write("v.nrrd", header + bytes(7))
        self.assert_refused(self.run_program("eval", case), "case.json: /signal/volume: ", "v.nrrd")
        self.write("v.nrrd", header.replace(b"2 2 2", b"1048576 1048576 1") + bytes(8))
        self.assert_refused(self.run_program("eval", case), "case.json: /signal/volume: ", "v.nrrd")
        self.write("v.nrrd", header + bytes(8))
        repair = self.write("repair.json", changed(changed(VOLUME_RAY, "/signal/volume", "v.nrrd"), "/signal/repair", "first_byte"))
        self.assert_refused(self.run_program("eval", repair), "repair.json: /signal/repair: ", "0x0A")


if __name__ == "__main__":
    unittest.main()
