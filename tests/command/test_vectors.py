"""`raytruth vectors` and `raytruth score`: the conformance vectors, and what answers to them are worth."""

import bisect
import json
import math
import struct
import unittest
from fractions import Fraction

import jsonschema

import exact_integral
from support import SOURCE, ProgramTest, changed

SCHEMA = json.loads((SOURCE / "experiments/schemas/vectors.json").read_text())
COMMITTED = SOURCE / "results/vectors.json"


def csv(answers):
    return "id,r,g,b,opacity\n" + "".join(f"{name},{','.join(map(repr, numbers))}\n" for name, numbers in answers.items())


def in_list(points, name, channel, s, is_below):
    """What a list of points is at s, exactly; `is_below`: from below."""
    numbers = [Fraction(point[name][channel] if name == "color" else point[name]) for point in points]
    places = [Fraction(point["s"]) for point in points]
    following = (bisect.bisect_left if is_below else bisect.bisect_right)(places, s)
    if following in (0, len(places)):
        return numbers[min(following, len(places) - 1)]
    weight = (Fraction(s) - places[following - 1]) / (places[following] - places[following - 1])
    return numbers[following - 1] + weight * (numbers[following] - numbers[following - 1])


def truths(vectors):
    """The certified answers themselves."""
    references = {vector["id"]: vector["reference"] for vector in vectors}
    return {name: [*reference["color"], reference["opacity"]] for name, reference in references.items()}


