"""Small inputs that once went wrong in silence, in tests/cases: a folder each, whose `expect` says what must happen. A row
of the table says how that is checked."""

import shutil
import unittest

from support import SOURCE, ProgramTest

try:
    import numpy
except ImportError:
    numpy = None

CASES = SOURCE / "tests/cases"


# --- Images, `compare` and bounds ---


def slab_answers(largest_bound, is_dark=False):
    def check(test):
        reference = test.json_of("eval", "case.json")["reference"]
        test.assertNotIn("status", reference)
        test.assertLess(reference["error_bound"], largest_bound)
        if is_dark:
            test.assertEqual(reference["diffuse"], [0, 0, 0])
            test.assertAlmostEqual(reference["opacity"], 0.8347011117784134)  # 1 - exp(-1.8)

    return check


def cone_energy(test):
    reference = test.json_of("eval", "case.json")["reference"]
    # 0.65538755529002444 to the last digit; binary64 cannot say more.
    for specular in reference["specular"]:
        test.assertLessEqual(abs(specular - 0.65538755529002442133136774902528), reference["error_bound"])


def render_opacity(test, scene="scene.json", *options):
    test.output_of("render", scene, "-o", "o.npy", *options)
    return numpy.load(test.folder / "o.npy")[0, 0, 3]


def cell_cubic(opacity):
    def check(test):
        test.assertAlmostEqual(float(render_opacity(test)), opacity, delta=1e-6)
        scene = (test.folder / "scene.json").read_text().replace('"cell_cubic"', '"reference"')
        test.assertAlmostEqual(float(render_opacity(test, test.write("reference.json", scene))), opacity, delta=1e-6)

    return check


def covers(opacity):
    """The exact ray sees this opacity: the radius must reach it."""

    def check(test):
        found = float(render_opacity(test))
        radius = numpy.load(test.folder / "o.radius.npy")[0, 0]
        test.assertLessEqual(abs(found - opacity), radius)

    return check


def whole_numbers(test):
    answer = test.json_of("compare", "a.npy", "b.npy")
    test.assertAlmostEqual(answer["rmse"], 40, delta=1e-6)
    test.assertIn("0 to 255", " ".join(answer["warnings"]))


def opacity_only(test):
    answer = test.json_of("compare", "a.npy", "b.npy")
    a, b = (numpy.load(test.folder / name)[..., 3].astype(float) for name in ("a.npy", "b.npy"))
    test.assertAlmostEqual(answer["opacity"]["maximum"], abs(a - b).max())
    test.assertAlmostEqual(answer["opacity"]["rmse"], ((a - b) ** 2).mean() ** 0.5)
    test.assertGreater(answer["all_channels"]["rmse"], 0)


def own_png(test):
    for name in ("o.npy", "o.png"):
        test.output_of("render", "scene.json", "-o", name)
    answer = test.json_of("compare", "o.npy", "o.png")
    test.assertLess(answer["rmse"], 0.003)
    test.assertIn("o.png is decoded from sRGB", answer["compared"])


IMAGES = {
    "bound_cone_energy": cone_energy,
    "bound_image_far_scene": covers(1.0),
    "bound_image_near_camera": covers(0.9999999999999937),
    "cellcubic_labels": cell_cubic(0.950213),
    "cellcubic_narrow_range": cell_cubic(0.917915),
    "compare_0_to_255": whole_numbers,
    "compare_opacity_only": opacity_only,
    "compare_own_png": own_png,
    "slab_light_perpendicular": slab_answers(1e-12, is_dark=True),
    "slab_refused_41": slab_answers(1e-11),
    "slab_refused_58": slab_answers(1e-11),
    "slab_refused_9": slab_answers(1e-11),
}


CHECKS = {**IMAGES}


@unittest.skipIf(numpy is None, "numpy (Debian: python3-numpy) is not installed")
class Cases(ProgramTest):
    def test_every_case_has_a_check(self):
        self.assertEqual({path.name for path in CASES.iterdir()}, set(CHECKS))

    def test_every_case_behaves_as_it_says(self):
        for name, check in CHECKS.items():
            with self.subTest(name):
                for old in self.folder.iterdir():
                    old.unlink()
                for file in (CASES / name).iterdir():
                    shutil.copy(file, self.folder)
                check(self)


if __name__ == "__main__":
    unittest.main()
