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


def png(array, depth=8):
    """An image of the array's whole numbers, without filters."""
    height, width, channels = array.shape
    rows = b"".join(b"\0" + row.astype(">u2" if depth == 16 else "u1").tobytes() for row in array)
    color = {1: 0, 3: 2, 4: 6}[channels]

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Metrics(ProgramTest):
    def compare(self, reference, image, *options):
        self.write("a.pfm", pfm(numpy.asarray(reference, float)))
        self.write("b.pfm", pfm(numpy.asarray(image, float)))
        return self.json_of("compare", "a.pfm", "b.pfm", *options)

    def test_by_hand(self):
        found = self.compare([[[0.5, 0.25, 0], [0.25, 0, 1]]], [[[0.5, 0.5, 0], [-0.25, 0.125, 2]]])
        rmse = ((1 / 16 + 1 / 16 + 1 / 64) / 6) ** 0.5
        self.assertAlmostEqual(found["danskin_hanrahan"], 100 * 0.625 / 2)
        self.assertAlmostEqual(found["rmse"], rmse)
        self.assertAlmostEqual(found["psnr"], -20 * numpy.log10(rmse))
        self.assertEqual(found["psnr_peak"], 1)
        self.assertEqual((found["maximum"], found["maximum_pixel"]), (0.25, [0, 0]))
        self.assertAlmostEqual(found["bias"], 0.125 / 6)
        self.assertIsNone(found["ssim"])  # smaller than a window

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
            expected = structural_similarity(
                a.astype(float), numpy.clip(b, 0, 1).astype(float), data_range=1, channel_axis=2,
                gaussian_weights=True, sigma=1.5, use_sample_covariance=False)
            self.assertAlmostEqual(self.compare(a, b)["ssim"], expected, places=12)

    def test_difference_image(self):
        found = self.compare([[[0.5, 0.25, 0]]], [[[0.25, 0.5, 0.1]]], "--difference", "d.npy", "--gain", 2)
        numpy.testing.assert_allclose(numpy.load(self.folder / "d.npy")[0, 0, :3], [0.5, 0.5, 0.2], rtol=1e-6)
        self.assertEqual((found["difference"], found["gain"]), ("d.npy", 2))


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
