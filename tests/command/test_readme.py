"""READMEs: their tables are those of the committed results, their links lead somewhere, their example runs, and the files that they
name are there."""

import json
import re
import subprocess
import sys
import unittest

from support import SOURCE, ProgramTest

PAGES = sorted(page for folder in ("", "experiments/", "results/", "src/**/") for page in SOURCE.glob(f"{folder}*.md"))


def text_of(page):
    return page.read_text(encoding="utf-8")


def without_code(text):
    """Without what stands in fences, in indented blocks and in backticks, where brackets are no links."""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^(    |\t).*$", "", text, flags=re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(text):
    """As GitHub makes them of headings: lower case, no punctuation, hyphens for spaces."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Readme(unittest.TestCase):
    def test_tables_come_from_results(self):
        script = SOURCE / "experiments" / "readme_tables.py"
        done = subprocess.run([sys.executable, script, SOURCE, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_is_read_in_a_minute(self):
        self.assertLessEqual((SOURCE / "README.md").stat().st_size, 9000)

    def test_commands_name_files_that_are_there(self):
        named = re.findall(r"^    .*?((?:experiments|results|tests)/[\w/.-]+)", text_of(SOURCE / "README.md"), re.MULTILINE)
        self.assertGreater(len(named), 5)
        for name in named:
            with self.subTest(name=name):
                self.assertTrue((SOURCE / name).exists())

    def test_links_lead_somewhere(self):
        self.assertGreater(len(PAGES), 6)
        for page in PAGES:
            for target in re.findall(r"\]\(([^()\s]+)\)", without_code(text_of(page))):
                if target.startswith(("http:", "https:")):
                    continue
                file, _, anchor = target.partition("#")
                aim = (page.parent / file).resolve() if file else page
                with self.subTest(page=page.name, target=target):
                    self.assertTrue(aim.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(text_of(aim)))


class ExperimentFromNothing(ProgramTest):
    """experiments/README.md."""

    def test_runs(self):
        text = text_of(SOURCE / "experiments" / "README.md")
        blocks = re.findall(r"^```json\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertEqual(len(blocks), 1)
        name = json.loads(blocks[0])["name"]
        self.output_of("run", self.write(f"{name}.json", blocks[0]), "-o", "out", "--check")
        result = json.loads((self.folder / "out" / f"{name}.json").read_text(encoding="utf-8"))
        self.assertEqual({row["status"] for row in result["rows"]}, {"ok"})
        self.assertEqual([claim["verdict"] for claim in result["published"]], ["reproduced"])
        median = {(row["scheme"], row["step"]): row["xi_p50"] for row in result["rows"]}
        gains = [f"{median[scheme, 1] / median[scheme, 0.5]:.2g}" for scheme in ("order0_mid", "order1", "order2")]
        self.assertEqual(gains, ["2", "3.4", "2.9"])  # as the page has them


class Architecture(unittest.TestCase):
    """src/README.md."""

    def test_files_to_add_to_are_there(self):
        table = text_of(SOURCE / "src" / "README.md").split("| to add |")[1].split("\n\n")[0]
        rows = table.splitlines()[2:]
        self.assertEqual(len(rows), 12)
        for row in rows:
            paths = re.findall(r"`((?:src|experiments|tests)/[^`]+|CMakeLists\.txt|\.ci/[^`]+)`", row)
            self.assertTrue(paths, row)
            for path in paths:
                # NAME and SUBJECT stand for what is new; folders have them in their names only.
                there = re.split(r"[^/]*(?:NAME|SUBJECT)", path)[0]
                with self.subTest(path=path):
                    self.assertTrue((SOURCE / there).exists())

    def test_rooms_are_the_folders(self):
        text = text_of(SOURCE / "src" / "README.md")
        named = set(re.findall(r"`(src/[\w/]+)`", text.split("\n| folder |")[1].split("\n\n")[0]))
        folders = {SOURCE / "src" / name for name in ("cmake", "experiments", "explorer", "measures", "program", "python", "raytruth")}
        folders |= {file.parent for file in (SOURCE / "src" / "raytruth").rglob("*.hpp")}
        folders |= {file.parent for file in (SOURCE / "src" / "measures").rglob("*.cpp")}
        self.assertEqual(named, {str(folder.relative_to(SOURCE)) for folder in folders})


class Notation(unittest.TestCase):
    def test_every_symbol_stands_once(self):
        symbols = []
        for row in re.findall(r"^\| ([^|]+) \|", text_of(SOURCE / "src" / "NOTATION.md"), re.MULTILINE):
            symbols += [symbol for symbol in row.split(", ") if symbol not in ("---", "word", "symbol", "letter")]
        self.assertEqual(sorted(symbols), sorted(set(symbols)))


class Errata(unittest.TestCase):
    def test_tests_that_it_names_are_there(self):
        tests = "".join(text_of(file) for file in (SOURCE / "tests" / "unit").rglob("*.cpp"))
        named = re.findall(r"`([A-Z]\w+)\.([A-Z]\w+)`", text_of(SOURCE / "src" / "ERRATA.md"))
        self.assertGreater(len(named), 20)
        for suite, name in named:
            with self.subTest(test=f"{suite}.{name}"):
                self.assertRegex(tests, rf"TEST(_F|_P)?\({suite}, {name}\)")

    def test_items_that_code_refers_to_are_there(self):
        text = text_of(SOURCE / "src" / "ERRATA.md")
        chapters = {title.split()[0]: body for title, body in re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)}
        sources = [file for suffix in ("*.hpp", "*.cpp", "*.glsl") for file in (SOURCE / "src").rglob(suffix)]
        named = {item for file in sources for item in re.findall(r"errata, (\w+) (\d+)", text_of(file))}
        self.assertGreater(len(named), 3)
        for author, number in named:
            with self.subTest(author=author, number=number):
                self.assertRegex(chapters[author], rf"(?m)^{number}\. ")


if __name__ == "__main__":
    unittest.main()
