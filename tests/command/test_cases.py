"""The cases of tests/cases: each folder has small inputs, and in `expect` what must become of them."""

import json
import shutil
import unittest

from support import SOURCE, ProgramTest

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


CHECKS = {
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


class Cases(Case):
    def test_every_case_has_its_check(self):
        self.assertEqual(sorted(path.name for path in CASES.iterdir()), sorted(CHECKS))


def test_of(name):
    def test(self):
        self.take(name)
        CHECKS[name](self)

    return test


for case_name in CHECKS:
    setattr(Cases, f"test_{case_name}", test_of(case_name))


if __name__ == "__main__":
    unittest.main()
