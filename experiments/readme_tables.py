"""Fills the tables of READMEs, and the figures in their prose, from results/ alone: readme_tables.py REPOSITORY [--check]. With
--check nothing is written, and the exit code is 1 if one is not what the results say.

A figure in prose has a comment behind it that says where it comes from, as
    4.6<!-- eta {"angle": 90, "normalization": "quadratic", "against": "exact"} | one norm_deviation_max *100 .1f -->
"""

import json
import pathlib
import re
import statistics
import sys


def number(value):
    return f"{value:.4g}" if isinstance(value, (int, float)) else str(value)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def ledger(results):
    """How many claims of each publication have which verdict; the parts that do not hold; what disagrees in print; findings."""
    rows = json.loads((results / "ledger.json").read_text(encoding="utf-8"))["rows"]
    verdicts = ["reproduced", "compatible", "mixed", "contradicted", "not comparable", "not measured"]

    def name_of(row):
        return row["claim"] + (f" ({row['part']})" if row["part"] else "")

    def measured(row):
        unit = f" {row['unit']}" if row["unit"] else ""
        spread = "" if row["low"] == row["high"] else f" ({number(row['low'])} to {number(row['high'])})"
        return number(row["measured"]) + unit + spread

    def link(row):
        return f"[{row['experiment']}]({row['experiment']}.json)"

    def counts(of_rows):
        claims = {row["claim"]: row["claim_verdict"] for row in of_rows if row["kind"] == "claim"}
        findings = sum(row["kind"] == "finding" for row in of_rows)
        return [str(list(claims.values()).count(verdict)) for verdict in verdicts] + [str(findings)]

    papers = list(dict.fromkeys(row["paper"] for row in rows))
    lines = [[str(paper), *counts([row for row in rows if row["paper"] == paper])] for paper in papers]
    tables = [table(["claims of", *verdicts, "findings"], [*lines, ["all", *counts(rows)]])]
    contradicted = [
        [name_of(row), row["claim_verdict"], number(row["stated"]), measured(row), link(row)]
        for row in rows
        if row["verdict"] == "contradicted"
    ]
    tables.append(table(["parts that are contradicted", "claim", "stated", "measured", "experiment"], contradicted))
    printed = [
        [name_of(row), number(row["stated"]), number(row["measured"]), row["verdict"]]
        for row in rows
        if row["kind"] == "internal consistency"
    ]
    tables.append(table(["printed numbers against each other", "stated", "follows", "verdict"], printed))
    findings = [[row["claim"], row["stated"], measured(row), link(row)] for row in rows if row["kind"] == "finding"]
    tables.append(table(["about", "finding, which no publication states", "measured", "experiment"], findings))
    return "\n\n".join(tables)


def criteria(results):
    file = results.parent / "src" / "experiments" / "criteria.json"
    rows = json.loads(file.read_text(encoding="utf-8"))["criteria"]
    return table(["criterion", "it holds where", "reason"], [[row["name"], row["sentence"], row["reason"]] for row in rows])


AGGREGATES = {"min": min, "max": max, "sum": sum, "median": statistics.median, "count": len, "one": lambda values: single(values)}
FIGURE = re.compile(r"(?P<number>[^\s(]+?)<!-- (?P<where>[^>]*?) \| (?P<how>[^>|]*?) -->")


def single(values):
    if len(values) != 1:
        sys.exit(f"found {len(values)} rows, 1 is allowed")
    return values[0]


def figure(results, where, how):
    """The number that a marker in prose names: RESULT SELECTOR, or RESULT SELECTOR / SELECTOR, | AGGREGATE COLUMN [*FACTOR] FORMAT."""
    name, selectors = where.split(" ", 1)
    rows = json.loads((results / f"{name}.json").read_text(encoding="utf-8"))["rows"]
    aggregate, column, *factor, form = how.split()

    def value(selector):
        wanted = json.loads(selector)
        found = [
            row[column]
            for row in rows
            if row.get(column) is not None
            and all(row.get(key) in (item if isinstance(item, list) else [item]) for key, item in wanted.items())
        ]
        if not found:
            sys.exit(f"{name}: no row is {selector}")
        return AGGREGATES[aggregate](found)

    values = [value(selector) for selector in selectors.split(" / ")]
    result = values[0] / values[1] if len(values) == 2 else values[0]
    return format(result * float(factor[0].removeprefix("*")) if factor else result, form)


def prose(results, text):
    """The text with its figures as results have them."""
    return FIGURE.sub(
        lambda match: figure(results, match["where"], match["how"]) + match[0][len(match["number"]) :], text
    )


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


TABLES = {
    "README.md": (),
    "experiments/README.md": (criteria,),
    "results/README.md": (ledger, conformance, benchmarks),
    "src/raytruth/rules/README.md": (functions,),
}


def main():
    top = pathlib.Path(sys.argv[1])
    for file, makers in TABLES.items():
        before = after = (top / file).read_text(encoding="utf-8")
        for make in makers:
            after = fill(file, after, make.__name__, make(top / "results"))
        after = prose(top / "results", after)
        if "--check" not in sys.argv[2:]:
            (top / file).write_text(after, encoding="utf-8")
        elif after != before:
            sys.exit(f"{file}: its tables or figures are not those of results/; experiments/run --judge fills them")


main()
