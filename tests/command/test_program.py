"""`raytruth` itself: help, lists, volumes, streams, and plots where matplotlib is missing."""

import json
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from support import EXPERIMENT, PROGRAM, RAY, SOURCE, ProgramTest, changed

COMMANDS = ["run", "list", "eval", "render", "compare", "plot", "diff", "info", "vectors", "score"]
HEADER = b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\nspacings: 1 1 2\n\n"


class Help(ProgramTest):
    def test_version(self):
        first, *features = self.output_of("--version").splitlines()
        self.assertRegex(first, r"^raytruth \d+\.\d+\.\d+ \(.+\)$")
        patterns = (r"OpenGL: (none|osmesa|egl|osmesa, egl)", r"Python module: (yes|no)",
                    r"x86-64 levels: (x86-64-v4, x86-64-v3, )?baseline; in use: (baseline|x86-64-v3|x86-64-v4)")
        self.assertEqual(len(features), len(patterns))
        for line, pattern in zip(features, patterns):
            self.assertRegex(line, f"^{pattern}$")

    def test_every_command_has_help_with_an_example(self):
        overview = self.output_of("--help")
        for command in COMMANDS:
            self.assertIn(command, overview)
            self.assertIn(f"Example:\n  raytruth {command}", self.output_of(command, "--help"))

    def test_an_interruption_is_told(self):
        """Commands that wait for what never comes; `run` has more to say, see test_run.py."""
        for command in (["eval", "-"], ["render", "-", "-o", "image.png"], ["table", "-", "-o", "table.npy"]):
            started = subprocess.Popen([PROGRAM, *command], cwd=self.folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
            caught = re.compile(r"^SigCgt:\s*[0-9a-f]*[2367abef]$", re.MULTILINE)  # the second signal
            while not caught.search(pathlib.Path(f"/proc/{started.pid}/status").read_text()):
                time.sleep(0.01)
            started.send_signal(signal.SIGINT)
            self.assertEqual(started.wait(30), -signal.SIGINT)
            self.assertEqual(started.stderr.read(), b"\nraytruth: interrupted; what was not finished is not written\n")
            started.stdin.close()
            started.stderr.close()

    def test_misspelt(self):
        self.assert_refused(self.run_program("evla", "case.json"), "evla", "(perhaps eval)")
        self.assert_refused(self.run_program("list", "schemas"), "schemes")


class Lists(ProgramTest):
    kinds = ["signals", "fields", "transfers", "samplings", "schemes", "surfaces", "measures", "shadings", "tables", "experiments", "volumes"]

    def test_everything(self):
        everything = self.json_of("list", "--json")
        self.assertEqual(list(everything), self.kinds)
        text = self.output_of("list")
        for kind, entries in everything.items():
            self.assertEqual(self.json_of("list", kind, "--json"), entries)
            for entry in entries:
                self.assertIn(entry["name"], text)
                self.assertTrue(entry["summary"])

    def test_kinds_without_entries_say_so(self):
        (self.folder / "experiments").mkdir()
        self.assertEqual(self.output_of("list", "experiments"), "experiments: none\n")

    def test_experiments_of_the_current_folder(self):
        (self.folder / "experiments").mkdir()
        self.write("experiments/small.json", EXPERIMENT)
        self.write("experiments/other.json", {"something": "else"})
        listed = self.json_of("list", "experiments", "--json")
        self.assertEqual(listed, [{"name": "small", "summary": "Does it run?", "file": "experiments/small.json"}])


class Volumes(ProgramTest):
    def test_description(self):
        self.write("v.nrrd", HEADER + bytes(range(24)))
        description = self.json_of("info", "v.nrrd", "--json")
        self.assertEqual((description["size"], description["spacing"]), ([2, 3, 4], [1, 1, 2]))
        self.assertEqual((description["minimum"], description["maximum"], description["levels"]), (0, 23, 24))
        self.assertFalse(description["lost_first_byte"])
        text = self.output_of("info", "v", "--data", ".")
        self.assertIn("2 3 4", text)
        self.assertIn("0 .. 23", text)

    def test_sign_of_a_lost_first_byte(self):
        self.write("v.nrrd", HEADER + bytes(23) + b"\n")
        done = self.run_program("info", "v.nrrd")
        self.assertEqual(done.returncode, 0)
        self.assertIn(b"first_byte", done.stderr)
        self.assertIn(b"likely", done.stdout)

    def test_refused(self):
        self.assert_refused(self.run_program("info", "absent"), "absent")
        self.write("v.nrrd", HEADER + bytes(23))
        self.assert_refused(self.run_program("info", "v.nrrd"), "v.nrrd")
        self.write("v.nrrd", HEADER.replace(b"2 3 4", b"1048576 1048576 1") + bytes(23))
        self.assert_refused(self.run_program("info", "v.nrrd"), "v.nrrd")
        self.write("v.txt", b"")
        for name in ("./v.txt", "v.txt"):
            self.assert_refused(self.run_program("info", name), "v.txt: neither the name nor the first bytes tell the format; .nrrd, ")
        for name in ("./absent.nrrd", "absent.nrrd"):
            self.assert_refused(self.run_program("info", name), f"{name}: no such file here, and no such volume in the data folders")

    def test_names_that_are_nearly_those_of_volumes(self):
        self.write("bonsai_256.nrrd", HEADER + bytes(24))
        self.assert_refused(self.run_program("info", "bonsai", "--data", "."), "(perhaps bonsai_256; `raytruth list volumes` names all)")
        scene = {"volume": "bonsai", "camera": {}, "transfer_function": RAY["transfer_function"], "scheme": "reference"}
        done = self.run_program("render", self.write("scene.json", scene), "-o", "i.npy", environment={"RAYTRUTH_DATA": ".:absent"})
        self.assert_refused(done, "scene.json: /volume: bonsai: no such volume", "perhaps bonsai_256", "absent is no folder")

    def test_list_of_volumes(self):
        self.write("one.nrrd", HEADER + bytes(24))
        self.write("two.nrrd", b"nonsense")
        listed = [row for row in self.json_of("list", "volumes", "--json", "--data", ".") if row["file"].startswith("./")]
        self.assertEqual(listed[0], {"name": "one", "summary": "NRRD, uint8, 2 x 3 x 4", "file": "./one.nrrd"})
        self.assertTrue(listed[1]["summary"].startswith("cannot be read: ./two.nrrd: "))
        self.assertIn("one", self.output_of("list", "volumes", environment={"RAYTRUTH_DATA": str(self.folder)}))

    def test_folders_that_are_not_there_are_remarked_on(self):
        self.write("v.nrrd", HEADER + bytes(24))
        for arguments in (["info", "v.nrrd"], ["list", "volumes"], ["eval", self.write("case.json", RAY)]):
            done = self.run_program(*arguments, "--data", "absent:.")
            self.assertEqual((done.returncode, done.stderr), (0, b"raytruth: warning: --data: absent: there is no such folder\n"))
        done = self.run_program("list", "volumes", environment={"RAYTRUTH_DATA": "gone"})
        self.assertEqual((done.returncode, done.stderr), (0, b"raytruth: warning: RAYTRUTH_DATA: gone: there is no such folder\n"))

    def test_spacing_that_is_asked_for(self):
        self.write("v.nrrd", HEADER + bytes(24))
        done = self.run_program("info", "v.nrrd", "--json", "--spacing", "0.5", "1", "2")
        self.assertEqual(json.loads(done.stdout)["spacing"], [0.5, 1, 2])
        self.assertIn(b"the file states the spacing 1 1 2; 0.5 1 2, which is asked for, is taken", done.stderr)
        for wrong in (("1", "1"), ("1", "1", "0"), ("1", "1", "x")):
            self.assert_refused(self.run_program("info", "v.nrrd", "--spacing", *wrong), "--spacing")


class Streams(ProgramTest):
    def test_reader_that_stops_early(self):
        """More than a pipe holds, to a reader that is gone."""
        case = self.write("cases.json", [RAY] * 2000)
        for arguments in (["eval", case], ["list"]):
            reading, writing = os.pipe()
            os.close(reading)
            done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=writing, stderr=subprocess.PIPE)
            os.close(writing)
            self.assertEqual((done.returncode, done.stderr), (0, b""))

    def test_full_disk(self):
        for arguments in (["list"], ["--help"], ["eval", self.write("case.json", RAY)]):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 4)
            self.assertEqual(done.stderr.count(b"\n"), 1)

    def test_what_cannot_be_written_is_no_bad_input(self):
        """Exit code 4, and the name that was asked for, whatever is written beside it first."""
        self.write("case.json", RAY)
        scene = {"volume": {"kind": "random_field", "size": 8, "smoothing": 1}, "transfer_function": RAY["transfer_function"], "scheme": "reference",
                 "camera": {"eye": [30, 4, 4], "target": [3.5, 3.5, 3.5], "up": [0, 1, 0], "height": 8, "size": [4, 4]}}
        table = {"transfer_function": RAY["transfer_function"], "builder": "exact", "size": 8, "length": 1, "range": [0, 1], "format": "float32"}
        result = self.write("small.json", self.json_of("run", self.write("experiment.json", EXPERIMENT)))
        self.write("file", b"")
        for folder, why in (("absent/", "No such file or directory"), ("file/", "Not a directory")):
            for file, arguments in (("v.json", ("vectors", "-o")), ("i.npy", ("render", self.write("scene.json", scene), "-o")),
                                    ("t.npy", ("table", self.write("table.json", table), "-o")), ("l.json", ("ledger", result, "-o"))):
                with self.subTest(file=folder + file):
                    self.assert_refused(self.run_program(*arguments, folder + file), f"{folder}{file}: cannot be written: {why}", code=4)
        for arguments in (("run", "experiment.json"), ("plot", result)):
            self.assert_refused(self.run_program(*arguments, "-o", "file/out"), "file/out: cannot be written", code=4)

    def test_a_disk_that_fills_up(self):
        """Files of at most 48 KiB stand for it: exit code 4, the name that was asked for, and nothing half written."""
        table = {"transfer_function": RAY["transfer_function"], "builder": "exact", "size": 128, "length": 1, "range": [0, 1], "format": "float32"}
        self.write("table.json", table)
        limited = ["bash", "-c", 'trap "" XFSZ; ulimit -f 48; exec "$0" "$@"', PROGRAM]
        for file, arguments in (("v.json", ["vectors", "-o", "v.json"]), ("t.npy", ["table", "table.json", "-o", "t.npy"]),
                                ("./clamps.svg", ["plot", SOURCE / "results/clamps.json"])):
            with self.subTest(file=file):
                before = self.names_in_folder()
                done = subprocess.run([*limited, *arguments], cwd=self.folder, capture_output=True, timeout=300)
                self.assert_refused(done, f"raytruth: {file}: cannot be written: File too large", code=4)
                self.assertEqual(self.names_in_folder(), before)

    def test_case_from_a_pipe(self):
        read = subprocess.run(["bash", "-c", '"$0" eval <(cat)', PROGRAM], input=str(RAY).replace("'", '"').encode(),
                              stdout=subprocess.PIPE)
        self.assertEqual(read.returncode, 0)


