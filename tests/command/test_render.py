"""`raytruth render`: images of small scenes, what it writes, and what it refuses."""

import json
import pathlib
import struct
import unittest
import zlib

import numpy

from support import SOURCE, ProgramTest, changed

# Two cells along x, a ray per pixel along z through the whole field of 2 voxels.
SCENE = {
    "volume": {"size": [3, 2, 2], "values": [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0]},
    "transfer_function": {
        "points": [
            {"s": 0, "extinction": 0, "color": [1, 0.5, 0.25]},
            {"s": 1, "extinction": 2, "color": [1, 0.5, 0.25]},
        ]
    },
    "camera": {"eye": [1, 0.5, -5], "target": [1, 0.5, 0.5], "up": [0, 1, 0], "height": 1, "size": [2, 1]},
    "scheme": "reference",
}
NOISE = changed(
    changed(SCENE, "/volume", {"kind": "random_field", "size": 12, "smoothing": 1}),
    "/camera",
    {"eye": [30, 20, -25], "target": [5.5, 5.5, 5.5], "up": [0, 1, 0], "fov_y": 25, "size": [24, 20]},
)


def png_pixels(data):
    """Width, height and bytes of an 8-bit RGB image without filters other than those of the standard."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, chunks = 8, b"", []
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        chunks.append(kind)
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert (depth, color) == (8, 2)
        if kind == b"IDAT":
            packed += body
        at += length + 12
    raw = zlib.decompress(packed)
    return width, height, raw, chunks


class Images(ProgramTest):
    def render(self, scene, name="image.npy", *options):
        answer = self.json_of("render", self.write("scene.json", scene), "-o", name, *options)
        return answer, (numpy.load(self.folder / name) if name.endswith(".npy") else (self.folder / name).read_bytes())

    def test_certified_pixels_have_the_closed_form(self):
        # Pixel centres at x = 1 -+ 1/2, where s = 1/2 all along z: opacity 1 - exp(-2/2 2), 2 being the way through.
        answer, image = self.render(SCENE)
        opacity = 1 - numpy.exp(-2.0)
        self.assertEqual(image.shape, (1, 2, 4))
        self.assertEqual(image.dtype, numpy.float32)
        for pixel in image[0]:
            numpy.testing.assert_allclose(pixel, [opacity, opacity / 2, opacity / 4, opacity], rtol=1e-7)
        radii = numpy.load(self.folder / "image.radius.npy")
        self.assertEqual(radii.shape, (1, 2))
        self.assertLess(radii.max(), 2**-24)
        self.assertEqual((answer["error_bound"], answer["not_converged"]), (radii.max(), 0))
        self.assertEqual(answer["transfer_function"]["color"], "linear light")
        self.assertLess(answer["radius_before_rounding"], 1e-13)

    def test_the_bound_is_that_of_the_numbers_in_the_file(self):
        opacity = 1 - numpy.exp(-2.0)
        truth = opacity * numpy.array([1, 0.5, 0.25, 1])
        answer, image = self.render(SCENE, "image.npy", "--binary64")
        self.assertEqual(image.dtype, numpy.float64)
        self.assertLess(answer["error_bound"], 1e-13)
        self.assertLess(abs(image - truth).max(), answer["error_bound"] + 1e-16)
        for name in ("image.npy", "image.pfm"):
            answer, _ = self.render(SCENE, name)
            stored = numpy.load(self.folder / name) if name.endswith("npy") else numpy.frombuffer(
                (self.folder / name).read_bytes()[12:], "<f4").reshape(1, 2, 3)
            error = abs(stored.astype(float) - truth[: stored.shape[2]]).max()
            self.assertGreater(error, 1e-9)
            self.assertLessEqual(error, answer["error_bound"])
            self.assertLessEqual(answer["error_bound"], 2**-24)
            self.assertIn("binary32", answer["bound_holds_for"])
        answer, _ = self.render(SCENE, "image.png")
        self.assertIn("not for the picture", answer["bound_holds_for"])
        self.assert_refused(self.run_program("render", "scene.json", "-o", "i.pfm", "--binary64"), "i.pfm", ".npy")

    def test_radii_cover_the_rounding_of_the_camera(self):
        """A camera far away, along no axis: rays are rounded by some 1e-13 of a voxel, and the scalar is steep."""
        scene = {**NOISE, "camera": {**NOISE["camera"], "eye": [3000.1, 2000.3, -2500.7], "fov_y": 0.25}}
        answer, image = self.render(scene, "image.npy", "--binary64")
        self.assertGreater(answer["error_bound"], 1e-14)
        self.assertLess(answer["error_bound"], 1e-9)
        self.assertIn("covered", answer["bound_of"])
        self.assertEqual(answer["not_converged"], 0)

    def test_pixels_that_did_not_converge_say_why(self):
        jump = {"points": [{"s": 0.5, "extinction": 0, "color": [1, 1, 1]}, {"s": 0.5, "extinction": 1e9, "color": [1, 1, 1]}]}
        scene = {**NOISE, "transfer_function": jump}
        scene["camera"] = {**NOISE["camera"], "eye": [30.1, 20.2, -25.3]}
        answer, _ = self.render(scene, "image.npy", "--binary64")
        radii = numpy.load(self.folder / "image.radius.npy")
        self.assertEqual(answer["not_converged"], (radii > answer["tolerance"]).sum())
        if answer["not_converged"]:
            self.assertIn(f"{answer['not_converged']} of {radii.size} pixels", answer["why_not_converged"])

    def test_a_camera_is_fitted(self):
        scene = changed(NOISE, "/camera", ...)
        for spacing in ([1, 1, 1], [0.5, 2, 7]):
            for size, camera in ((None, ...), ([40, 20], {"size": [40, 20]}), ([20, 60], {"size": [20, 60]})):
                volume = {"size": [4, 3, 2], "values": [1] * 24, "spacing": spacing}
                fitted = {**scene, "volume": volume} | ({} if camera is ... else {"camera": camera})
                answer, image = self.render(fitted)
                self.assertEqual(answer["size"], size or [512, 512])
                seen = image[..., 3] > 0
                self.assertFalse(seen[0].any() or seen[-1].any() or seen[:, 0].any() or seen[:, -1].any())
                self.assertGreater(seen.mean(), 0.02)
                # What it states is a scene's camera.
                _, again = self.render({**fitted, "camera": answer["fitted_camera"]})
                numpy.testing.assert_array_equal(image, again)
                self.assertNotIn("warnings", answer)
        answer = self.json_of("eval", self.write("scene.json", {**scene, "scheme": "order1", "camera": {"size": [8, 8]}}))
        self.assertEqual(answer["fitted_camera"]["size"], [8, 8])

    def test_what_is_not_seen_is_said(self):
        points = lambda a, b: {"points": [{"s": a, "extinction": 0, "color": [1, 1, 1]}, {"s": b, "extinction": 1, "color": [1, 1, 1]}]}
        for words, changes in (
            ("no ray of the camera meets the volume", {"camera": {**NOISE["camera"], "target": [500, 0, 0]}}),
            ("clear at every value", {"transfer_function": points(300, 1000)}),
            ("hardly meets", {"transfer_function": points(-1000, -10)}),
            ("hardly meets", {"transfer_function": points(-1000, 3000)}),
        ):
            answer, _ = self.render({**NOISE, **changes})
            self.assertEqual(len(answer["warnings"]), 1, answer["warnings"])
            self.assertIn(words, answer["warnings"][0])
        answer, _ = self.render(NOISE)
        self.assertNotIn("warnings", answer)

    def test_extinction_and_step_are_per_smallest_spacing(self):
        scene = changed(SCENE, "/volume/spacing", [3, 3, 5])
        scene["camera"] = {"eye": [3, 1.5, -50], "target": [3, 1.5, 0], "up": [0, 1, 0], "height": 3, "size": [2, 1]}
        for scheme, options in (("reference", {}), ("order1", {"step": 0.25}), ("order1", {"step": 0.25, "table": {"size": 65}})):
            _, image = self.render({**scene, "scheme": scheme, **options})
            numpy.testing.assert_allclose(image[0, :, 3], 1 - numpy.exp(-2 * 0.5 * 2 * 5 / 3), rtol=1e-6)

    def test_row_0_is_on_top(self):
        scene = changed(SCENE, "/volume", {"size": [2, 3, 2], "values": [0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1]})
        scene["camera"] = {"eye": [0.5, 1, -5], "target": [0.5, 1, 0], "up": [0, 1, 0], "height": 3, "size": [1, 3]}
        _, image = self.render(scene)
        self.assertGreater(image[0, 0, 3], 0.9)
        self.assertEqual(image[2, 0, 3], 0)

    def test_formats_hold_the_same_image(self):
        _, array = self.render(SCENE)
        _, pfm = self.render(SCENE, "image.pfm")
        self.assertTrue(pfm.startswith(b"PF\n2 1\n-1.0\n"))
        numpy.testing.assert_array_equal(numpy.frombuffer(pfm[12:], "<f4").reshape(1, 2, 3), array[..., :3])
        for option, chunk, encode in ((["--linear"], b"gAMA", lambda x: x), ([], b"sRGB", lambda x: 1.055 * x ** (1 / 2.4) - 0.055)):
            answer, png = self.render(SCENE, "image.png", *option)
            width, height, raw, chunks = png_pixels(png)
            self.assertEqual((width, height), (2, 1))
            self.assertIn(chunk, chunks)
            expected = numpy.floor(255 * encode(array[0, 0, :3].astype(float)) + 0.5)
            compared = self.json_of("compare", "image.png", "image.png")
            self.assertEqual(compared["maximum"], 0)
            self.assertEqual(list(raw[1:4]), list(expected))  # the first pixel of a row has no neighbour to filter by
            self.assertEqual(answer["encoding"], "linear" if option else "sRGB")

    def test_every_kind_of_scheme_comes_near_the_certified_image(self):
        _, truth = self.render(NOISE)
        self.assertGreater(truth[..., 3].max(), 0.5)
        for scheme, options, near in (
            ("cell_cubic", {}, 1e-6),
            ("cell_adaptive", {}, 1e-2),
            ("order1", {"step": 0.1}, 1e-3),
            ("order1", {"step": 0.1, "table": {"size": 256}}, 1e-3),
            ("order1", {"table": {"size": 256}}, 3e-3),
            ("order2", {"step": 0.1}, 1e-3),
            ("riemann_mid", {"step": 0.1}, 1e-3),
            ("simpson", {}, 1e-2),
            ("order1_iterations_64", {"step": 0.1}, 1e-3),
            ("order1_no_attenuation", {"step": 0.1}, 0.1),  # y / (1 - exp(-y)) at the optical depth y = 0.2 of a slab
            ("virtual_catmull_rom", {"step": 0.1}, 1e-3),
        ):
            with self.subTest(scheme=scheme, **options):
                _, image = self.render({**NOISE, "scheme": scheme, **options})
                self.assertLess(abs(image - truth).max(), near)

    def test_cell_cubic_keeps_voxels_that_binary32_does_not_hold(self):
        """Labels, seconds since 1970, narrow and wide ranges, numbers beyond binary32: as the reference to binary32."""
        random = numpy.random.default_rng(2).random(27)
        for low, width in ((2e7, 2), (1.7e9, 10), (1, 1e-5), (-1000, 1e-3), (0, 1), (0.1, 0.2), (0, 1e100), (2**52, 64), (1e-40, 1e-40)):
            values = low + width * numpy.round(random * 8) / 8
            camera = {"eye": [20, 13, -30], "target": [1, 1, 1], "up": [0, 1, 0], "height": 3, "size": [6, 6]}
            volume = {"size": [3, 3, 3], "values": values.tolist()}
            for points in (((low, 0), (low + width, 2)), ((low + width / 2, 0), (low + width / 2, 2))):
                transfer = {"points": [{"s": s, "extinction": e, "color": [1, 0.5, 0.25]} for s, e in points]}
                scene = {"volume": volume, "transfer_function": transfer, "camera": camera}
                with self.subTest(low=low, width=width, points=points):
                    _, truth = self.render({**scene, "scheme": "reference"})
                    radii = numpy.load(self.folder / "image.radius.npy")[..., None]
                    _, image = self.render({**scene, "scheme": "cell_cubic"})
                    self.assertGreater(truth[..., 3].max(), 0.1)
                    self.assertTrue((abs(image - truth) <= 1e-6 + radii).all(), abs(image - truth).max())

        huge = {**scene, "scheme": "cell_cubic", "volume": {**volume, "values": [0, 1e160] * 13 + [0]}}
        self.assert_refused(self.run_program("render", self.write("s.json", huge), "-o", "i.npy"), "1e+160", "2^500")

    def test_reconstructions_differ_and_schemes_follow_them(self):
        images = []
        for kind in ("trilinear", "bspline", "bspline_prefiltered", "catmull_rom"):
            _, truth = self.render({**NOISE, "reconstruction": kind})
            for options in ({}, {"table": {"size": 256}}):
                _, image = self.render({**NOISE, "reconstruction": kind, "scheme": "order1", "step": 0.1, **options})
                self.assertLess(abs(image - truth).max(), 2e-3)
            images.append(truth)
        for i, image in enumerate(images):
            for other in images[:i]:
                self.assertGreater(abs(image - other).max(), 1e-3)

    def test_shading_has_the_closed_form_on_a_plane(self):
        # s = x / 2: the gradient is along x everywhere between voxels 1 and 3, the extinction 1 + x, and
        # the light makes an angle with it whose cosine is 0.6: C = A (0.1 + 0.8 0.6) with the colour 1.
        values = [x / 2 for _ in range(4) for x in range(5)]
        transfer = {"points": [{"s": s, "extinction": e, "color": [1, 1, 1]} for s, e in ((0, 1), (2, 5))]}
        camera = {"eye": [2, 0.5, -9], "target": [2, 0.5, 0], "up": [0, 1, 0], "height": 1, "size": [1, 1]}
        shading = {"method": "quadratic_arc", "light": [-3, 4, 0], "ambient": 0.1, "diffuse": 0.8, "specular": 0, "shininess": 10}
        scene = {"volume": {"size": [5, 2, 2], "values": values}, "transfer_function": transfer, "camera": camera,
                 "scheme": "order1", "step": 0.5, "shading": shading}
        for change, cosine in (({}, 0.6), ({"normal": "gradient"}, 0), ({"normal": "gradient", "negative": "mirror"}, 0.6)):
            _, image = self.render({**scene, "shading": {**shading, **change}})
            opacity = 1 - numpy.exp(-2 * (1 + 2))
            numpy.testing.assert_allclose(image[0, 0], [opacity * (0.1 + 0.8 * cosine)] * 3 + [opacity], rtol=1e-6)
        # Specular: the half vector between (-0.6, 0.8, 0) and the viewer at -z has the cosine 0.6 / sqrt(2) with -x.
        _, image = self.render({**scene, "shading": {**shading, "diffuse": 0, "specular": 0.5, "shininess": 3}})
        numpy.testing.assert_allclose(image[0, 0, 0], opacity * (0.1 + 0.5 * (0.6 / 2**0.5) ** 3), rtol=1e-6)

        # A plane has one normal: all schemes, methods and tables agree on its light.
        for scheme, method, options in (
            ("reference", None, {}), ("cell_cubic", None, {}), ("cell_cubic", "mean_gradient", {"step": 1}),
            ("order2", "linear_gradient", {"step": 0.25}), ("order1", "pointwise", {"step": 2}),
            ("order1", "linear_intensity", {"step": 0.5, "table": {"size": 33, "format": "float64"}}),
            ("order1", "minimax_arc", {"table": {"size": 33, "format": "float64"}}),
            ("riemann_mid", None, {"step": 0.5}), ("reference", None, {"reconstruction": "catmull_rom"}),
        ):
            with self.subTest(scheme=scheme, method=method, **options):
                light = {key: value for key, value in shading.items() if key != "method"} | ({"method": method} if method else {})
                answer, image = self.render({**scene, **options, "scheme": scheme, "shading": light})
                numpy.testing.assert_allclose(image[0, 0], [opacity * (0.1 + 0.8 * 0.6)] * 3 + [opacity], rtol=1e-6)
                self.assertEqual("measured_radius" in answer, scheme == "reference")
                self.assertNotIn("error_bound", answer)
        # So do all gradients at samples, and all curves through them.
        light = {key: value for key, value in shading.items() if key != "method"}
        for scheme, change in (
            ("riemann_mid", {"gradient": "differences"}), ("riemann_mid", {"gradient": "analytic"}),
            *(("sampled_virtual_catmull_rom_3", {"virtual_normals": kind}) for kind in ("catmull_rom", "catmull_rom_unit", "linear")),
            ("order1", {"method": "quadratic_arc", "gradient": "analytic"}),
        ):
            for reconstruction in ("trilinear", "bspline"):
                with self.subTest(scheme=scheme, change=change, reconstruction=reconstruction):
                    options = {"scheme": scheme, "reconstruction": reconstruction, "shading": {**light, **change}}
                    _, image = self.render({**scene, **options})
                    numpy.testing.assert_allclose(image[0, 0], [opacity * (0.1 + 0.8 * 0.6)] * 3 + [opacity], rtol=1e-6)
        # Gooch's tones at the cosine 0.6: the colour is 1.
        gooch = {"light": [-3, 4, 0], "gooch": {"cool": [0, 0, 0.4], "warm": [0.4, 0.4, 0], "cool_share": 0.2, "warm_share": 0.6}}
        _, image = self.render({**scene, "scheme": "reference", "shading": gooch})
        tone = 0.8 * (0.2 + numpy.array([0, 0, 0.4])) + 0.2 * (0.6 + numpy.array([0.4, 0.4, 0]))
        numpy.testing.assert_allclose(image[0, 0, :3], opacity * tone, rtol=1e-6)

    def test_where_the_gradient_is_zero_only_ambient_light_counts(self):
        scene = changed(SCENE, "/volume/values", [0.5] * 12)
        shading = {"method": "quadratic_arc", "light": [0, 0, -1], "ambient": 0.25, "diffuse": 1, "specular": 1, "shininess": 10}
        _, image = self.render({**scene, "scheme": "order1", "step": 0.5, "shading": shading})
        numpy.testing.assert_allclose(image[0, 0, :3], 0.25 * (1 - numpy.exp(-2)) * numpy.array([1, 0.5, 0.25]), rtol=1e-6)

    def test_samples_lie_where_the_scene_says(self):
        for scheme in ("order1", "order2", "order0_mid", "trapezoid"):
            scene = {**NOISE, "scheme": scheme}
            _, cells = self.render({**scene, "sampling": "cells"})
            numpy.testing.assert_array_equal(cells, self.render(scene)[1])
            _, stepped = self.render({**scene, "sampling": "constant", "step": 0.7})
            numpy.testing.assert_array_equal(stepped, self.render({**scene, "step": 0.7})[1])
            self.assertGreater(abs(cells - stepped).max(), 1e-4)

    def test_the_same_bytes_on_any_number_of_threads(self):
        for scheme, options in (("reference", {}), ("cell_cubic", {}), ("order1", {"step": 1, "table": {"size": 64}})):
            scene = self.write("scene.json", {**NOISE, "scheme": scheme, **options})
            for threads in (1, 2):
                self.output_of("render", scene, "-o", f"{threads}.npy", "-j", threads)
            self.assertEqual((self.folder / "1.npy").read_bytes(), (self.folder / "2.npy").read_bytes())

    def test_eval_judges_a_scene(self):
        light = {"light": [1, 2, -3], "ambient": 0.1, "diffuse": 1, "specular": 0.5, "shininess": 10}
        for scheme, options in (("reference", {}), ("order1", {"step": 1, "table": {"size": 32}}),
                                ("order1", {"step": 1, "shading": {**light, "method": "linear_gradient"}})):
            scene = {**NOISE, "scheme": scheme, **options}
            answer = self.json_of("eval", self.write("scene.json", scene))
            self.assertEqual((answer["size"], answer["scheme"]), ([24, 20], scheme))
            self.assertEqual("measured_radius" in answer["reference"], "shading" in options)
            self.assertEqual("error_bound" in answer["reference"], "shading" not in options)
            self.assertEqual(answer["reference"]["certified"], "shading" not in options)
            self.assertEqual("error" in answer, scheme != "reference")
            if scheme == "reference":
                continue
            # The same as by hand, but for the binary32 of the files.
            truth = {**NOISE} | ({"shading": light} if "shading" in options else {})
            self.render(truth, "truth.npy")
            self.render(scene, "image.npy")
            by_hand = self.json_of("compare", "truth.npy", "image.npy")
            for name in ("rmse", "maximum", "danskin_hanrahan", "ssim"):
                self.assertAlmostEqual(answer["error"][name], by_hand[name], delta=1e-5 * max(1, abs(by_hand[name])))
        done = self.run_program("eval", self.write("scene.json", changed(NOISE, "/camera/size", [0, 1])))
        self.assert_refused(done, "scene.json", "/camera/size")

    def test_corrected_blocks_change_nothing(self):
        transfer = {"points": [{"s": s, "extinction": e, "color": [1, s, 0]} for s, e in ((0.55, 0), (0.7, 1), (1, 1))]}
        scene = {**NOISE, "transfer_function": transfer}
        for scheme, options in (("cell_cubic", {}), ("order1", {"step": 0.5}), ("order1", {"step": 0.5, "table": {"size": 128}}),
                                ("sampled_virtual_catmull_rom_3", {"step": 0.5}), ("trapezoid", {"step": 0.5}), ("order2", {})):
            with self.subTest(scheme=scheme, **options):
                _, whole = self.render({**scene, "scheme": scheme, **options})
                _, skipped = self.render({**scene, "scheme": scheme, **options, "empty_space": {"block": 2, "bounds": "corrected"}})
                self.assertLess(abs(whole - skipped).max(), 1e-6)

    def test_early_termination_ends_rays(self):
        opaque = changed(NOISE, "/transfer_function/points/1/extinction", 20)
        for scheme, options in (("cell_cubic", {}), ("order1", {"step": 0.5}), ("order1", {"step": 0.5, "table": {"size": 64}}),
                                ("riemann_left", {"step": 0.5})):
            with self.subTest(scheme=scheme, **options):
                _, whole = self.render({**opaque, "scheme": scheme, **options})
                _, ended = self.render({**opaque, "scheme": scheme, **options, "early_termination": 0.5})
                self.assertTrue((ended <= whole + 1e-6).all())
                self.assertGreater(abs(whole - ended).max(), 1e-3)
                self.assertGreaterEqual(ended[whole[..., 3] > 0.5][:, 3].min(), 0.5 - 1e-6)


class Refusals(ProgramTest):
    bad = [
        ("/volume", "nowhere", "nowhere"),
        ("/volume/size/0", 0, "whole number"),
        ("/volume/size/0", 5e9, "2^33"),
        ("/volume/values/0", "x", "number"),
        ("/volume/spacing", [1, 1, 0], "> 0"),
        ("/camera/size", [70000, 1], "65536"),
        ("/camera/size", [65536, 65536], "2^28"),
        ("/camera/fov_y", 30, "either"),
        ("/camera/up", [0, 0, 1], "up"),
        ("/camera/height", 0, "> 0"),
        ("/scheme", "order4", "perhaps order"),
        ("/step", -1, "> 0"),
        ("/sampling", "constant", "step"),
        ("/sampling", "adaptive", "cells"),
        ("/table", {"size": 64}, "order2"),
        ("/shading", {"method": "quadratic_arc"}, "light"),
        ("/shading", {"light": [0, 0, 0]}, "direction"),
        ("/shading", {"light": [0, 0, 1], "method": "arc"}, "pointwise"),
        ("/shading", {"light": [0, 0, 1], "ambient": 0, "diffuse": -1}, "diffuse"),
        ("/shading", {"light": [0, 0, 1], "gooch": {"cool": [0, 0, -1]}}, ">= 0"),
        ("/shading", {"light": [0, 0, 1], "gooch": {}, "ambient": 1}, "ambient"),
        ("/shading", {"light": [0, 0, 1], "gooch": {}, "method": "linear_gradient"}, "pointwise"),
        ("/early_termination", 2, "1"),
        ("/empty_space", {"bounds": "none"}, "corrected"),
        ("/reconstruction", "cubic", "catmull_rom"),
        ("/colour", 1, "colour"),
        ("/transfer_function/points/0/s", 2, "sorted"),
        ("/transfer_function", "no.json", "no.json"),
    ]

    def test_bad_scenes(self):
        for pointer, value, words in self.bad:
            with self.subTest(pointer=pointer, value=value):
                scene = self.write("scene.json", changed(SCENE, pointer, value))
                done = self.run_program("render", scene, "-o", "image.npy")
                self.assert_refused(done, "scene.json", words)
        self.assertEqual(self.names_in_folder(), ["scene.json"])

    def test_bad_tables(self):
        for scheme, table, words in (
            ("order2", {"size": 257}, "256"), ("order2", {"size": 64, "builder": "exact"}, "second_order_exact"),
            ("order1", {"size": 64, "builder": "second_order_exact"}, "exact"), ("order1", {"size": 1e9}, "16384"),
            ("order2", {"size": 64, "builder": "second_order_iterations"}, "iterations"),
            ("order2", {"size": 64, "iterations": 64}, "iterations"),
            ("order2", {"size": 64, "builder": "quadratic_gray", "radius": {"axis": "signed", "low": 8, "high": 1, "count": 7}}, "low < high"),
            ("order2", {"size": 64, "radius": {"axis": "signed", "low": 1, "high": 8, "count": 7}}, "radius"),
            ("quadratic_gray", {"size": 64, "builder": "second_order_exact"}, "quadratic_gray"),
            ("quadratic_gray", {"size": 1025}, "1024"),
        ):
            with self.subTest(scheme=scheme, table=table):
                done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": scheme, "table": table}), "-o", "i.npy")
                self.assert_refused(done, "s.json", "/table", words)

    def test_what_schemes_refuse(self):
        for scheme in ("virtual_catmull_rom", "sampled_virtual_catmull_rom_3"):  # they need equal steps
            done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": scheme}), "-o", "i.npy")
            self.assert_refused(done, "s.json", "/scheme", scheme)
            done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": scheme, "sampling": "cells"}), "-o", "i.npy")
            self.assert_refused(done, "s.json", "/scheme", scheme)
        done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": "order1", "sampling": "cells", "step": 1}), "-o", "i.npy")
        self.assert_refused(done, "s.json", "/step", "sampling cells")
        light = {"light": [0, 0, -1], "ambient": 0.25, "diffuse": 1, "specular": 1, "shininess": 10}
        for scheme, change, word in (("reference", {"gradient": "analytic"}, "voxels"), ("order1", {"gradient": "differences"}, "voxels"),
                                     ("riemann_mid", {"virtual_normals": "linear"}, "virtual"), ("order1", {"virtual_normals": "cubic"}, "catmull_rom")):
            done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": scheme, "step": 1, "shading": {**light, **change}}), "-o", "i.npy")
            self.assert_refused(done, "s.json", word)
        done = self.run_program("render", self.write("s.json", {**SCENE, "scheme": "cell_cubic", "reconstruction": "bspline"}), "-o", "i.npy")
        self.assert_refused(done, "trilinear")

    def test_bad_images(self):
        self.assert_refused(self.run_program("render", self.write("s.json", SCENE), "-o", "i.jpg"), ".png")
        self.assert_refused(self.run_program("render", "s.json", "-o", "no/i.npy"), "no/i.npy", code=4)
        self.assert_refused(self.run_program("render", "absent.json", "-o", "i.npy"), "absent.json")
        self.assert_refused(self.run_program("render", self.write("s.json", b"{"), "-o", "i.npy"), "s.json")


if __name__ == "__main__":
    unittest.main()
