"""`raytruth ledger`: every claim appears, and the committed ledger is that of the committed results."""

import json
import re
import shutil
import subprocess
import unittest

from support import EXPERIMENT, SOURCE, ProgramTest
from test_schemas import validator

CLAIMS = json.loads((SOURCE / "src/experiments/claims.json").read_text())["claims"]
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Ledger(ProgramTest):
    def ledger_of(self, *arguments):
        self.output_of("ledger", *arguments, "-o", "ledger.json")
        return json.loads((self.folder / "ledger.json").read_text())

    def committed_results(self):
        files = sorted(SOURCE.glob("results/*.json"))
        return [str(file) for file in files if file.stem not in ("ledger", "vectors")]

    def test_every_claim_has_a_row_and_an_unknown_one_comes_last(self):
        self.write("small.json", self.json_of("run", self.write("experiment.json", EXPERIMENT)))
        ledger = self.ledger_of("small.json")
        self.assertTrue(validator("result").is_valid(ledger))
        names = list(dict.fromkeys(row["claim"] for row in ledger["rows"]))
        own = list(dict.fromkeys(claim["claim"] for claim in EXPERIMENT["published"]))
        self.assertEqual(names, [claim["claim"] for claim in CLAIMS] + own)
        for row in ledger["rows"]:
            judged = row["claim"] in own
            self.assertEqual(row["status"], "ok" if judged else "refused")
            self.assertEqual(row["verdict"] == "not measured", not judged)
            self.assertTrue(row["why"] or judged)

    def test_the_committed_ledger_is_that_of_the_committed_results(self):
        committed = json.loads((SOURCE / "results/ledger.json").read_text())
        self.assertEqual(self.ledger_of(*self.committed_results())["rows"], committed["rows"])

    def test_the_page_holds_every_claim_and_needs_nothing_else(self):
        plots = str(SOURCE / "plots")
        self.output_of("ledger", *self.committed_results(), "-o", "ledger.json", "--page", "page.html", "--plots", plots)
        page = (self.folder / "page.html").read_text()
        for claim in CLAIMS:
            self.assertIn(f"<h3>{claim['claim']}", page)
        self.assertIsNone(re.search(r'(src|href)="', page))
        self.assertEqual(page, (SOURCE / "plots/ledger.html").read_text().replace(*self.commits(page)))

    def commits(self, page):
        """The commit that built the committed page, and that of this program."""
        find = re.compile(r"Raytruth \S+, commit \S+")
        return find.search((SOURCE / "plots/ledger.html").read_text())[0], find.search(page)[0]

    @unittest.skipUnless(BROWSER, "no Chromium is installed")
    def test_a_browser_shows_the_page(self):
        url = (SOURCE / "plots/ledger.html").as_uri()
        command = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=390,844", "--dump-dom", url]
        dom = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60).stdout
        self.assertGreaterEqual(dom.count("<article"), len(CLAIMS))

    def test_bad_input_is_one_line(self):
        for arguments in (["absent.json"], [self.write("other.json", {"raytruth": "case/1"})]):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_program("ledger", *arguments, "-o", "ledger.json"))
        self.assert_refused(self.run_program("ledger"))  # no results/ here


if __name__ == "__main__":
    unittest.main()