class Plots(ProgramTest):
    def setUp(self):
        super().setUp()
        self.output_of("run", self.write("experiment.json", EXPERIMENT), "-o", ".")

    def interpreter(self, script):
        path = self.folder / "python"
        path.write_text("#!/bin/sh\n" + script)
        path.chmod(0o755)
        return {"RAYTRUTH_PYTHON": str(path)}

    def test_without_matplotlib(self):
        without = self.interpreter("echo 'no matplotlib: none' >&2; exit 3\n")
        self.assert_refused(self.run_program("plot", "small.json", environment=without), "python3-matplotlib", code=3)
        nowhere = {"RAYTRUTH_PYTHON": "/no/such/python"}
        self.assert_refused(self.run_program("plot", "small.json", environment=nowhere), "python3-matplotlib", code=3)

    def test_plot_appears_whole_or_not_at_all(self):
        fake = self.interpreter('echo half > "$5"; case "$3" in *png*) exit 0;; esac; echo Broken >&2; exit 1\n')
        before = self.names_in_folder()
        self.assert_refused(self.run_program("plot", "small.json", environment=fake), "small.json", "Broken")
        self.assertEqual(self.names_in_folder(), before)
        self.output_of("plot", "small.json", "--format", "png", "-o", "plots", environment=fake)
        self.assertEqual([path.name for path in (self.folder / "plots").iterdir()], ["small.png"])

    def test_refused(self):
        self.assert_refused(self.run_program("plot", "absent.json"), "absent.json")
        self.assert_refused(self.run_program("plot", "small.json", "--format", "gif"), "gif")
        self.write("bare.json", changed(EXPERIMENT, "/plot", ...))
        self.write("result.json", self.json_of("run", "bare.json"))
        self.assert_refused(self.run_program("plot", "result.json"), "result.json: /experiment/plot: ")


if __name__ == "__main__":
    unittest.main()