class Vectors(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.committed = json.loads(COMMITTED.read_text())

    def test_schema_describes_them(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)
        for document in (self.committed, self.json_of("vectors", "--seed", "7")):
            jsonschema.Draft202012Validator(SCHEMA).validate(document)

    def test_ids_and_levels(self):
        ids = [vector["id"] for vector in self.committed["vectors"]]
        self.assertEqual(len(set(ids)), len(ids))
        levels = [level["level"] for level in self.committed["levels"]]
        self.assertEqual(levels, SCHEMA["$defs"]["level"]["enum"])
        self.assertEqual([level["difficulty"] for level in self.committed["levels"]], list(range(1, len(levels) + 1)))
        for level in levels:
            count = sum(vector["level"] == level for vector in self.committed["vectors"])
            self.assertTrue(10 <= count <= 20, (level, count))
        self.assertLess(COMMITTED.stat().st_size, 300_000)

    def test_separate_lists_are_the_transfer_function(self):
        """At every point of either list, from below and from above, in exact fractions."""
        count = 0
        for vector in self.committed["vectors"]:
            self.assertEqual("separate_lists" in vector, vector["level"] == "separate_lists")
            if "separate_lists" not in vector:
                continue
            count += 1
            lists, joined = vector["separate_lists"], vector["transfer_function"]
            self.assertEqual(lists.get("unit_length"), joined.get("unit_length"))
            density = "opacity" if "opacity" in lists else "extinction"
            scalars = {point["s"] for name in ("color", density) for point in lists[name]}
            self.assertEqual({point["s"] for point in joined["points"]}, scalars)
            for name, channels in ((density, 1), ("color", 3)):
                for s in scalars:
                    for is_below in (False, True):
                        for channel in range(channels):
                            self.assertEqual(
                                in_list(lists[name], name, channel, s, is_below), in_list(joined["points"], name, channel, s, is_below)
                            )
        self.assertEqual(count, 16)

    def test_points_that_a_program_drops_are_seen(self):
        """As by programs that look their opacities up at the points of the colours only, or the other way round."""
        for vector in self.committed["vectors"]:
            if "separate_lists" not in vector or "signal" not in vector:
                continue
            reference = vector["reference"]
            density = "opacity" if "opacity" in vector["separate_lists"] else "extinction"
            for name, least in (("color", 1e-2), (density, 1e-4)):
                kept = {point["s"] for point in vector["separate_lists"][name]}
                points = [point for point in vector["transfer_function"]["points"] if point["s"] in kept]
                color, opacity = exact_integral.integrate(changed(vector, "/transfer_function/points", points))
                errors = [abs(float(x) - y) for x, y in zip([*color, opacity], [*reference["color"], reference["opacity"]])]
                self.assertGreater(max(errors), least, (vector["id"], name))

    def test_first_form_is_the_beginning(self):
        """Those who read vectors/1 are asked what they were asked, bit by bit."""
        first, second = self.output_of("vectors", "--form", "vectors/1"), self.output_of("vectors")
        self.assertEqual(second, self.output_of("vectors", "--form", "vectors/2"))
        lines = second.splitlines()
        kept = [line for line in first.splitlines() if line.startswith("    {")]
        self.assertEqual(len(kept), 9 + 140)
        for line in kept:
            self.assertTrue(line in lines or line + "," in lines, line[:80])
        jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(first))
        self.assertEqual(json.loads(first)["raytruth"], "vectors/1")
        self.assert_refused(self.run_program("vectors", "--form", "vectors/3"), "--form", "vectors/1", "vectors/2")

    def test_every_number_is_right_to_its_bound(self):
        """Against 60 decimal digits, computed in Python from what the schema says."""
        for vector in self.committed["vectors"]:
            with self.subTest(id=vector["id"]):
                color, opacity = exact_integral.integrate(vector)
                reference = vector["reference"]
                bound = exact_integral.Decimal(reference["error_bound"])
                for exact, stated in zip([*color, opacity], [*reference["color"], reference["opacity"]]):
                    self.assertLessEqual(abs(exact - exact_integral.Decimal(stated)), bound)

    def test_bounds_leave_digits_to_count(self):
        for vector in self.committed["vectors"]:
            reference = vector["reference"]
            self.assertLess(reference["error_bound"], 1e-12 * min(reference["opacity"], max(reference["color"])), vector["id"])

    def test_committed_ones_are_these(self):
        """The same questions bit by bit; answers within both bounds, for releases of Arb may differ."""
        made = self.json_of("vectors")
        for document in (made, committed := json.loads(COMMITTED.read_text())):
            document["references"] = [vector.pop("reference") for vector in document["vectors"]]
        for here, there in zip(made.pop("references"), committed.pop("references")):
            bound = here["error_bound"] + there["error_bound"]
            for x, y in zip([*here["color"], here["opacity"]], [*there["color"], there["opacity"]]):
                self.assertLessEqual(abs(x - y), bound)
        self.assertEqual(made, committed)

    def test_same_bytes_from_every_run(self):
        text = self.output_of("vectors")
        self.assertEqual(self.output_of("vectors", "--seed", "1"), text)
        self.assertEqual(self.output_of("vectors", "-o", "v.json"), "")
        self.assertEqual((self.folder / "v.json").read_text(), text)
        self.assertEqual(self.names_in_folder(), ["v.json"])
        self.assertNotEqual(self.json_of("vectors", "--seed", "2")["vectors"], json.loads(text)["vectors"])

    def test_rays_are_cases_for_eval(self):
        """So anyone can ask the program about one of them; the bound may be wider, for eval trusts no chain."""
        rays = [vector for vector in self.committed["vectors"] if "signal" in vector]
        cases = [
            {
                **{key: vector[key] for key in ("signal", "transfer_function", "emission")},
                "sampling": {"kind": "cells"},
                "schemes": ["reference"],
            }
            for vector in rays
        ]
        for vector, answer in zip(rays, self.json_of("eval", "-", stdin=cases)):
            with self.subTest(id=vector["id"]):
                here, there = answer["reference"], vector["reference"]
                bound = here["error_bound"] + there["error_bound"]
                for x, y in zip([*here["color"], here["opacity"]], [*there["color"], there["opacity"]]):
                    self.assertLessEqual(abs(x - y), bound)

    def test_what_cannot_be_written(self):
        self.assert_refused(self.run_program("vectors", "-o", "absent/v.json"), "absent/v.json: ", "cannot be written", code=4)
        self.assert_refused(self.run_program("vectors", "--seed", "-1"), "--seed")
        self.assert_refused(self.run_program("vectors", "--seed", "x"), "--seed")


