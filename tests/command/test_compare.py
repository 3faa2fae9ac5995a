"""`raytruth compare`: metrics of images against numbers made by hand and by scikit-image."""

import struct
import unittest
import zlib

import numpy

from support import ProgramTest

try:
    from skimage.metrics import structural_similarity
except ImportError:
    structural_similarity = None


def pfm(array):
    height, width, _ = array.shape
    return b"PF\n%d %d\n-1.0\n" % (width, height) + array[::-1].astype("<f4").tobytes()


def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png(array, depth=8, extra=b""):
    """An image of the array's whole numbers, without filters; `extra` chunks stand behind the header."""
    height, width, channels = array.shape
    rows = b"".join(b"\0" + row.astype(">u2" if depth == 16 else "u1").tobytes() for row in array)
    color = {1: 0, 3: 2, 4: 6}[channels]

    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Metrics(ProgramTest):
    def compare(self, reference, image, *options):
        self.write("a.pfm", pfm(numpy.asarray(reference, float)))
        self.write("b.pfm", pfm(numpy.asarray(image, float)))
        return self.json_of("compare", "a.pfm", "b.pfm", *options)

    def test_by_hand(self):
        found = self.compare([[[0.5, 0.25, 0], [0.25, 0, 1]]], [[[0.5, 0.5, 0], [-0.25, 0.125, 2]]])
        stored = ((1 / 16 + 1 / 4 + 1 / 64 + 1) / 6) ** 0.5
        shown = ((1 / 16 + 1 / 16 + 1 / 64) / 6) ** 0.5
        for error, rmse, sum_of_magnitudes, maximum, pixel, bias in (
            (found, stored, 1.875, 1, [1, 0], 0.875 / 6),
            (found["clamped"], shown, 0.625, 0.25, [0, 0], 0.125 / 6),
        ):
            self.assertAlmostEqual(error["danskin_hanrahan"], 100 * sum_of_magnitudes / 2)
            self.assertAlmostEqual(error["rmse"], rmse)
            self.assertAlmostEqual(error["psnr"], -20 * numpy.log10(rmse))
            self.assertEqual(error["psnr_peak"], 1)
            self.assertEqual((error["maximum"], error["maximum_pixel"]), (maximum, pixel))
            self.assertAlmostEqual(error["bias"], bias)
            self.assertIsNone(error["ssim"])  # smaller than a window
        self.assertEqual(found["clamped"]["clamped_values"], {"reference": 0, "image": 2})
        self.assertEqual(found["compared"], "values as stored: linear light over black")
        self.assertIsNone(found["opacity"])  # of .pfm
        self.assertEqual(found["range"], {"reference": [0, 1], "image": [-0.25, 2]})

    def test_equal_and_black(self):
        image = numpy.full((12, 12, 3), 0.5)
        found = self.compare(image, image)
        self.assertEqual((found["danskin_hanrahan"], found["rmse"], found["psnr"]), (0, 0, None))
        self.assertAlmostEqual(found["ssim"], 1)
        self.assertIsNone(self.compare(0 * image, image)["danskin_hanrahan"])

    def test_ssim_of_constant_images(self):
        a, b = 0.25, 0.75  # no variance: (2 a b + C) / (a^2 + b^2 + C), C = 10^-4
        found = self.compare(numpy.full((11, 13, 3), a), numpy.full((11, 13, 3), b))
        self.assertAlmostEqual(found["ssim"], (2 * a * b + 1e-4) / (a * a + b * b + 1e-4))

    @unittest.skipUnless(structural_similarity, "needs scikit-image (Debian: python3-skimage)")
    def test_ssim_is_that_of_scikit_image(self):
        random = numpy.random.default_rng(1)
        for noise in (0.01, 0.2, 1.5):
            a = random.random((31, 40, 3)).astype("f4")
            b = numpy.clip(a + noise * (random.random((31, 40, 3)) - 0.5), -1, 2).astype("f4")
            for peak, image, options in ((1, b, []), (1, numpy.clip(b, 0, 1), None), (255, b, ["--peak", 255])):
                expected = structural_similarity(
                    a.astype(float), image.astype(float), data_range=peak, channel_axis=2,
                    gaussian_weights=True, sigma=1.5, use_sample_covariance=False)
                found = self.compare(a, b, *(options or []))
                self.assertAlmostEqual((found["clamped"] if options is None else found)["ssim"], expected, places=12)

    def test_difference_image(self):
        found = self.compare([[[0.5, 0.25, 0]]], [[[0.25, 0.5, 0.1]]], "--difference", "d.npy", "--gain", 2)
        numpy.testing.assert_allclose(numpy.load(self.folder / "d.npy")[0, 0, :3], [0.5, 0.5, 0.2], rtol=1e-6)
        self.assertEqual((found["difference"], found["gain"]), ("d.npy", 2))


