"""README's tables are those of the committed results."""

import os
import subprocess
import sys
import unittest

SOURCE = os.environ["RAYTRUTH_SOURCE"]


class Readme(unittest.TestCase):
    def test_tables_come_from_results(self):
        script = os.path.join(SOURCE, "experiments", "readme_tables.py")
        run = subprocess.run([sys.executable, script, SOURCE, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)


if __name__ == "__main__":
    unittest.main()
