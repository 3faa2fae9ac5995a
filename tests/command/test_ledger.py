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
        self.assertEqual(names, [claim["claim"] for claim in CLAIMS if claim.get("kind") != "finding"] + own)
        for row in ledger["rows"]:
            judged = row["claim"] in own
            self.assertEqual(row["status"], "ok" if judged else "refused")
            self.assertEqual(row["verdict"] == "not measured", not judged)
            self.assertTrue(row["why"] or judged)

    def test_a_claim_of_several_parts_counts_once(self):
        result = self.json_of("run", self.write("experiment.json", EXPERIMENT))
        part = next(claim for claim in result["published"] if claim["verdict"] == "reproduced")

        def joint(*verdicts, kinds=()):
            kinds = kinds or ["claim"] * len(verdicts)
            parts = zip(verdicts, kinds)
            published = [dict(part, part=str(i), verdict=verdict, kind=kind) for i, (verdict, kind) in enumerate(parts)]
            self.write("parts.json", dict(result, published=published))
            (found,) = {row["claim_verdict"] for row in self.ledger_of("parts.json")["rows"]
                        if row["claim"] == part["claim"] and row["kind"] != "finding"} or {None}
            return found

        self.assertEqual(joint("reproduced", "reproduced"), "reproduced")
        self.assertEqual(joint("reproduced", "contradicted"), "mixed")
        self.assertEqual(joint("reproduced", "compatible"), "compatible")
        self.assertEqual(joint("contradicted", "compatible"), "mixed")
        self.assertEqual(joint("contradicted", "not comparable"), "contradicted")
        self.assertEqual(joint("not comparable"), "not comparable")
        self.assertEqual(joint("reproduced", "not found", kinds=["claim", "finding"]), "reproduced")

    def test_every_committed_claim_says_what_decides(self):
        for row in json.loads((SOURCE / "results/ledger.json").read_text())["rows"]:
            with self.subTest(claim=row["claim"], part=row["part"]):
                self.assertNotIn(row["verdict"], ("not found",))
                if row["verdict"] in ("reproduced", "compatible", "contradicted"):
                    self.assertTrue(row["criterion"] and row["column"] and row["range"] and row["text"] and row["place"])
                    self.assertIsNotNone(row["unit"])

    def test_the_committed_ledger_is_that_of_the_committed_results(self):
        committed = json.loads((SOURCE / "results/ledger.json").read_text())
        self.assertEqual(self.ledger_of(*self.committed_results())["rows"], committed["rows"])

    def test_the_page_holds_every_claim_and_needs_nothing_else(self):
        plots = str(SOURCE / "plots")
        self.output_of("ledger", *self.committed_results(), "-o", "ledger.json", "--page", "page.html", "--plots", plots)
        page = (self.folder / "page.html").read_text()
        for claim in CLAIMS:
            self.assertIn(f'<article id="{claim["claim"]}"', page)
        self.assertIsNone(re.search(r'src="', page))
        for target in set(re.findall(r'href="([^"]*)"', page)):
            if target.startswith("#"):
                self.assertIn(f'id="{target[1:]}"', page)
            else:
                self.assertTrue((SOURCE / "plots" / target).resolve().is_file(), target)
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
