"""The committed results that take a few seconds come out again."""

import json
import subprocess
import sys
import unittest

from support import PROGRAM, SOURCE, ProgramTest, changed

SECONDS = 5  # a result that took less is run again
SCRIPT = SOURCE / "experiments/verify.py"


def cheap_results():
    for path in sorted(SOURCE.glob("results/*.json")):
        result = json.loads(path.read_text())
        is_of_experiment = (SOURCE / "experiments" / path.name).exists()
        if is_of_experiment and result["provenance"]["seconds"] < SECONDS:
            yield path


class Results(ProgramTest):
    def verify(self, *paths):
        return subprocess.run(
            [sys.executable, SCRIPT, PROGRAM, self.folder / "again", *paths], capture_output=True, text=True, check=False
        )

    def test_cheap_ones_come_out_again(self):
        paths = list(cheap_results())
        self.assertGreaterEqual(len(paths), 10)
        done = self.verify(*paths)
        stale = [line for line in done.stdout.splitlines() if ": stale: " in line or ": exit code " in line]
        message = "results that experiments/run --update has to make again:\n  " + "\n  ".join(stale)
        self.assertEqual(done.returncode, 0, message + done.stderr)

    def test_a_changed_number_is_seen(self):
        result = json.loads((SOURCE / "results/cone_lobe.json").read_text())
        number = result["rows"][3]["l1"]
        for cpu in (result["provenance"]["cpu"], "another"):
            other = changed(changed(result, "/rows/3/l1", number * (1 + 1e-6)), "/provenance/cpu", cpu)
            done = self.verify(self.folder / self.write("cone_lobe.json", other))
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertRegex(done.stdout, r"^cone_lobe: stale: .*l1: [0-9.e-]+ -> [0-9.e-]+$")


if __name__ == "__main__":
    unittest.main()