class Encodings(ProgramTest):
    def test_an_srgb_png_is_decoded_beside_linear_light(self):
        light = numpy.linspace(0, 1, 64).reshape(8, 8, 1).repeat(3, 2)
        encoded = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        stored = numpy.floor(255 * encoded + 0.5)
        numpy.save(self.folder / "light.npy", light)
        srgb = chunk(b"sRGB", b"\0")
        self.write("srgb.png", png(stored, extra=srgb))
        self.write("gamma.png", png(stored, extra=chunk(b"gAMA", struct.pack(">I", 45455))))
        self.write("other.png", png(255 * light**0.5, 16, extra=chunk(b"gAMA", struct.pack(">I", 50000))))
        self.write("linear.png", png(numpy.floor(255 * light + 0.5), extra=chunk(b"gAMA", struct.pack(">I", 100000))))
        self.write("plain.png", png(stored))
        for name, words in (("srgb.png", "srgb.png is decoded from sRGB"), ("gamma.png", "decoded from sRGB"),
                            ("linear.png", "values as stored: linear light")):
            found = self.json_of("compare", "light.npy", name)
            self.assertLess(found["maximum"], 0.005, name)
            self.assertIn(words, found["compared"])
            self.assertNotIn("hint", found)
        self.assertIn("a gamma of 0.5", self.json_of("compare", "light.npy", "other.png")["compared"])
        # The same both ways round, and between two files of 8 bits.
        for a, b in (("srgb.png", "light.npy"), ("srgb.png", "linear.png")):
            self.assertLess(self.json_of("compare", a, b)["maximum"], 0.008)
        self.assertEqual(self.json_of("compare", "srgb.png", "srgb.png")["compared"],
                         "values as stored: colours over black, encoded as sRGB")
        # A file that does not say is taken as it is, aloud, or as the user says.
        found = self.json_of("compare", "light.npy", "plain.png")
        self.assertGreater(found["maximum"], 0.2)
        self.assertIn("--encoding srgb", " ".join(found["warnings"]))
        self.assertLess(self.json_of("compare", "light.npy", "plain.png", "--encoding", "srgb")["maximum"], 0.005)

    def test_colours_of_a_png_count_by_their_opacity(self):
        straight = numpy.array([[[255, 51, 0, 51], [255, 255, 255, 255]]])
        numpy.save(self.folder / "over_black.npy", straight * [[[1, 1, 1, 5]]] / 255 * [[[0.2] * 4, [1, 1, 1, 0.2]]])
        self.write("straight.png", png(straight, extra=chunk(b"gAMA", struct.pack(">I", 100000))))
        found = self.json_of("compare", "over_black.npy", "straight.png")
        self.assertLess(found["maximum"], 1e-12)
        self.assertLess(found["opacity"]["maximum"], 1e-12)
        self.assertIn("composited over black", found["compared"])

    def test_opacities_that_one_file_lacks(self):
        numpy.save(self.folder / "rgba.npy", numpy.zeros((2, 2, 4)))
        numpy.save(self.folder / "rgb.npy", numpy.zeros((2, 2, 3)))
        found = self.json_of("compare", "rgba.npy", "rgb.npy")
        self.assertIsNone(found["opacity"])
        self.assertIn("rgb.npy has no opacity", " ".join(found["warnings"]))


