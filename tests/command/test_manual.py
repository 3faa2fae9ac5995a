"""The pages of the manual and the completions that the program writes of its own options."""

import re
import shutil
import subprocess
import unittest

from support import ProgramTest


class Written(ProgramTest):
    def output(self, *arguments):
        done = self.run_program(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return done.stdout.decode()

    def commands(self):
        """The program's commands by --help, which CLI11 writes."""
        return re.findall(r"^  (\w+) {2,}", self.output("--help").split("Subcommands:")[1], re.MULTILINE)

    def options(self, command):
        return set(re.findall(r"^  (-\w|--[\w-]+)(?:,(--[\w-]+))?", self.output(command, "--help"), re.MULTILINE))

    def bash(self, *words):
        """What is offered for the last word."""
        script = """source completion; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _raytruth; printf '%s\\n' "${COMPREPLY[@]}" """
        done = subprocess.run(["bash", "-c", script, "bash", "raytruth", *words], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.split()


class Manual(Written):
    def setUp(self):
        super().setUp()
        self.output("manual", "-o", "man1")
        self.pages = {file.name: file.read_text() for file in (self.folder / "man1").iterdir()}

    def test_every_command_has_a_page_with_all_its_options(self):
        commands = self.commands()
        self.assertGreater(len(commands), 15)
        self.assertEqual(set(self.pages), {"raytruth.1", *(f"raytruth-{command}.1" for command in commands)})
        for command in commands:
            self.assertIn(f"raytruth\\-{command}\\fR(1)", self.pages["raytruth.1"])
            page = self.pages[f"raytruth-{command}.1"].replace("\\-", "-")
            for names in self.options(command):
                for name in filter(None, names):
                    self.assertRegex(page, rf"\\fB(?:-\w, )?{name}\b", command)

    def test_man_and_mandoc_have_no_complaint(self):
        tools = {"man": ["--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z"], "mandoc": ["-T", "lint", "-W", "warning"]}
        found = [tool for tool in tools if shutil.which(tool)]
        if not found:
            self.skipTest("neither man nor mandoc is installed: the packages man-db and mandoc have them")
        for tool in found:
            for name in self.pages:
                done = subprocess.run([tool, *tools[tool], f"man1/{name}"], cwd=self.folder, capture_output=True, text=True)
                complaints = done.stderr + (done.stdout if tool == "mandoc" else "")
                if "(unknown)" in self.output("--version"):  # outside git pages have no date
                    complaints = re.sub(r".*WARNING: missing date.*\n", "", complaints)
                self.assertEqual(complaints, "", f"{tool} {name}")

    def test_mandoc_shows_what_help_says(self):
        if shutil.which("mandoc") is None:
            self.skipTest("mandoc is not installed: the package of its name has it")
        shown = subprocess.run(["mandoc", "-T", "ascii", "man1/raytruth-table.1"], cwd=self.folder, capture_output=True, text=True).stdout
        text = re.sub(r".\x08", "", shown)
        for words in ("raytruth-table - Make a pre-integration table", "raytruth table [options] case -o FILE", "--gl osmesa|egl",
                      '"builder": "exact", "size": 256', "raytruth table table.json -o table.npy"):
            self.assertIn(words, text)
        self.assertRegex(text, r"\n +2 +bad input\n")


class Completion(Written):
    def setUp(self):
        super().setUp()
        self.write("completion", self.output("completion", "bash"))

    def test_bash_offers_commands_options_and_words(self):
        self.assertEqual(self.bash("re"), ["render"])
        self.assertEqual(set(self.commands()) - set(self.bash("")), set())
        self.assertEqual(self.bash("run", "--pro"), ["--profile", "--programs"])
        self.assertEqual(self.bash("run", "--profile", ""), ["quick", "full"])
        self.assertEqual(self.bash("run", "--profile", "q"), ["quick"])
        self.assertEqual(self.bash("rules", "--language", "w"), ["wgsl"])
        self.assertEqual(self.bash("list", "sch"), ["schemes"])

    def test_bash_leaves_files_to_the_shell(self):
        (self.folder / "results").mkdir()
        self.write("scene.json", "{}")
        self.assertEqual(self.bash("render", "sc"), [])
        self.assertEqual(self.bash("render", "scene.json", "-o", "sc"), [])
        self.assertEqual(self.bash("run", "-o", "res"), ["results"])
        self.assertEqual(self.bash("run", "-j", ""), [])
        self.assertIn("-o default", (self.folder / "completion").read_text())

    def test_zsh_and_fish_take_theirs(self):
        for shell in ("zsh", "fish"):
            file = self.write(shell + "_completion", self.output("completion", shell))
            if shutil.which(shell):
                done = subprocess.run([shell, "-n", file], cwd=self.folder, capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("-l profile -x -a 'quick full'", (self.folder / "fish_completion").read_text())

    def test_a_file_is_written(self):
        self.output("completion", "fish", "-o", "written")
        self.assertEqual((self.folder / "written").read_text(), self.output("completion", "fish"))


if __name__ == "__main__":
    unittest.main()
