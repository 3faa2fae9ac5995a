"""`raytruth run`: results, bounds, interruption, and what it refuses."""

import json
import os
import pty
import signal
import subprocess
import time
import unittest

from support import EXPERIMENT, PROGRAM, SOURCE, STUDY, ProgramTest, changed

VOLUME = {"name": "absent", "kind": "volume", "volume": "no_such_volume"}


def rows_text(result):
    """The bytes of a result from its rows on."""
    return result.partition('\n  "rows": [')[2]


class Results(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("small.json", EXPERIMENT)

    def result(self, *arguments, document=None, **options):
        if document is not None:
            self.write("small.json", document)
        return self.json_of("run", "small.json", *arguments, **options)

    def test_shape(self):
        result = self.result()
        self.assertEqual(result["raytruth"], "result/1")
        self.assertEqual([row["measure"] for row in result["rows"]], (["signal_error"] * 3 + ["cell_cubic"]) * 2)
        for row in result["rows"]:
            self.assertEqual((row["status"], row["why"]), ("ok", None))
            self.assertLessEqual(set(row), set(result["columns"]))
        self.assertEqual(result["provenance"]["profile"], "full")
        self.assertEqual(result["experiment"]["seed"], 1)
        self.assertNotIn("quick", result["experiment"])
        self.assertEqual(result["fields"]["white"]["size"], [16, 16, 16])
        self.assertEqual(set(result["styles"]), set(EXPERIMENT["schemes"]))

    def test_every_row_is_a_line(self):
        text = self.output_of("run", "small.json")
        lines = [line.strip().rstrip(",") for line in text.splitlines()]
        for row in json.loads(text)["rows"]:
            self.assertIn(json.dumps(row, separators=(",", ":")), lines)

    def test_same_rows_on_one_and_two_threads(self):
        self.assertEqual(*(rows_text(self.output_of("run", "small.json", "-j", j)) for j in "12"))

    def test_seed_decides(self):
        one = self.result()
        self.assertEqual(self.result("--seed", "1")["rows"], one["rows"])
        other = self.result("--seed", "2")
        self.assertEqual(other["experiment"]["seed"], 2)
        self.assertNotEqual(other["rows"], one["rows"])

    def test_defaults_are_filled_in(self):
        document = changed(changed(EXPERIMENT, "/samplings", ...), "/fields/0/smoothing", ...)
        result = self.result(document=document)
        self.assertEqual(result["experiment"]["samplings"], [{"kind": "cells"}])
        self.assertEqual(result["experiment"]["fields"][0]["smoothing"], 0)
        self.assertEqual(result["rows"], self.result(document=EXPERIMENT)["rows"])

    def test_verdicts(self):
        claims = {claim["claim"]: claim for claim in self.result()["published"]}
        figure = claims["figure"]
        self.assertTrue(figure["low"] < figure["measured"] < figure["high"])
        self.assertEqual(figure["verdict"], "reproduced")
        self.assertEqual(claims["sentence"]["verdict"], "reproduced")
        elsewhere = claims["elsewhere"]
        self.assertEqual((elsewhere["verdict"], elsewhere["why"]), ("not comparable", "needs their hardware"))

        wrong = changed(changed(EXPERIMENT, "/published/0/stated", 7), "/published/1/test/at_most", 0)
        verdicts = [claim["verdict"] for claim in self.result(document=wrong)["published"]]
        self.assertEqual(verdicts, ["contradicted", "contradicted", "not comparable"])

    def test_half_a_printed_digit_counts(self):
        figure = changed(changed(EXPERIMENT, "/published/0/low", ...), "/published/0/high", ...)
        measured = self.result(document=figure)["published"][0]["measured"]
        for offset, verdict in [(0.0049, "reproduced"), (-0.0049, "reproduced"), (0.0051, "contradicted")]:
            document = changed(changed(figure, "/published/0/stated", measured + offset), "/published/0/resolution", 0.01)
            self.assertEqual(self.result(document=document)["published"][0]["verdict"], verdict)

    def test_table_of_claims(self):
        done = self.run_program("run", "small.json")
        table = done.stderr.decode().splitlines()
        self.assertEqual(table[0].split(), ["claim", "published", "measured", "verdict"])
        self.assertEqual(len(table), 6)
        self.assertRegex(table.pop(), r"^raytruth: small: \d+ rows$")
        self.assertEqual(table.pop(), "raytruth: small: 1 of 1 checks hold")
        self.assertTrue(table[1].startswith("figure") and table[1].endswith("reproduced"))
        self.assertEqual(len({line.index(word) for line, word in zip(table, ["verdict", "reproduced", "reproduced", "not"])}), 1)

    def test_quick_runs_say_that_they_have_no_verdicts(self):
        words = self.run_program("run", "small.json", "--profile", "quick").stderr.decode().splitlines()
        self.assertEqual(len(words), 3)
        self.assertIn("no verdicts", words[0])
        self.assertIn("1 of 1 checks hold", words[1])
        self.assertRegex(words[2], r"^raytruth: small: \d+ rows$")

    def test_says_where_nothing_is_claimed(self):
        self.write("small.json", changed(changed(EXPERIMENT, "/published", []), "/checks", []))
        done = self.run_program("run", "small.json")
        rows = len(json.loads(done.stdout)["rows"])
        self.assertEqual(done.stderr.decode(), f"raytruth: small: no publication claims anything of it\nraytruth: small: {rows} rows\n")

    def test_says_what_was_made_and_what_draws_it(self):
        self.write("small.json", EXPERIMENT)
        done = self.run_program("run", "small.json", "-o", "out")
        rows = len(json.loads((self.folder / "out/small.json").read_text())["rows"])
        last = done.stderr.decode().splitlines()[-1]
        self.assertEqual(last, f"raytruth: small: {rows} rows in out/small.json; to draw them: raytruth plot out/small.json -o out")
        self.assertEqual(self.run_program(*last.split(" raytruth ")[1].split()).returncode, 0)
        without = changed(EXPERIMENT, "/plot", ...)
        self.write("small.json", without)
        done = self.run_program("run", "small.json", "-o", "out")
        self.assertTrue(done.stderr.decode().endswith(f" {rows} rows in out/small.json\n"))

    def test_says_how_many_rows_have_no_values_and_why(self):
        self.write("small.json", changed(EXPERIMENT, "/fields/2", VOLUME))
        done = self.run_program("run", "small.json", "-o", "out")
        rows = json.loads((self.folder / "out/small.json").read_text())["rows"]
        refused = [row["why"] for row in rows if row["status"] != "ok"]
        self.assertGreater(len(refused), 1)
        self.assertEqual(len(set(refused)), 1)
        self.assertIn(f"{len(rows)} rows, {len(refused)} without values ({refused[0]}) in", done.stderr.decode().splitlines()[-1])

    def test_other_rows_answer_where_a_volume_is_absent(self):
        document = changed(EXPERIMENT, "/fields/2", VOLUME)
        document = changed(document, "/checks/0/rows/field", ["absent"])
        document = changed(document, "/published/1/rows/field", "absent")
        self.assertFalse(self.result(document=document)["checks"][0]["holds"])
        self.assertIn(b"nothing to measure: continuous", self.run_program("run", "small.json").stderr)
        other = {"measure": "cell_cubic", "field": "white"}
        document = changed(changed(document, "/checks/0/otherwise", other), "/published/1/otherwise", other)
        result = self.result(document=document)
        self.assertEqual((result["checks"][0]["holds"], result["published"][1]["verdict"]), (True, "reproduced"))
        for said in (result["checks"][0], result["published"][1]):
            self.assertEqual(said["why"], "all rows of absent are refused: these are of white")
        # The quick version has other fields: what answers otherwise is all that is left.
        quick = changed(document, "/quick/fields", EXPERIMENT["fields"])
        quick = self.result("--profile", "quick", document=quick)["experiment"]
        self.assertEqual(quick["checks"][0]["rows"], other)
        self.assertNotIn("otherwise", quick["checks"][0])

    def test_bounds(self):
        result = self.result("--check")
        self.assertEqual([check["holds"] for check in result["checks"]], [True])
        self.assertEqual((result["checks"][0]["measured"], result["checks"][0]["limit"]), (0, 0))
        self.write("small.json", changed(EXPERIMENT, "/checks/0/at_most", -1))
        done = self.run_program("run", "small.json", "--check")
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"continuous", done.stderr)
        self.assertFalse(json.loads(done.stdout)["checks"][0]["holds"])
        self.assertEqual(self.run_program("run", "small.json").returncode, 0)

    def test_worst_row_decides(self):
        check = {"bound": "x", "rows": {"measure": "signal_error"}, "column": "xi_p50", "at_least": 0}
        result = self.result(document=changed(EXPERIMENT, "/checks/1", check))
        smallest = min(row["xi_p50"] for row in result["rows"] if row["measure"] == "signal_error")
        self.assertEqual(result["checks"][1]["measured"], smallest)

    def test_quick_profile(self):
        quick = self.result("--profile", "quick")
        self.assertEqual(quick["experiment"]["rays"], {"count": 16, "length": 4})
        self.assertEqual(quick["provenance"]["profile"], "quick")

    def test_quick_profile_drops_what_is_said_of_rows_it_has_not(self):
        document = changed(EXPERIMENT, "/quick/fields", [EXPERIMENT["fields"][1]])
        quick = self.result("--profile", "quick", document=document)
        self.assertEqual([claim["claim"] for claim in quick["published"]], ["sentence", "elsewhere"])
        self.assertEqual(quick["experiment"]["checks"][0]["rows"]["field"], ["smooth"])
        self.assertEqual([check["holds"] for check in quick["checks"]], [True])
        self.assertIn("plot", quick["experiment"])
        document = changed(document, "/plot/panels/0/rows/field", "white")
        self.assertNotIn("plot", self.result("--profile", "quick", document=document)["experiment"])

    def test_absent_volume_refuses_its_rows_only(self):
        document = changed(EXPERIMENT, "/fields/2", VOLUME)
        document = changed(document, "/published/0/row/field", "absent")
        document = changed(document, "/checks/0/rows", {"measure": "cell_cubic"})
        whole = self.result(document=EXPERIMENT)
        self.write("small.json", document)
        done = self.run_program("run", "small.json", "--check")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"no_such_volume", done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual(result["rows"][: len(whole["rows"])], whole["rows"])
        refused = result["rows"][len(whole["rows"]) :]
        self.assertEqual([(row["measure"], row["field"], row["status"]) for row in refused],
                         [("signal_error", "absent", "refused"), ("cell_cubic", "absent", "refused")])
        self.assertIn("no_such_volume", refused[0]["why"])
        self.assertEqual(result["published"][0]["verdict"], "not comparable")
        self.assertIn("no_such_volume", result["published"][0]["why"])
        self.assertEqual(result["fields"]["absent"]["status"], "refused")

    def test_volume_is_scaled_by_its_extremes(self):
        header = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n"
        self.write("v.nrrd", header + bytes(20 + i % 200 for i in range(511)) + b"\n")
        document = changed(EXPERIMENT, "/fields/1", {"name": "smooth", "kind": "volume", "volume": "v.nrrd"})
        self.write("small.json", document)
        done = self.run_program("run", "small.json")
        self.assertIn(b"first_byte", done.stderr)
        row = [row for row in json.loads(done.stdout)["rows"] if row["field"] == "smooth"][0]
        self.assertEqual((row["data_min"], row["data_max"]), (10, 219))
        repaired = self.run_program("run", self.write("small.json", changed(document, "/fields/1/repair", "first_byte")))
        self.assertNotIn(b"first_byte", repaired.stderr)
        field = json.loads(repaired.stdout)["fields"]["smooth"]
        self.assertEqual((field["data_min"], field["file"], field["repaired"]), (0, "v.nrrd", True))

    def test_constant_volume(self):
        header = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 8 8 8\nencoding: raw\n\n"
        self.write("v.nrrd", header + bytes(512))
        document = changed(EXPERIMENT, "/fields/1", {"name": "smooth", "kind": "volume", "volume": "v.nrrd"})
        row = [row for row in self.result(document=document)["rows"] if row["field"] == "smooth"][0]
        self.assertEqual((row["rays_constant"], row["xi_p50"]), (64, None))