class Volumes(ProgramTest):
    """`raytruth vectors --volumes`: rays as renderers of voxels can be asked them."""

    @classmethod
    def setUpClass(cls):
        cls.committed = {vector["id"]: vector for vector in json.loads(COMMITTED.read_text())["vectors"]}

    def written(self, intervals=8):
        self.assertEqual(self.output_of("vectors", "--volumes", "rays", "--intervals", intervals), "")
        document = json.loads((self.folder / "rays/vectors.json").read_text())
        jsonschema.Draft202012Validator(SCHEMA).validate(document)
        return {vector["id"]: vector for vector in document["vectors"]}

    def test_every_vector_is_there(self):
        vectors = self.written()
        self.assertEqual(list(vectors), list(self.committed))
        for name in vectors:
            self.assertTrue((self.folder / f"rays/{name}.json").is_file())
            count = 2 if "slab" in self.committed[name] else 9
            header = (self.folder / f"rays/{name}.nrrd").read_bytes().split(b"\n\n")[0]
            self.assertIn(f"sizes: 3 3 {count}".encode(), header)

    def test_pixels_are_what_render_certifies(self):
        """Two ways to one number: ball arithmetic along the ray, and the renderer through the volume."""
        vectors = self.written()
        for level in {vector["level"] for vector in vectors.values()}:
            for name in (f"{level}_ray_01", f"{level}_ray_02"):
                answer = self.json_of("render", f"rays/{name}.json", "--binary64", "-o", "image.npy")
                image = (self.folder / "image.npy").read_bytes()[-5 * 5 * 4 * 8 :]
                pixels = [struct.unpack_from("<4d", image, 32 * i) for i in range(25)]
                reference = vectors[name]["reference"]
                # The rays of the camera are rounded, and some pixels' are not as deep as others' by as much.
                allowed = answer["error_bound"] + reference["error_bound"] + 1e-12
                for pixel in pixels:
                    for found, true in zip(pixel, [*reference["color"], reference["opacity"]]):
                        self.assertLessEqual(abs(found - true), allowed, name)

    def test_slabs_keep_their_truth(self):
        """They are linear between their two samples already: the same slab, in other units of length."""
        vectors = self.written()
        for name, vector in self.committed.items():
            if "slab" not in vector or vector["emission"] == "plain":
                continue  # what plain matter sends out is per unit of length
            true, found = vector["reference"], vectors[name]["reference"]
            for x, y in zip([*true["color"], true["opacity"]], [*found["color"], found["opacity"]]):
                self.assertAlmostEqual(x, y, delta=1e-12 + 1e-9 * abs(x), msg=name)

    def test_bad_counts_are_refused(self):
        for count in ("0", "4097", "x"):
            self.assertEqual(self.run_program("vectors", "--volumes", "rays", "--intervals", count).returncode, 2)


