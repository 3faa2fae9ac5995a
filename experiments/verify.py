"""Runs experiments again and compares what comes out with the committed results: verify.py [-j N] RAYTRUTH OUT RESULT...

Where a result names this machine's processor, compiler and flags, its rows are to be the same to their last digit; else
every number within both radii, as `raytruth diff` compares them. One line for each result; exit code 1 if one differs.
What needs something that is not on this machine, a volume or a device for shaders, is named and left out.
"""

import json
import pathlib
import subprocess
import sys

EXPERIMENTS = pathlib.Path(__file__).resolve().parent
MISSING = 3  # exit code of the program where something is not on this machine
BUILD = ("cpu", "compiler", "flags")
SHOWN = 3  # differences of a result


def absent_fields(result):
    return [f"{name}: {field['why']}" for name, field in result["fields"].items() if field.get("status") == "refused"]


def shortened(text):
    return text if len(text) <= 160 else text[:157] + "..."


def differences(raytruth, before, after):
    """Lines on rows and checks that are not the same within both radii."""
    done = subprocess.run([raytruth, "diff", before, after, "--json"], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    lines = [f"{kind} row {json.dumps(row)}" for kind in ("removed", "added") for row in found[kind]]
    lines += [f"{json.dumps(change['row'])} {change['column']}: {change['before']} -> {change['after']}" for change in found["changed"]]
    return lines + [f"check {change['bound']}: {change['before']} -> {change['after']}" for change in found["checks"]]


def first_differences(before, after):
    """The same, to the last digit."""
    lines = [f"{old['measure']}: {key}: {old.get(key)} -> {new.get(key)}" for old, new in zip(before, after) if old != new
             for key in dict.fromkeys([*old, *new]) if old.get(key) != new.get(key)]
    return lines + ([f"{len(before)} rows -> {len(after)}"] if len(before) != len(after) else [])


def verify(raytruth, out, path, jobs):
    """(whether the result stands, what to say of it)."""
    committed = json.loads(path.read_text(encoding="utf-8"))
    name = committed["experiment"]["name"]
    again = out / f"{name}.json"
    seed = str(committed["experiment"].get("seed", 1))
    done = subprocess.run(
        [raytruth, "run", EXPERIMENTS / f"{name}.json", "--seed", seed, "-o", out, *jobs], capture_output=True, text=True, check=False
    )
    if done.returncode == MISSING:
        return True, "left out: " + (done.stderr.strip().splitlines() or ["something is missing"])[-1]
    if done.returncode != 0:
        return False, f"exit code {done.returncode}: {done.stderr.strip()}"
    found = json.loads(again.read_text(encoding="utf-8"))
    if absent_fields(found) != absent_fields(committed):
        return True, "left out: " + "; ".join(absent_fields(found))
    is_same_build = all(committed["provenance"].get(key) == found["provenance"].get(key) for key in BUILD)
    lines = first_differences(committed["rows"], found["rows"]) if is_same_build else differences(raytruth, path, again)
    if not lines:
        return True, "the same to the last digit" if is_same_build else "within the radii"
    more = f"; {len(lines) - SHOWN} more" if len(lines) > SHOWN else ""
    return False, "stale: " + "; ".join(map(shortened, lines[:SHOWN])) + more


def main():
    jobs = sys.argv[1:3] if sys.argv[1] == "-j" else []
    raytruth, out, *results = sys.argv[1 + len(jobs) :]
    stand = []
    for result in map(pathlib.Path, results):
        stands, words = verify(raytruth, pathlib.Path(out), result, jobs)
        stand.append(stands)
        print(f"{result.stem}: {words}", flush=True)
    return 0 if all(stand) else 1


if __name__ == "__main__":
    sys.exit(main())