class Registration(ProgramTest):
    def setUp(self):
        super().setUp()
        random = numpy.random.default_rng(3)
        self.noise = random.random((40, 56, 4))
        y, x = numpy.mgrid[0:64, 0:64] / 64
        self.smooth = numpy.stack([numpy.exp(-40 * ((x - 0.4) ** 2 + 2 * (y - 0.3) ** 2)) * c for c in (1, 0.5, 0.2, 1)], 2)

    def found(self, a, b, *options):
        numpy.save(self.folder / "a.npy", a)
        numpy.save(self.folder / "b.npy", b)
        return self.json_of("compare", "a.npy", "b.npy", *options)

    def test_what_was_done_is_undone_and_stated(self):
        shift = lambda image, right, down: numpy.roll(image, (down, right), (0, 1))
        for name, image in (("noise", self.noise), ("smooth", self.smooth)):
            for what, changed, stated in (
                ("right and up", shift(image, 3, -5), {"moved_right": -3, "moved_down": 5}),
                ("one pixel", shift(image, 0, 1), {"moved_down": -1}),
                ("mirrored", image[:, ::-1], {"flipped_left_to_right": True}),
                ("upside down", image[::-1], {"flipped_upside_down": True}),
                ("turned", image[::-1, ::-1], {"flipped_upside_down": True, "flipped_left_to_right": True}),
                ("transposed", image.transpose(1, 0, 2), {"transposed": True}),
                ("0 to 255", 255 * image, {"colors_times": 1 / 255, "opacity_times": 1 / 255}),
                ("half as bright", image * [0.5, 0.5, 0.5, 1], {"colors_times": 2, "opacity_times": 1}),
                ("larger", image.repeat(2, 0).repeat(2, 1), {"averaged_over_blocks": {"reference": 1, "image": 2}}),
                ("flipped and moved", shift(image[::-1], 2, 1), {"flipped_upside_down": True, "moved_right": -2}),
            ):
                with self.subTest(name, what=what):
                    answer = self.found(image, changed, "--register")
                    for key, value in stated.items():
                        if isinstance(value, float):
                            self.assertAlmostEqual(answer["registered"][key], value, delta=1e-12)
                        else:
                            self.assertEqual(answer["registered"][key], value, answer["registered"])
                    self.assertLess(answer["maximum"], 1e-12)
                    self.assertLess(answer["opacity"]["maximum"], 1e-12)
                    if changed.shape == image.shape:
                        plain = self.found(image, changed)
                        self.assertIn("--register", plain["hint"])
                        self.assertGreater(plain["rmse"], 1e-3)

    def test_the_smaller_image_may_be_either(self):
        small = self.noise.reshape(20, 2, 28, 2, 4).mean((1, 3))
        answer = self.found(self.noise, small, "--register")
        self.assertEqual(answer["registered"]["averaged_over_blocks"], {"reference": 2, "image": 1})
        self.assertEqual(answer["size"], [28, 20])
        self.assertLess(answer["maximum"], 1e-12)

    def test_large_images_are_registered_from_coarse_to_fine(self):
        image = numpy.random.default_rng(4).random((300, 530, 3))
        answer = self.found(image, numpy.roll(image[:, ::-1], (7, -33), (0, 1)), "--register")["registered"]
        self.assertEqual((answer["flipped_left_to_right"], answer["moved_right"], answer["moved_down"]), (True, -33, -7))

    def test_nothing_is_done_to_images_that_are_near(self):
        noisy = self.smooth + 1e-3 * numpy.random.default_rng(5).standard_normal(self.smooth.shape)
        for image in (self.smooth, noisy, self.smooth + 1e-9, 1.001 * self.smooth, numpy.random.default_rng(6).random((64, 64, 4))):
            self.assertNotIn("hint", self.found(self.smooth, image))
            answer = self.found(self.smooth, image, "--register")
            self.assertIn("nothing", answer["registered"]["in_words"])
            self.assertAlmostEqual(answer["rmse"], float(numpy.sqrt(((image - self.smooth)[..., :3] ** 2).mean())))
        self.assertNotIn("hint", self.found(0 * self.smooth, self.smooth))

    def test_sizes_that_differ_are_named(self):
        numpy.save(self.folder / "a.npy", self.noise)
        numpy.save(self.folder / "b.npy", self.noise.repeat(2, 0).repeat(2, 1))
        numpy.save(self.folder / "c.npy", self.noise[1:])
        self.assert_refused(self.run_program("compare", "a.npy", "b.npy"), "a.npy has 56 x 40", "b.npy has 112 x 80", "--register")
        for options in ([], ["--register"]):
            self.assert_refused(self.run_program("compare", "a.npy", "c.npy", *options), "a.npy has 56 x 40", "c.npy has 56 x 39", "allowed")


