"""Fills README's tables from results/ alone: readme_tables.py REPOSITORY [--check]. With --check nothing is written, and
the exit code is 1 if a table is not what the results say."""

import json
import pathlib
import re
import sys


def number(value):
    return f"{value:.4g}" if isinstance(value, (int, float)) else str(value)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def published(results):
    rows = []
    for file in sorted(results.glob("*.json")):
        for claim in json.loads(file.read_text(encoding="utf-8"))["published"]:
            measured = "-"
            if claim["measured"] is not None:
                measured = f"{number(claim['measured'])} ({number(claim['low'])} to {number(claim['high'])})"
            name = claim["claim"] + (f" ({claim['part']})" if "part" in claim else "")
            rows.append([name, number(claim["stated"]), measured, claim["verdict"], f"[{file.stem}](results/{file.name})"])
    return table(["claim", "published", "measured (low to high)", "verdict", "experiment"], rows)


def benchmarks(results):
    rows = []
    for file in sorted(results.glob("benchmarks/*.json")):
        for entry in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
            if entry.get("aggregate_name") == "median" and "speedup" in entry:
                name = entry["run_name"].removesuffix("/manual_time").replace("_", " ")
                rows.append([name, f"{entry['speedup']:.3g}", f"{1e6 * entry['subject_seconds']:.4g}"])
    return table(["subject against peer", "speedup", "subject, µs"], rows)


def fill(text, name, content):
    pattern = re.compile(rf"(<!-- {name}:[^>]*-->\n).*?(<!-- /{name} -->)", re.DOTALL)
    filled, count = pattern.subn(lambda match: f"{match[1]}{content}\n{match[2]}", text)
    if count != 1:
        sys.exit(f"README.md: found {count} places for the table '{name}', 1 is allowed")
    return filled


def main():
    top = pathlib.Path(sys.argv[1])
    readme = top / "README.md"
    before = readme.read_text(encoding="utf-8")
    after = before
    for make in (published, benchmarks):
        after = fill(after, make.__name__, make(top / "results"))
    if "--check" in sys.argv[2:]:
        sys.exit("README.md: its tables are not those of results/; experiments/run --update fills them" if after != before else 0)
    readme.write_text(after, encoding="utf-8")


main()
