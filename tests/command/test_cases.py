"""The cases of tests/cases: each folder has small inputs, and in `expect` what must become of them."""

import json
import math
import re
import shutil
import struct
import unittest
from decimal import Decimal

from support import SOURCE, ProgramTest

try:
    import numpy
except ImportError:
    numpy = None

CASES = SOURCE / "tests/cases"


class Case(ProgramTest):
    """A case's files lie in a folder of their own, in which the program runs."""

    def take(self, name):
        shutil.copytree(CASES / name, self.folder, dirs_exist_ok=True)

    def warned(self, *arguments):
        """The JSON that the program writes, and what it says beside."""
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return json.loads(done.stdout), done.stderr.decode()


# --- files ---


def axis_mins_maxs(case):
    volume = case.json_of("info", "--json", "./a.nrrd")
    for spacing, right in zip(volume["spacing"], (1.5, 4 / 3, 1), strict=True):
        case.assertAlmostEqual(spacing, right, places=15)
    case.assertTrue(volume["has_spacing"])


def csv_bom(case):
    with_mark = case.output_of("score", "vectors.json", "a.csv")
    plain = (case.folder / "a.csv").read_bytes().removeprefix(b"\xef\xbb\xbf")
    case.assertEqual(case.output_of("score", "vectors.json", case.write("plain.csv", plain)), with_mark)
    case.assertEqual(with_mark.splitlines()[-1].split()[1:3], ["3", "3"])


def csv_one_nan(case):
    levels, said = case.warned("score", "vectors.json", "a.csv", "--json")
    case.assertEqual(said, "raytruth: a.csv: 1 of 3 answers are not finite, and count as no digits; the first is smooth_ray_01\n")
    every = levels[-1]
    case.assertEqual((every["cases"], every["digits_min"], every["worst"]), (3, 0, "smooth_ray_01"))
    case.assertGreater(every["digits_median"], 12)


def csv_semicolons(case):
    levels, said = case.warned("score", "vectors.json", "a.csv", "--json")
    case.assertEqual(said, "raytruth: a.csv: read with semicolons between fields and decimal commas\n")
    case.assertGreater(levels[-1]["digits_min"], 12)


def extension_upper_case(case):
    for name in ("A.NII", "./A.NII"):
        volume = case.json_of("info", name, "--json")
        case.assertEqual((volume["format"], volume["size"]), ("NIfTI-1", [4, 3, 2]))


def fuzz_gzip_bomb(case):
    volume = case.json_of("info", "a.nrrd", "--json")
    case.assertEqual((volume["size"], volume["maximum"]), ([256, 256, 256], 0))
    for limit in ("64MiB", "64M", str(1 << 26)):
        done = case.run_program("info", "a.nrrd", "--memory-limit", limit)
        case.assert_refused(done, "a.nrrd: ", "256 x 256 x 256 voxels", "134217728 bytes", "67108864", "--memory-limit")
    by_environment = case.run_program("info", "a.nrrd", environment={"RAYTRUTH_MEMORY_LIMIT": "64MiB"})
    case.assert_refused(by_environment, "67108864")
    case.json_of("info", "a.nrrd", "--json", "--memory-limit", "128MiB")


def gzip_byte_skip_minus_1(case):
    volume = case.json_of("info", "--json", "./a.nhdr")
    case.assertEqual((volume["minimum"], volume["maximum"], volume["levels"]), (5, 74, 24))


def gzip_zero_padding_nifti(case):
    volume, said = case.warned("info", "--json", "./a.nii.gz")
    case.assertEqual((volume["minimum"], volume["maximum"], said), (5, 74, ""))


def nan_background(case):
    case.assert_refused(case.run_program("info", "--json", "./a.nii"), "a.nii: ", "4 of 24 voxels are NaN", "--nan VALUE", '"nan": VALUE')
    volume, said = case.warned("info", "--json", "./a.nii", "--nan", "-1")
    case.assertEqual((volume["minimum"], volume["maximum"]), (-1, 74))
    case.assertIn("4 of 24 voxels are NaN, the first is voxel (0, 0, 0); they are given the value -1", said)
    case.assert_refused(case.run_program("info", "./a.nii", "--nan", "nan"), "--nan")