class Files(ProgramTest):
    def test_the_same_image_in_every_format(self):
        array = numpy.array([[[0, 51, 255], [102, 204, 153]], [[255, 0, 0], [1, 2, 3]], [[9, 8, 7], [0, 0, 0]]])
        shares = array / 255
        self.write("8.png", png(array))
        self.write("16.png", png(array * 257, 16))
        self.write("rgba.png", png(numpy.concatenate([array, numpy.full((3, 2, 1), 255)], 2)))
        self.write("i.pfm", pfm(shares))
        self.write("big.pfm", b"PF 2 3 1.0\n" + shares[::-1].astype(">f4").tobytes())
        numpy.save(self.folder / "f8.npy", shares)
        numpy.save(self.folder / "f4.npy", shares.astype("f4"))
        numpy.save(self.folder / "rgba.npy", numpy.concatenate([shares, numpy.ones((3, 2, 1))], 2))
        for name in self.names_in_folder():
            found = self.json_of("compare", "f8.npy", name)
            self.assertLess(found["maximum"], 1e-7, name)
            self.assertEqual(found["size"], [2, 3])

    def test_grey(self):
        array = numpy.arange(6).reshape(2, 3) / 8
        numpy.save(self.folder / "grey.npy", array)
        numpy.save(self.folder / "rgb.npy", numpy.repeat(array[..., None], 3, 2))
        self.write("grey.pfm", b"Pf\n3 2\n-1\n" + array[::-1].astype("<f4").tobytes())
        for name in ("grey.npy", "grey.pfm"):
            self.assertEqual(self.json_of("compare", "rgb.npy", name)["maximum"], 0)

    def test_refused(self):
        numpy.save(self.folder / "good.npy", numpy.zeros((2, 3, 3)))
        numpy.save(self.folder / "wide.npy", numpy.zeros((2, 4, 3)))
        numpy.save(self.folder / "complex.npy", numpy.zeros((2, 3, 3), complex))
        numpy.save(self.folder / "fortran.npy", numpy.asfortranarray(numpy.zeros((2, 3, 3))))
        numpy.save(self.folder / "channels.npy", numpy.zeros((2, 3, 2)))
        numpy.save(self.folder / "nan.npy", numpy.full((2, 3, 3), numpy.nan))
        good = (self.folder / "good.npy").read_bytes()
        self.write("short.npy", good[:-1])
        self.write("header.npy", good[:20])
        self.write("huge.npy", good.replace(b"(2, 3, 3)", b"(99999999999, 3, 3)"[:9]))
        self.write("absurd.pfm", b"PF\n99999999 99999999\n-1\n")
        self.write("short.pfm", b"PF\n3 2\n-1\n\0\0")
        self.write("bad.pfm", b"P6\n3 2\n255\n")
        self.write("short.png", png(numpy.zeros((2, 3, 3)))[:-30])
        self.write("bad.png", b"PNG")
        self.write("bad.txt", b"PNG")
        for name in ("wide.npy", "complex.npy", "fortran.npy", "channels.npy", "nan.npy", "short.npy", "header.npy", "huge.npy",
                     "absurd.pfm", "short.pfm", "bad.pfm", "short.png", "bad.png", "bad.txt", "absent.png"):
            with self.subTest(name):
                self.assert_refused(self.run_program("compare", "good.npy", name), "allowed" if name != "absent.png" else "absent.png")


if __name__ == "__main__":
    unittest.main()