class Scores(ProgramTest):
    """Three vectors whose answers can be judged by hand."""

    def setUp(self):
        super().setUp()
        reference = {"color": [0.5, 0.25, 0], "opacity": 0.125, "error_bound": 1e-13}
        scene = {"emission": "plain", "slab": {"front": 0, "back": 1, "length": 1}, "transfer_function": {"points": []}}
        self.document = {
            "raytruth": "vectors/1",
            "seed": 1,
            "levels": [],
            "vectors": [
                {"id": "a", "level": "smooth", **scene, "reference": reference},
                {"id": "b", "level": "smooth", **scene, "reference": reference},
                {"id": "c", "level": "jump", **scene, "reference": {**reference, "color": [1e-9, 0, 0], "error_bound": 1e-25}},
            ],
        }
        self.vectors = self.write("vectors.json", self.document)
        self.answers = truths(self.document["vectors"])

    def score(self, text):
        return {level["level"]: level for level in self.json_of("score", self.vectors, self.write("answers.csv", text), "--json")}

    def test_digits(self):
        self.answers["a"] = [0.5, 0.25 + 0.5e-3, 0, 0.125]  # against the largest channel, 0.5
        self.answers["b"] = [0.5, 0.25, 0, 0.125 - 0.125e-5]
        self.answers["c"] = [1.01e-9, 0, 0, 0.125]
        scores = self.score(csv(self.answers))
        self.assertEqual(list(scores), ["smooth", "jump", "all"])
        self.assertEqual(list(scores["smooth"])[:6], ["level", "cases", "answered", "digits_min", "digits_median", "worst"])
        self.assertAlmostEqual(scores["smooth"]["digits_min"], 3)
        self.assertAlmostEqual(scores["smooth"]["digits_median"], 4)
        self.assertEqual((scores["smooth"]["worst"], scores["smooth"]["cases"]), ("a", 2))
        self.assertAlmostEqual(scores["jump"]["digits_min"], 2)
        self.assertEqual((scores["all"]["worst"], scores["all"]["cases"], scores["all"]["answered"]), ("c", 3, 3))
        self.assertAlmostEqual(scores["all"]["digits_median"], 3)

    def test_color_and_opacity_apart_with_absolute_errors(self):
        self.answers["a"] = [0.5, 0.25 + 0.5e-3, 0, 0.125]
        self.answers["b"] = [0.5, 0.25, 0.5e-4, 0.125 - 0.125e-5]
        smooth = self.score(csv(self.answers))["smooth"]
        for key, right in (
            ("color_digits_min", 3), ("color_digits_median", 3.5), ("color_error_max", 0.5e-3),
            ("opacity_digits_min", 5), ("opacity_error_max", 0.125e-5),
        ):
            self.assertAlmostEqual(smooth[key], right, places=11, msg=key)
        self.assertEqual(smooth["not_finite"], 0)

    def test_one_convention(self):
        """A renderer that knows one convention is scored on its vectors; other answers are passed over."""
        document = changed(self.document, "/vectors/1/emission", "associated")
        vectors = self.write("mixed.json", document)
        self.answers["a"] = [0.5, 0.25 + 0.5e-3, 0, 0.125]
        answers = self.write("answers.csv", csv(self.answers))
        for emission, counts, worst in (("associated", {"smooth": 1, "all": 1}, "b"), ("plain", {"smooth": 1, "jump": 1, "all": 2}, "a")):
            levels = self.json_of("score", vectors, answers, "--json", "--emission", emission)
            self.assertEqual({level["level"]: level["cases"] for level in levels}, counts)
            self.assertEqual(levels[-1]["worst"], worst)
        only_b = self.write("answers.csv", csv({"b": self.answers["b"]}))
        done = self.run_program("score", vectors, only_b, "--emission", "associated")
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assert_refused(self.run_program("score", self.vectors, only_b, "--emission", "associated"), "--emission", "vectors.json", "associated")
        self.assert_refused(self.run_program("score", vectors, only_b, "--emission", "other"), "--emission", "associated", "plain")
        self.assert_refused(
            self.run_program("score", vectors, self.write("answers.csv", csv({"x": [0, 0, 0, 0]})), "--emission", "plain"), "the id 'x'"
        )

    def test_a_line_for_each_vector(self):
        self.answers["a"] = [0.5, 0.25 + 0.5e-3, 0, 0.125]
        self.answers["c"][0] = math.nan
        del self.answers["b"]
        answers = self.write("answers.csv", csv(self.answers))
        a, b, c = self.json_of("score", self.vectors, answers, "--json", "--per-vector")
        self.assertEqual([a["id"], a["level"], a["emission"], a["answered"]], ["a", "smooth", "plain", True])
        self.assertAlmostEqual(a["color_digits"], 3)
        self.assertAlmostEqual(a["color_error"], 0.5e-3)
        self.assertEqual((a["digits"], a["opacity_error"], a["error_bound"]), (a["color_digits"], 0, 1e-13))
        self.assertEqual((b["answered"], b["digits"], b["color_error"], b["opacity_digits"]), (False, None, None, None))
        self.assertEqual((c["answered"], c["digits"], c["color_digits"], c["color_error"], c["opacity_error"]), (True, 0, 0, None, 0))
        self.assertGreater(c["opacity_digits"], 10)
        header, *lines = self.output_of("score", self.vectors, answers, "--per-vector").splitlines()
        self.assertEqual(header.split(), ["id", "emission", "digits", "colour:", "digits", "error", "opacity:", "digits", "error"])
        self.assertEqual(lines[0].split()[:5], ["a", "plain", "3.00", "3.00", "5.0e-04"])
        self.assertEqual(lines[1].split(), ["b", "plain", *"-----"])
        self.assertEqual(lines[2].split()[:5], ["c", "plain", "0.00", "0.00", "-"])

    def test_second_form(self):
        """The same members, and one more, which a score does not ask."""
        answers = self.write("answers.csv", csv(self.answers))
        before = self.json_of("score", self.vectors, answers, "--json")
        second = changed(changed(self.document, "/raytruth", "vectors/2"), "/vectors/0/separate_lists", {"color": []})
        self.assertEqual(self.json_of("score", self.write("second.json", second), answers, "--json"), before)

    def test_digits_end_at_the_bound_and_at_zero(self):
        scores = self.score(csv(self.answers))
        self.assertAlmostEqual(scores["smooth"]["digits_min"], -math.log10(1e-13 / 0.125))
        self.assertAlmostEqual(scores["jump"]["digits_min"], 53 * math.log10(2))
        self.answers["c"] = [1e-9, 0, 1e300, 0.125]
        self.assertEqual(self.score(csv(self.answers))["jump"]["digits_min"], 0)

    def test_table(self):
        self.answers["a"] = [0.5, 0.25 + 0.5e-3, 0, 0.125]
        header, *lines = self.output_of("score", self.vectors, self.write("answers.csv", csv(self.answers))).splitlines()
        self.assertEqual(
            header.split(),
            ["level", "cases", "answered", "digits:", "least", "median", "colour:", "digits", "error", "opacity:", "digits", "error", "worst", "case"],
        )
        self.assertEqual([line.split()[0] for line in lines], ["smooth", "jump", "all"])
        self.assertEqual(lines[0].split()[1:4] + lines[0].split()[5:7] + lines[0].split()[8:], ["2", "2", "3.00", "3.00", "5.0e-04", "0.0e+00", "a"])

    def test_answers_from_other_programs(self):
        """Quotes, Windows line ends, blank lines, blanks, any order, as spreadsheets and scripts write them."""
        plain = self.score(csv(self.answers))
        lines = csv(dict(reversed(self.answers.items()))).splitlines()
        self.assertEqual(self.score("\r\n".join(lines)), plain)
        self.assertEqual(self.score("\n\n".join(lines) + "\n\n"), plain)
        self.assertEqual(self.score("\n".join(line.replace(",", " , ") for line in lines)), plain)
        self.assertEqual(self.score("\n".join(",".join(f'"{field}"' for field in line.split(",")) for line in lines)), plain)
        by_stream = self.json_of("score", self.vectors, "-", "--json", stdin="\n".join(lines).encode())
        self.assertEqual({level["level"]: level for level in by_stream}, plain)

    def test_answers_of_spreadsheets(self):
        """A byte order mark, semicolons or tabulators between fields, decimal commas with them, signs before numbers."""
        plain = self.score(csv(self.answers))
        self.assertEqual(self.score("\ufeff" + csv(self.answers)), plain)
        for separator, words in ((";", b"semicolons"), ("\t", b"tabulators")):
            for number in (lambda text: text, lambda text: "+" + text.replace(".", ",")):
                header, *lines = csv(self.answers).splitlines()
                rows = [[line.split(",")[0], *map(number, line.split(",")[1:])] for line in lines]
                text = "\r\n".join(separator.join(row) for row in [header.split(","), *rows])
                done = self.run_program("score", self.vectors, self.write("answers.csv", "\ufeff" + text), "--json")
                self.assertEqual({level["level"]: level for level in json.loads(done.stdout)}, plain)
                self.assertIn(b"answers.csv: read with " + words + b" between fields", done.stderr)
                self.assertEqual(b"decimal commas" in done.stderr, "," in text.replace("id,", ""))

    def test_answers_that_are_not_finite_have_no_digits(self):
        good = self.score(csv(self.answers))
        for wrong in ("nan", "NaN", "-nan", "nan(ind)", "inf", "-Infinity", "1e999", ""):
            with self.subTest(wrong=wrong):
                text = csv(self.answers).replace("b,0.5,", f"b,{wrong},")
                done = self.run_program("score", self.vectors, self.write("answers.csv", text), "--json")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stderr, b"raytruth: answers.csv: 1 of 3 answers are not finite, and count as no digits; the first is b\n")
                smooth, jump, _ = json.loads(done.stdout)
                self.assertEqual((smooth["digits_min"], smooth["worst"], smooth["answered"]), (0, "b", 2))
                self.assertEqual(jump, good["jump"])
        self.assertEqual(self.score(csv(self.answers).replace("1e-09", "1e-999"))["jump"]["digits_min"], 0)

    def test_levels_are_counted_over_what_was_answered(self):
        del self.answers["b"], self.answers["c"]
        done = self.run_program("score", self.vectors, self.write("answers.csv", csv(self.answers)), "--json")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(
            done.stderr, b"raytruth: answers.csv: no answer for 2 of 3 vectors, which are left out of the digits; the first is b\n"
        )
        smooth, jump, every = json.loads(done.stdout)
        self.assertEqual((smooth["cases"], smooth["answered"], smooth["worst"]), (2, 1, "a"))
        self.assertGreater(smooth["digits_min"], 12)
        self.assertEqual((jump["answered"], jump["digits_min"], jump["digits_median"], jump["worst"]), (0, None, None, None))
        self.assertEqual((every["answered"], every["digits_min"]), (1, smooth["digits_min"]))
        table = self.output_of("score", self.vectors, "answers.csv").splitlines()
        self.assertEqual(table[2].split(), ["jump", "1", "0", *"-------"])

    def test_help_says_how_digits_are_counted(self):
        text = self.output_of("score", "--help")
        for words in ("-log10", "error_bound", "raytruth score vectors.json answers.csv", "counted over what was answered", "--emission", "vectors/1"):
            self.assertIn(words, text)

    def test_bad_answers(self):
        good = csv(self.answers)
        for text, *words in [
            ("", "found no lines", "id,r,g,b,opacity"),
            ("\n\n", "found no lines"),
            ("a,1,1,1,1\n", "line 1: found 'a,1,1,1,1'; the header id,r,g,b,opacity is allowed"),
            ("id,r,g,b,a\n", "line 1: found 'id,r,g,b,a'"),
            ("id,r,g,b\n", "line 1: found 4 fields"),
            (good.replace("0.5,0.25,0,", "0,5,0,25,0,"), "line 2: found 7 fields; id,r,g,b,opacity (with decimal commas, semicolons between fields) is allowed"),
            (good + 'd,"0,5",0,0,0\n', "line 5: found r '0,5'; a number (with decimal commas, semicolons between fields) is allowed"),
            (good.encode("utf-16"), "found text in UTF-16"),
            (good + "d,0,0,0,0\n", "the id 'd'", "ids of vectors.json"),
            (good.replace("a,", "smooth_ray,"), "the id 'smooth_ray'"),
            (good + "a,0,0,0,0\n", "line 5: found a second answer for 'a'"),
            (good + ",0,0,0,0\n", "line 5: found no id"),
            (good + "d,0,0,0\n", "line 5: found 4 fields; id,r,g,b,opacity is allowed"),
            (good + "d,0,0,0,0,0\n", "line 5: found 6 fields"),
            (good + "d,0x1p3,0,0,0\n", "line 5: found r '0x1p3'"),
            (good.replace(",", ";") + "d;1,000.5;0;0;0\n", "line 5: found r '1,000.5'; a number is allowed"),
            (good + "d,1 2,0,0,0\n", "line 5: found r '1 2'"),
            (good + "d,0.5f,0,0,0\n", "line 5: found r '0.5f'"),
            (good + "d,0,0,0,word\n", "line 5: found opacity 'word'"),
            (good + "x" * 100000 + ",0,0,0,0\n", "..."),
            (good + "\x00\x1b,0,0,0,0\n", "line 5: "),
            (good + '"d,0,0,0,0\n', "line 5: found "),
        ]:
            with self.subTest(words=words):
                done = self.run_program("score", self.vectors, self.write("answers.csv", text))
                self.assert_refused(done, "answers.csv: ", *words)
                self.assertLess(len(done.stderr), 400)

    def test_bad_bytes_and_files(self):
        self.assert_refused(self.run_program("score", self.vectors, self.write("answers.csv", bytes(range(256)))), "answers.csv: line 1")
        self.assert_refused(self.run_program("score", self.vectors, "absent.csv"), "absent.csv: ", "a readable CSV file")
        self.assert_refused(self.run_program("score", self.vectors, "."), "a folder")
        self.assert_refused(self.run_program("score", "absent.json", "answers.csv"), "absent.json: ", "a readable JSON file")
        self.assert_refused(self.run_program("score", self.vectors), "answers")

    def test_bad_vectors(self):
        answers = self.write("answers.csv", csv(self.answers))
        for pointer, wrong, words in [
            ("/raytruth", "vectors/3", "vectors/1"),
            ("/raytruth", ..., "found nothing"),
            ("/vectors", [], "at least 1"),
            ("/colour", 1, "unknown key"),
            ("/vectors/1/colour", 1, "unknown key"),
            ("/vectors/1/id", "a", "each id once"),
            ("/vectors/1/id", "", "text"),
            ("/vectors/1/level", ..., "found nothing"),
            ("/vectors/0/reference", ..., "found nothing"),
            ("/vectors/0/reference/color", [1, 2], "3 numbers"),
            ("/vectors/0/reference/opacity", None, "a number"),
            ("/vectors/0/reference/error_bound", -1, "found -1"),
        ]:
            with self.subTest(pointer=pointer, wrong=wrong):
                vectors = self.write("bad.json", changed(self.document, pointer, wrong))
                self.assert_refused(self.run_program("score", vectors, answers), f"bad.json: {pointer}: ", words)


