"""Fills the tables of READMEs from results/ alone: readme_tables.py REPOSITORY [--check]. With --check nothing is written, and
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


def ledger(results):
    """How many claims of each publication have which verdict, and those that do not hold."""
    rows = json.loads((results / "ledger.json").read_text(encoding="utf-8"))["rows"]
    verdicts = ["reproduced", "contradicted", "not comparable", "not measured"]

    def counts(of_rows):
        return [str(sum(row["verdict"] == verdict for row in of_rows)) for verdict in verdicts]

    papers = list(dict.fromkeys(row["paper"] for row in rows))
    lines = [[paper, *counts([row for row in rows if row["paper"] == paper])] for paper in papers]
    contradicted = []
    for row in rows:
        if row["verdict"] == "contradicted":
            name = row["claim"] + (f" ({row['part']})" if row["part"] else "")
            measured = f"{number(row['measured'])} ({number(row['low'])} to {number(row['high'])})"
            experiment = f"[{row['experiment']}]({row['experiment']}.json)"
            contradicted.append([name, number(row["stated"]), measured, experiment])
    head = ["contradicted", "published", "measured (low to high)", "experiment"]
    return table(["publication", *verdicts], [*lines, ["all", *counts(rows)]]) + "\n\n" + table(head, contradicted)


def conformance(results):
    rows = json.loads((results / "conformance.json").read_text(encoding="utf-8"))["rows"]
    schemes = list(dict.fromkeys(row["scheme"] for row in rows))
    digits = {(row["level"], row["scheme"]): f"{row['digits_min']:.1f} ({row['digits_median']:.1f})" for row in rows}
    levels = dict.fromkeys(row["level"] for row in rows)
    return table(["level", *schemes], [[level.replace("_", " "), *(digits[level, scheme] for scheme in schemes)] for level in levels])


def machine(context):
    """What a report says of the machine that it was made on; `cpu` is there if the run named it."""
    cores = f"{context['num_cpus']} cores at {context['mhz_per_cpu'] / 1000:.1f} GHz"
    caches = [f"L{cache['level']} {cache['size'] // 1024} KiB" for cache in context["caches"] if cache["type"] != "Instruction"]
    return ", ".join([*([context["cpu"]] if "cpu" in context else []), cores, *caches, context["date"][:10]])


def benchmarks(results):
    """A table for each report, under the machine that it was made on."""
    tables = []
    for file in sorted(results.glob("benchmarks/*.json")):
        report = json.loads(file.read_text(encoding="utf-8"))
        rows = []
        for entry in report["benchmarks"]:
            if entry.get("aggregate_name") == "median" and "speedup" in entry:
                name = entry["run_name"].removesuffix("/manual_time").replace("_", " ")
                rows.append([name, f"{entry['speedup']:.3g}", f"{1e6 * entry['subject_seconds']:.4g}"])
        if rows:
            link = f"[{file.stem}](benchmarks/{file.name})"
            head = ["subject against peer", "speedup", "subject, µs"]
            tables.append(f"{link}: {machine(report['context'])}\n\n{table(head, rows)}")
    return "\n\n".join(tables)


def signatures(rules):
    """By function: what it returns and takes, and the file that has it."""
    found = {}
    for file in sorted(rules.glob("*.glsl")):
        for match in re.finditer(r"^((?:real|vec4) (\w+)\([^)]*\))", file.read_text(encoding="utf-8"), re.MULTILINE):
            found[match[2]] = re.sub(r"\s+", " ", match[1]), file.name
    return found


def functions(results):
    document = json.loads((results / "gl_cross_check.json").read_text(encoding="utf-8"))
    text = signatures(results.parent / "src" / "raytruth" / "rules")
    worst = {}
    for row in document["rows"]:
        if row["measure"] == "gl_functions":
            worst.setdefault(row["function"], []).append(row)
    rows = []
    for name, both in worst.items():
        signature, file = text[name]
        figures = [number(max(row[column] for row in both)) for column in ("shader_max_ulps", "gl_max_ulps", "gl_bound")]
        rows.append([f"`{signature}`", f"[{file}]({file})", both[0]["arguments"], *figures])
    return table(["function", "file", "kinds of arguments", "shader - truth", "GLSL - binary32", "allowed"], rows)


def fill(file, text, name, content):
    pattern = re.compile(rf"(<!-- {name}:[^>]*-->\n).*?(<!-- /{name} -->)", re.DOTALL)
    filled, count = pattern.subn(lambda match: f"{match[1]}{content}\n{match[2]}", text)
    if count != 1:
        sys.exit(f"{file}: found {count} places for the table '{name}', 1 is allowed")
    return filled


TABLES = {"results/README.md": (ledger, conformance, benchmarks), "src/raytruth/rules/README.md": (functions,)}


def main():
    top = pathlib.Path(sys.argv[1])
    for file, makers in TABLES.items():
        before = after = (top / file).read_text(encoding="utf-8")
        for make in makers:
            after = fill(file, after, make.__name__, make(top / "results"))
        if "--check" not in sys.argv[2:]:
            (top / file).write_text(after, encoding="utf-8")
        elif after != before:
            sys.exit(f"{file}: its tables are not those of results/; experiments/run --update fills them")


main()