def negative_pixdim(case):
    volume, said = case.warned("info", "--json", "./a.nii")
    case.assertEqual(volume["spacing"], [1, 2, 3])
    case.assertIn("the spacing of axis 0 is -1", said)


def nifti_slope_nan(case):
    volume, said = case.warned("info", "--json", "./a.nii")
    case.assertEqual((volume["minimum"], volume["maximum"], volume["slope"]), (5, 74, 1))
    case.assertIn("scl_slope is nan; the voxels are read unscaled", said)


def not_gzip_named_gz(case):
    volume, said = case.warned("info", "--json", "./a.nii.gz")
    case.assertEqual((volume["minimum"], volume["maximum"], volume["encoding"]), (5, 74, "raw"))
    case.assertIn("the name says gzip, and the bytes are not", said)


def rgb_axis_none(case):
    case.assert_refused(case.run_program("info", "--json", "./a.nrrd"), "a.nrrd: axis 0 has the direction none, so it is no axis of space")


def time_axis_nifti(case):
    case.assert_refused(case.run_program("info", "--json", "./a.nii"), "axis 4 is time, 2 steps of 2.5", "--time-step N", '"time_step": N')
    first, second = (case.json_of("info", "--json", "./a.nii", "--time-step", step) for step in (0, 1))
    case.assertEqual((first["size"], first["spacing"]), ([4, 3, 1], [3, 3, 5]))
    case.assertEqual((first["minimum"], first["maximum"], second["minimum"], second["maximum"]), (5, 38, 41, 74))
    case.assert_refused(case.run_program("info", "./a.nii", "--time-step", "2"), "the time step 2 is asked for; 0 to 1 are allowed")


def uint64_labels(case):
    volume, said = case.warned("info", "--json", "./a.nrrd")
    case.assertIn("24 of 24 voxels are integers beyond 2^53, which binary64 does not keep apart: 24 of them are rounded", said)
    case.assertIn(volume["warnings"][0], said)


FILES = {
    "axis_mins_maxs": axis_mins_maxs,
    "csv_bom": csv_bom,
    "csv_one_nan": csv_one_nan,
    "csv_semicolons": csv_semicolons,
    "extension_upper_case": extension_upper_case,
    "fuzz_gzip_bomb": fuzz_gzip_bomb,
    "gzip_byte_skip_minus_1": gzip_byte_skip_minus_1,
    "gzip_zero_padding_nifti": gzip_zero_padding_nifti,
    "nan_background": nan_background,
    "negative_pixdim": negative_pixdim,
    "nifti_slope_nan": nifti_slope_nan,
    "not_gzip_named_gz": not_gzip_named_gz,
    "rgb_axis_none": rgb_axis_none,
    "time_axis_nifti": time_axis_nifti,
    "uint64_labels": uint64_labels,
}


# --- images, comparisons and bounds ---


def slab_answers(largest_bound, is_dark=False):
    def check(case):
        reference = case.json_of("eval", "case.json")["reference"]
        case.assertNotIn("status", reference)
        case.assertLess(reference["error_bound"], largest_bound)
        if is_dark:
            case.assertEqual(reference["diffuse"], [0, 0, 0])
            case.assertAlmostEqual(reference["opacity"], 0.8347011117784134)  # 1 - exp(-1.8)

    return check


def cone_energy(case):
    reference = case.json_of("eval", "case.json")["reference"]
    # 0.65538755529002444 to the last digit; binary64 cannot say more.
    for specular in reference["specular"]:
        case.assertLessEqual(abs(specular - 0.65538755529002442133136774902528), reference["error_bound"])


def render_opacity(case, scene="scene.json", *options):
    case.output_of("render", scene, "-o", "o.npy", *options)
    return numpy.load(case.folder / "o.npy")[0, 0, 3]


def cell_cubic(opacity):
    def check(case):
        case.assertAlmostEqual(float(render_opacity(case)), opacity, delta=1e-6)
        scene = (case.folder / "scene.json").read_text().replace('"cell_cubic"', '"reference"')
        case.assertAlmostEqual(float(render_opacity(case, case.write("reference.json", scene))), opacity, delta=1e-6)

    return check