class AnswersOfOurOwn(ProgramTest):
    """The study `conformance`, and the same by way of `eval` and `score`."""

    def test_study_is_what_score_says_of_eval(self):
        vectors = json.loads(COMMITTED.read_text())["vectors"]
        experiment = json.loads((SOURCE / "experiments/conformance.json").read_text())
        (measure,) = experiment["measures"]
        measure["vectors"] = "vectors/2"
        cases = []
        for vector in vectors:
            if "slab" in vector:
                front, back, length = (vector["slab"][key] for key in ("front", "back", "length"))
                signal = {"kind": "piecewise_polynomial", "breaks": [0, length], "coefficients": [[front, (back - front) / length]]}
                step = length
            else:
                signal = vector["signal"]
                step = signal["breaks"][-1] / measure["intervals"]
            cases.append(
                {
                    "signal": signal,
                    **{key: vector[key] for key in ("transfer_function", "emission")},
                    "sampling": {"kind": "constant", "step": step},
                    "schemes": experiment["schemes"],
                }
            )
        answers = self.json_of("eval", "-", stdin=cases)
        rows = self.json_of("run", self.write("conformance.json", experiment))["rows"]
        first = self.json_of("run", SOURCE / "experiments/conformance.json")["rows"]
        self.assertEqual(first, json.loads((SOURCE / "results/conformance.json").read_text())["rows"])
        self.assertEqual([row for row in first if row["level"] != "all"], [row for row in rows if row["level"] in {row["level"] for row in first} - {"all"}])
        for name in experiment["schemes"]:
            schemes = {vector["id"]: answer["schemes"][name] for vector, answer in zip(vectors, answers)}
            text = csv({id: [*scheme["color"], scheme["opacity"]] for id, scheme in schemes.items()})
            scores = self.json_of("score", COMMITTED, self.write("answers.csv", text), "--json")
            keys = ("level", "cases", "answered", "worst")
            study = [row for row in rows if row["scheme"] == name]
            self.assertEqual([[score[key] for key in keys] for score in scores], [[row[key] for key in keys] for row in study])
            for score, row in zip(scores, study):
                self.assertAlmostEqual(score["digits_min"], row["digits_min"], places=3)
                self.assertAlmostEqual(score["digits_median"], row["digits_median"], places=3)


if __name__ == "__main__":
    unittest.main()
