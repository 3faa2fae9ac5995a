"""What the scripts of defects share. A script states a Defect and has measure(), which gives [(case, expected, obtained)].

Run, it prints the defect, what is expected and obtained by the version that is installed, and whether the defect is still
there; exit code 0: no longer there, 1: still there, 3: the program is missing. `--json` prints the numbers alone.
"""

import dataclasses
import json
import pathlib
import sys
import textwrap

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER.parent))

WIDTH = 118


@dataclasses.dataclass(frozen=True)
class Defect:
    title: str
    where: str  # file and lines upstream, and the version that they are of
    what: str  # what happens, and to whom
    repair: str  # what would mend it
    quantity: str  # what the numbers below are
    tolerance: float  # by which they may differ where the defect is not there


def worst(rows):
    return max(abs(obtained - expected) for _, expected, obtained in rows)


def is_there(defect, rows):
    """Whether a case differs by more than it may. A number that is none differs."""
    return not worst(rows) <= defect.tolerance


def text_of(defect, version, rows):
    paragraphs = [defect.title, f"Where: {defect.where}", defect.what, f"A repair: {defect.repair}"]
    filled = [textwrap.fill(" ".join(paragraph.split()), WIDTH) for paragraph in paragraphs]
    width = max(len(case) for case, _, _ in rows)
    table = [f"{case:{width}}  expected {expected:9.5f}  obtained {obtained:9.5f}" for case, expected, obtained in rows]
    verdict = "still there" if is_there(defect, rows) else "no longer there"
    heading = f"{defect.quantity}, by {version}:"
    return "\n".join([*filled, "", heading, *table, f"largest difference {worst(rows):.5f}, may be {defect.tolerance:g}: {verdict}", ""])


def main(defect, version, measure):
    rows = [(case, float(expected), float(obtained)) for case, expected, obtained in measure()]
    if sys.argv[1:] == ["--json"]:
        print(json.dumps({"version": version, "rows": rows}))
    else:
        print(text_of(defect, version, rows), end="")
    sys.exit(is_there(defect, rows))