def covers(opacity):
    """The exact ray sees this opacity: the radius must reach it."""

    def check(case):
        found = float(render_opacity(case))
        radius = numpy.load(case.folder / "o.radius.npy")[0, 0]
        case.assertLessEqual(abs(found - opacity), radius)

    return check


def whole_numbers(case):
    answer = case.json_of("compare", "a.npy", "b.npy")
    case.assertAlmostEqual(answer["rmse"], 40, delta=1e-6)
    case.assertIn("0 to 255", " ".join(answer["warnings"]))


def opacity_only(case):
    answer = case.json_of("compare", "a.npy", "b.npy")
    a, b = (numpy.load(case.folder / name)[..., 3].astype(float) for name in ("a.npy", "b.npy"))
    case.assertAlmostEqual(answer["opacity"]["maximum"], abs(a - b).max())
    case.assertAlmostEqual(answer["opacity"]["rmse"], ((a - b) ** 2).mean() ** 0.5)
    case.assertGreater(answer["all_channels"]["rmse"], 0)


def own_png(case):
    for name in ("o.npy", "o.png"):
        case.output_of("render", "scene.json", "-o", name)
    answer = case.json_of("compare", "o.npy", "o.png")
    case.assertLess(answer["rmse"], 0.003)
    case.assertIn("o.png is decoded from sRGB", answer["compared"])


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


# --- presets of other programs ---


def presets(opacities=None, colors=None, says=(), options=()):
    """The opacities over 2 voxels, the colours, and words of what is said of the file."""

    def check(case):
        answer, said = case.warned("render", "scene.json", "-o", "o.npy", *options)
        image = numpy.load(case.folder / "o.npy")[0]
        if opacities is not None:
            numpy.testing.assert_allclose(image[:, 3], opacities, atol=1e-6)
        if colors is not None:
            numpy.testing.assert_allclose(image[:, :3], image[:, 3:] * colors, atol=1e-4)
        for words in says:
            case.assertIn(words, said + json.dumps(answer["transfer_function"]))

    return check


def between(share):
    """Of the way from blue to red."""
    return [share, 0, 1 - share]


def table_of_a_preset(case):
    case.output_of("table", "c.json", "-o", "t.npy")
    understood = json.loads((case.folder / "t.npy.json").read_text())["transfer_function"]
    case.assertEqual((understood["format"], understood["unit_length"]), ("ParaView colour map", 1))
    table = numpy.load(case.folder / "t.npy")
    # On the diagonal the scalar is constant, so a slab of the unit's length has the opacity that the file states.
    numpy.testing.assert_allclose(table[range(16), range(16), 3], numpy.arange(16) / 15, atol=1e-6)


PRESETS = {
    "opacity_file_own_range": presets([0, 0.4375, 0.75, 0.96], options=("--opacity", "o.json")),
    "opacity_rounded_up": presets([0, 0.4375, 0.75], says=["1.0000001 among the opacities is taken as 1"]),
    "paraview_log_scale": presets(
        colors=[between(0), between(1 / 3), between(2 / 3), between(1)], says=["over the logarithm of the scalar"]
    ),
    "paraview_preset_other_range": presets([0, 0.4375, 0.75, 1], says=["stretched over the data's 0 to 100"]),
    "paraview_xml_map": presets([0, 0.4375, 0.75], says=["ParaView colour map (XML)"]),
    "slicer_point_above_zero": presets([0.4524, 0.5775, 0.75, 0.75], says=["a jump"]),
    "slicer_vp_json": presets(
        [0, 0.234375, 0.4375, 0.75], [between(0.25 * i) for i in (0, 1, 2, 4)], says=["3D Slicer", '"shininess": 1']
    ),
    "table_of_a_preset": table_of_a_preset,
    "unit_distance_half_mm": presets([0, 0.125, 0.25, 0.5], says=['"unit_length": 2']),
    "unsorted_paraview": presets([0, 0.4375, 0.75], says=["they are sorted", '"stretched" stretches them']),
}