class Files(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("small.json", EXPERIMENT)

    def test_result_appears_whole_in_the_folder(self):
        self.output_of("run", "small.json", "-o", "new/out")
        folder = self.folder / "new/out"
        self.assertEqual([path.name for path in folder.iterdir()], ["small.json"])
        self.assertEqual(json.loads((folder / "small.json").read_text())["rows"], self.json_of("run", "small.json")["rows"])

    def test_several_experiments_need_a_folder(self):
        self.write("other.json", changed(EXPERIMENT, "/name", "other"))
        self.assert_refused(self.run_program("run", "small.json", "other.json"), "-o")
        self.output_of("run", "small.json", "other.json", "-o", "out")
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), ["other.json", "small.json"])
        self.assert_refused(self.run_program("run", "small.json", "small.json", "-o", "out"), "/name")

    def test_nothing_is_written_where_one_experiment_is_bad(self):
        self.write("bad.json", changed(EXPERIMENT, "/rays/count", 0))
        self.assert_refused(self.run_program("run", "small.json", "bad.json", "-o", "out"), "bad.json: /rays/count: ")
        self.assertFalse((self.folder / "out").exists())

    def test_an_experiment_is_not_overwritten_by_its_result(self):
        self.assert_refused(self.run_program("run", "small.json", "-o", "."), "small.json", "another folder")

    def test_output_that_cannot_be_written(self):
        self.assert_refused(self.run_program("run", "small.json", "-o", "small.json"), "small.json", code=4)
        self.assert_refused(self.run_program("run", "small.json", "-o", "/proc/out"), "/proc/out", code=4)
        full = subprocess.run([PROGRAM, "run", "small.json"], cwd=self.folder, stdout=open("/dev/full", "wb"), stderr=subprocess.PIPE)
        self.assertEqual(full.returncode, 4)
        self.assertIn(b"standard output", full.stderr)

    def test_resume_after_a_kill_gives_the_same_rows(self):
        # So many rays that the run lasts for seconds; the second field is never reached before the first is done.
        self.write("small.json", changed(EXPERIMENT, "/rays/count", 20000))
        journal = self.folder / "out/.small.journal"
        running = subprocess.Popen([PROGRAM, "run", "small.json", "-o", "out", "-j", "1"], cwd=self.folder, stderr=subprocess.DEVNULL)
        while running.poll() is None and not (journal.exists() and len(journal.read_bytes().splitlines()) >= 2):
            time.sleep(0.002)
        self.assertIsNone(running.poll(), "the run was too fast to be interrupted")
        running.send_signal(signal.SIGINT)
        self.assertNotEqual(running.wait(), 0)
        self.assertFalse((self.folder / "out/small.json").exists())
        with journal.open("ab") as file:
            file.write(b'{"name":"white/cell_cubic","part":{"fie')  # half a line
        resumed = self.run_program("run", "small.json", "-o", "out", "--resume")
        self.assertEqual(resumed.returncode, 0, resumed.stderr)
        self.assertFalse(journal.exists())
        text = (self.folder / "out/small.json").read_text()
        self.assertTrue(json.loads(text)["provenance"]["resumed"])
        self.assertEqual(rows_text(text), rows_text(self.output_of("run", "small.json")))

    def test_ctrl_c_names_what_goes_on(self):
        self.write("small.json", changed(EXPERIMENT, "/rays/count", 2000000))
        for arguments, words in [(["-o", "out", "-j", "1"], "raytruth run small.json -j 1 -o out --resume"), (["-j", "1"], "-o DIR")]:
            running = subprocess.Popen([PROGRAM, "run", "small.json", *arguments], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            time.sleep(0.5)
            running.send_signal(signal.SIGINT)
            said = running.communicate()[1].decode()
            self.assertEqual(running.returncode, -signal.SIGINT)
            self.assertEqual(said.count("\n"), 2)
            self.assertIn(words, said)

    def test_an_experiment_is_found_by_its_name(self):
        (self.folder / "experiments").mkdir()
        (self.folder / "small.json").rename(self.folder / "experiments/small.json")
        done = self.run_program("run", "small", "-o", "out")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"raytruth: small: experiments/small.json\n", done.stderr)
        self.assertIn("experiments, in experiments\n", self.output_of("list", "experiments"))
        self.assert_refused(self.run_program("run", "smal"), "smal: no such file", "experiments (perhaps small)")
        # Elsewhere those of the source tree that the program was built in are at hand.
        elsewhere = self.folder / "out"
        listed = subprocess.run([PROGRAM, "list", "experiments", "--json"], cwd=elsewhere, stdout=subprocess.PIPE)
        for entry in json.loads(listed.stdout):
            self.assertTrue((elsewhere / entry["file"]).is_file())
        found = subprocess.run([PROGRAM, "run", "spheres", "--profile", "quick"], cwd=elsewhere, capture_output=True)
        self.assertEqual(found.returncode, 0, found.stderr)

    def test_resume_leaves_a_finished_result_alone(self):
        self.output_of("run", "small.json", "-o", "out")
        before = (self.folder / "out/small.json").read_bytes()
        self.output_of("run", "small.json", "-o", "out", "--resume")
        self.assertEqual((self.folder / "out/small.json").read_bytes(), before)
        self.output_of("run", "small.json", "-o", "out", "--resume", "--seed", "5")
        self.assertNotEqual((self.folder / "out/small.json").read_bytes(), before)

    def test_journal_of_another_experiment_is_not_used(self):
        (self.folder / "out").mkdir()
        self.write("out/.small.journal", '{"raytruth":"journal/1"}\n{"name":"white/cell_cubic","part":{}}\n')
        done = self.run_program("run", "small.json", "-o", "out", "--resume")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"starting afresh", done.stderr)

    def test_resume_needs_a_folder(self):
        self.assert_refused(self.run_program("run", "small.json", "--resume"), "-o")

    def test_progress_bar_on_a_terminal_only(self):
        self.assertNotIn(b"elapsed", self.run_program("run", "small.json").stderr)
        leader, terminal = pty.openpty()
        subprocess.run([PROGRAM, "run", "small.json"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = os.read(leader, 100000).decode()
        os.close(leader)
        self.assertIn("3/4", shown)
        self.assertIn("elapsed", shown)


class Refusals(ProgramTest):
    row = "/published/0/row"
    bad = [
        (changed(EXPERIMENT, "/raytruth", "experiment/2"), "/raytruth", "experiment/1"),
        (changed(EXPERIMENT, "/raytruth", ...), "/raytruth", "nothing"),
        (changed(EXPERIMENT, "/naem", "x"), "/naem", "perhaps name"),
        (changed(EXPERIMENT, "/name", "a/b"), "/name", "letters"),
        (changed(EXPERIMENT, "/name", "../up"), "/name", "letters"),
        (changed(EXPERIMENT, "/question", ""), "/question", "not empty"),
        (changed(EXPERIMENT, "/seed", -1), "/seed", "found -1"),
        (changed(EXPERIMENT, "/seed", 1.5), "/seed", "found 1.5"),
        (changed(EXPERIMENT, "/seed", 2**64), "/seed", "found 1.8"),
        (changed(EXPERIMENT, "/fields", []), "/fields", "at least 1"),
        (changed(EXPERIMENT, "/fields/1/name", "white"), "/fields/1/name", "each name once"),
        (changed(EXPERIMENT, "/fields/0/kind", "noise"), "/fields/0/kind", "random_field"),
        (changed(EXPERIMENT, "/fields/0/size", 0), "/fields/0/size", "found 0"),
        (changed(EXPERIMENT, "/fields/0/size", 10**9), "/fields/0/size", "2048"),
        (changed(EXPERIMENT, "/fields/0/smoothing", 17), "/fields/0/smoothing", "16"),
        (changed(EXPERIMENT, "/fields/0/volume", "x"), "/fields/0/volume", "unknown key"),
        (changed(EXPERIMENT, "/fields/0", {"name": "m", "kind": "marschner_lobb", "samples": 1}), "/fields/0/samples", "2"),
        (changed(EXPERIMENT, "/fields/0", {**VOLUME, "repair": "last"}), "/fields/0/repair", "first_byte"),
        (changed(EXPERIMENT, "/rays/count", 0), "/rays/count", "found 0"),
        (changed(EXPERIMENT, "/rays/length", 0), "/rays/length", "> 0"),
        (changed(EXPERIMENT, "/samplings", []), "/samplings", "at least 1"),
        (changed(EXPERIMENT, "/samplings/1", {"kind": "cells"}), "/samplings/1", "once"),
        (changed(EXPERIMENT, "/schemes/0", "order9"), "/schemes/0", "order1"),
        (changed(EXPERIMENT, "/schemes/1", "order0_mid"), "/schemes/1", "once"),
        (changed(EXPERIMENT, "/schemes/0", "virtual_catmull_rom"), "/measures/0", "constant step"),
        (changed(EXPERIMENT, "/measures", []), "/measures", "at least 1"),
        (changed(EXPERIMENT, "/measures/1/kind", "signal_eror"), "/measures/1/kind", "perhaps signal_error"),
        (changed(EXPERIMENT, "/measures/1/ratios", []), "/measures/1/ratios", "unknown key"),
        (changed(EXPERIMENT, "/published/0/verdict", "reproduced"), "/published/0/verdict", "unknown key"),
        (changed(EXPERIMENT, "/published/0/resolution", ...), "/published/0/resolution", "nothing"),
        (changed(EXPERIMENT, "/published/0/measured", "xi_p51"), "/published/0/measured", "perhaps xi_p50"),
        (changed(EXPERIMENT, "/published/1/claim", "figure"), "/published/1/claim", "once"),
        (changed(EXPERIMENT, "/published/1/test/at_least", 1e9), "/published/1/test", "at_least <= at_most"),
        (changed(EXPERIMENT, "/published/1/test/at_most", ...), "/published/1/test/at_most", "nothing"),
        (changed(EXPERIMENT, "/published/1/criterion", "taste"), "/published/1/criterion", "same image"),
        (changed(EXPERIMENT, "/published/1/kind", "opinion"), "/published/1/kind", "finding"),
        (changed(EXPERIMENT, "/published/2/why", ...), "/published/2/why", "nothing"),
        (changed(EXPERIMENT, row + "/field", "black"), row + "/field", "white"),
        (changed(EXPERIMENT, row + "/colour", 1), row + "/colour", "column"),
        (changed(EXPERIMENT, row, {}), row, "at least one"),
        (changed(EXPERIMENT, "/checks/0/rows/field/0", "black"), "/checks/0/rows/field/0", "white"),
        (changed(EXPERIMENT, "/checks/0/at_most", ...), "/checks/0/at_most", "nothing"),
        (changed(EXPERIMENT, "/checks/0/column", "xi"), "/checks/0/column", "one of"),
        (changed(EXPERIMENT, "/plot/panels/0/kind", "pie"), "/plot/panels/0/kind", "quantiles"),
        (changed(EXPERIMENT, "/plot/panels/0/colour", 1), "/plot/panels/0/colour", "unknown key"),
        (changed(EXPERIMENT, "/plot/panels", []), "/plot/panels", "at least 1"),
        (changed(EXPERIMENT, "/quick", []), "/quick", "object"),
        ([EXPERIMENT], "/", "an object"),
        (changed(STUDY, "/transfer_functions", ...), "/emission", "transfer_functions beside it"),
        (changed(changed(STUDY, "/transfer_functions", ...), "/emission", ...), "/", "transfer_functions"),
        (changed(STUDY, "/transfer_functions/1/name", "tent"), "/transfer_functions/1/name", "each name once"),
        (changed(STUDY, "/transfer_functions/0/kind", "tend"), "/transfer_functions/0/kind", "perhaps tent"),
        (changed(STUDY, "/transfer_functions/0/optical_depth", -1), "/transfer_functions/0/optical_depth", "0"),
        (changed(STUDY, "/transfer_functions/1/transfer_function/points/1/s", -1), "/transfer_functions/1/transfer_function/points/1", "sorted"),
        (changed(STUDY, "/transfer_functions/1/transfer_function/points/1/extinction", 1e300), "/transfer_functions/1/transfer_function", "2^500"),
        (changed(STUDY, "/emission", "glowing"), "/emission", "associated"),
        (changed(STUDY, "/schemes/0", "riemann_mid"), "/schemes/0", "order0_mid"),
        (changed(STUDY, "/measures/2/counts", [64, 8]), "/measures/2/counts/1", "65"),
        (changed(STUDY, "/measures/3/shapes/0", "points"), "/measures/3/shapes/0", "ramp"),
        (changed(STUDY, "/checks/0/rows/transfer", "ramp"), "/checks/0/rows/transfer", "tent"),
    ]

    def test_place_and_reason_in_one_line(self):
        for document, pointer, words in self.bad:
            with self.subTest(pointer=pointer, words=words):
                file = self.write("small.json", document)
                self.assert_refused(self.run_program("run", file), f"small.json: {pointer}: ", words)

    def test_rays_that_do_not_fit(self):
        file = self.write("small.json", changed(EXPERIMENT, "/rays/length", 40))
        self.assert_refused(self.run_program("run", file), "small.json: ", "length 40")

    def test_bad_quick_version(self):
        file = self.write("small.json", changed(EXPERIMENT, "/quick/rays/count", 0))
        self.assert_refused(self.run_program("run", file, "--profile", "quick"), "/rays/count: found 0")

    def test_command_line(self):
        self.write("small.json", EXPERIMENT)
        for arguments in [["run"], ["run", "small.json", "-j", "0"], ["run", "small.json", "-j", "x"], ["run", "small.json", "--profile", "slow"],
                          ["run", "small.json", "--seed", "-1"], ["run", "small.json", "--frob"], ["run", "small.json", "-o"], ["rnu"], []]:
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_program(*arguments), "command line")


class CommittedExperiments(ProgramTest):
    def test_name_is_the_stem(self):
        for path in sorted(SOURCE.glob("experiments/*.json")):
            self.assertEqual(json.loads(path.read_text())["name"], path.stem)

    def test_quick_version_runs_with_the_same_bytes_on_one_and_two_threads(self):
        for path in sorted(SOURCE.glob("experiments/*.json")):
            with self.subTest(experiment=path.stem):
                results = [self.output_of("run", path, "--profile", "quick", "--check", "-j", j) for j in "12"]
                self.assertEqual(*map(rows_text, results))


if __name__ == "__main__":
    unittest.main()
