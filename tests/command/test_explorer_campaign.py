"""plots/explorer.html is what its sources say: its engine, built anew, answers with the same numbers."""

import os
import shutil
import subprocess
import unittest

from support import SOURCE, ProgramTest
from test_explorer import PAGE, answers_of_engine, requests


@unittest.skipUnless(PAGE.is_file(), "this tree has no plots/explorer.html")
class Rebuilt(ProgramTest):
    def test_the_engine_of_the_page_is_that_of_the_sources(self):
        if shutil.which("em++") is None:
            self.skipTest("em++ is not installed: the package emscripten has it")
        done = subprocess.run([SOURCE / "src/explorer/build.sh", self.folder / "engine", str(os.cpu_count())], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        asked = requests() + [(case, 0.3) for case, _ in requests()]
        kept = answers_of_engine(self, PAGE, asked)
        made = answers_of_engine(self, self.folder / "engine", asked)
        self.assertTrue(made == kept, "cmake --build build/release --target explorer makes the page anew")
        listed = [row["name"] for row in self.json_of("list", "schemes", "--json")]
        self.assertEqual([row["name"] for row in made["schemes"]], listed)


if __name__ == "__main__":
    unittest.main()