# --- rays of any size ---


def exact_values(case):
    """Red, green, blue and opacity as `expect` has them, in some 45 digits."""
    text = (case.folder / "expect").read_text().split("[red green blue opacity", 1)[1].split(";")[0]
    return [Decimal(number) for number in re.findall(r"\d[\d.e+-]*", re.sub(r"\+/- [\d.e+-]*", "", text))]


def encloses(relative):
    """Every exact value lies within the bound, and the bound is this small against the largest."""

    def check(case):
        reference = case.json_of("eval", "case.json")["reference"]
        exact = exact_values(case)
        case.assertEqual(len(exact), 4)
        bound = Decimal(reference["error_bound"])
        for found, right in zip([*reference["color"], reference["opacity"]], exact, strict=True):
            case.assertLessEqual(abs(Decimal(found) - right), bound)
        case.assertGreater(bound, 0)
        case.assertLess(bound, Decimal(relative) * max(exact))

    return check


def answers(color, opacity, largest_bound):
    def check(case):
        reference = case.json_of("eval", "case.json")["reference"]
        case.assertNotIn("status", reference)
        case.assertLess(reference["error_bound"], largest_bound)
        for found, right in zip([*reference["color"], reference["opacity"]], [*color, opacity], strict=True):
            case.assertLessEqual(abs(found - right), reference["error_bound"] + 1e-16)

    return check


def flat_on_a_jump(case):
    answer = json.loads(case.output_of("render", "scene.json", "-o", "o.npy"))
    case.assertEqual(answer["not_converged"], 0)
    case.assertLess(answer["error_bound"], 1e-7)  # of the file, in binary32
    opacities = struct.unpack("<12f", (case.folder / "o.npy").read_bytes()[-48:])[3::4]
    case.assertAlmostEqual(opacities[1], 0.99, places=6)


SIZES = {
    "bound_color_subnormal_plain": encloses("1e-12"),
    "bound_len_3pieces_subnormal": encloses("1e-13"),
    "bound_subnormal_length": encloses("1e-13"),
    "bound_tau_small_linear": encloses("1e-12"),
    "bound_tau_subnormal": encloses("1e-2"),  # binary64 has no closer number
    "bound_underflow_deg5": encloses("1e-13"),
    "bound_underflow_digits": encloses("1e-12"),
    "bound_underflow_to_zero": encloses("1e-12"),
    "flat_on_a_jump": flat_on_a_jump,
    # The fourth power touches the jump and goes back: extinction 1 throughout.
    "wide_contact_order_4_at_jump": answers([x * -math.expm1(-1) for x in (0.1, 0.2, 0.3)], -math.expm1(-1), 1e-14),
    "wide_homogeneous_depth_1e15": answers([0.3, 0.6, 0.9], 1, 1e-14),
    # The mean scalar of the light is 1e-13 beyond the jump: the colour there, 2e-13 on the way from one to the other.
    "wide_jump_to_1e13": answers([0.3 + 1.2e-13, 0.6, 0.9 - 1.2e-13], 1, 1e-13),
    "wide_refused_1e35_constant": answers([0.5, 0.25, 0.125], 1, 1e-13),
    # Three voxels of the right-hand value: 1 - exp(-9).
    "wide_voxel_row_constant_at_jump": answers([x * -math.expm1(-9) for x in (0.9, 0.6, 0.1)], -math.expm1(-9), 1e-14),
}


CHECKS = {**FILES, **IMAGES, **PRESETS, **SIZES}


class Cases(Case):
    def test_every_case_has_its_check(self):
        self.assertEqual(sorted(path.name for path in CASES.iterdir()), sorted(CHECKS))


def test_of(name):
    @unittest.skipIf(name not in FILES and numpy is None, "numpy (Debian: python3-numpy) is not installed")
    def test(self):
        self.take(name)
        CHECKS[name](self)

    return test


for case_name in CHECKS:
    setattr(Cases, f"test_{case_name}", test_of(case_name))


if __name__ == "__main__":
    unittest.main()
