"""Runs the studies of peers and the scripts of their defects: study.py [--update] [-j N] RAYTRUTH OUT NAME...

Other numbers than the committed ones are told, with exit code 1, where they differ by more than conventions.json allows.
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
STUDIES = ("peers_vectors", "peers_images")
PYTHON = "/usr/bin/python3"


def peer_of(name):
    """vtk, miter, vtkjs, povray: the first word of a program's or a script's name."""
    return name.split("_")[0]


def is_program(scheme):
    return isinstance(scheme, dict)


def chosen(experiment, names):
    """The experiment with these peers' programs alone, Raytruth's own schemes, and nothing that is said or drawn of others."""
    experiment = json.loads(json.dumps(experiment))
    keep = lambda scheme: not is_program(scheme) or peer_of(scheme["name"]) in names
    gone = {scheme["name"] for scheme in experiment.get("schemes", []) if not keep(scheme)}
    for measure in experiment["measures"]:
        gone |= {variant["name"] for variant in measure.get("variants", []) if not keep(variant["scheme"])}

    def is_of_others(item):
        selectors = [item[key] for key in ("row", "rows", "otherwise") if key in item]
        return any(name in gone for rows in selectors for value in rows.values() for name in (value if isinstance(value, list) else [value]))

    for where, key in ((experiment, "published"), (experiment, "checks"), (experiment["plot"], "panels")):
        if key in where:
            where[key] = [item for item in where[key] if not is_of_others(item)]
    if "schemes" in experiment:
        experiment["schemes"] = [scheme for scheme in experiment["schemes"] if keep(scheme)]
    for measure in experiment["measures"]:
        if "variants" in measure:
            measure["variants"] = [variant for variant in measure["variants"] if keep(variant["scheme"])]
            left = {variant["name"] for variant in measure["variants"]} | {"certified"}
            for pictures in ("images", "errors"):
                measure["pictures"][pictures] = [name for name in measure["pictures"][pictures] if name in left]
    return experiment


def key_of(row, columns):
    return tuple(row.get(column) for column in columns)


def differences(committed, result, tolerances):
    """A line for every number that differs by more than it may, or is gone."""
    columns = [name for name, column in result["columns"].items() if column.get("key")]
    before = {key_of(row, columns): row for row in committed["rows"] if row.get("line") is None}
    lines = []
    for row in result["rows"]:
        if row.get("line") is not None:
            continue
        what = " ".join(str(word) for word in key_of(row, columns)[1:] if word is not None)
        was = before.get(key_of(row, columns))
        if was is None or was["status"] != row["status"]:
            lines.append(f"{what}: {row['why'] or 'not among the committed rows'}")
            continue
        allowed = tolerances.get(peer_of(str(row.get("scheme"))), tolerances["raytruth"])
        for column, (absolute, relative) in allowed.items():
            x, y = was.get(column), row.get(column)
            if x is not None and (y is None or abs(y - x) > absolute + relative * abs(x)):
                lines.append(f"{what}: {column} {y}, committed {x}")
    return lines


def run_study(arguments, name, tolerances):
    experiment = chosen(json.loads((HERE / f"{name}.json").read_text()), arguments.names)
    answers = arguments.out / "answers"
    answers.mkdir(parents=True, exist_ok=True)
    subprocess.run([arguments.raytruth, "run", "-", "--programs", "-j", str(arguments.j), "-o", arguments.out], input=json.dumps(experiment).encode(),
                   cwd=HERE, env={**os.environ, "PEERS_ANSWERS": str(answers)}, check=True)
    result = json.loads((arguments.out / f"{name}.json").read_text())
    refused = sorted({f"{row.get('scheme') or row.get('variant')}: {row['why']}" for row in result["rows"] if row["status"] == "refused"})
    for line in refused:
        print(f"{name}: refused: {line}")
    committed = HERE / f"results/{name}.json"
    found = differences(json.loads(committed.read_text()), result, tolerances) if committed.is_file() else []
    return refused, found


def run_defect(script, out):
    """What the script says, into OUT; False where its program is missing."""
    command = [PYTHON, script.name]
    if peer_of(script.stem) == "vtk":
        command = ["xvfb-run", "-a", *command]
    done = subprocess.run([*command, "--json"], cwd=script.parent, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        print(f"{script.stem}: {(done.stderr.strip() or 'no answer').splitlines()[-1]}")
        return False
    (out / f"{script.stem}.json").write_text(done.stdout)
    sys.path.insert(0, str(script.parent))
    import defect
    import importlib

    module, found = importlib.import_module(script.stem), json.loads(done.stdout)
    (out / f"{script.stem}.txt").write_text(defect.text_of(module.DEFECT, found["version"], found["rows"]))
    print(f"{script.stem}: {'still there' if defect.is_there(module.DEFECT, found['rows']) else 'no longer there'}, by {found['version']}")
    return True


def scripts():
    return [path for path in sorted((HERE / "defects").glob("*_*.py")) if path.stem.split("_")[0] in ("vtk", "vtkjs", "miter", "povray")]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--update", action="store_true")
    parser.add_argument("-j", type=int, default=1)
    parser.add_argument("raytruth")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("names", nargs="+")
    arguments = parser.parse_args()
    arguments.out = arguments.out.resolve()
    defects = arguments.out / "defects"
    defects.mkdir(parents=True, exist_ok=True)
    tolerances = json.loads((HERE / "conventions.json").read_text())["tolerances"]
    all_ran = all([run_defect(script, defects) for script in scripts() if peer_of(script.stem) in arguments.names])
    others = []
    for name in STUDIES:
        refused, found = run_study(arguments, name, tolerances)
        all_ran = all_ran and not refused
        others += [f"{name}: {line}" for line in found]
    print(*others, sep="\n", end="\n" * bool(others))
    print(f"{len(others)} numbers differ from the committed ones by more than their tolerances")
    if arguments.update:
        if not all_ran:
            sys.exit("--update: something was refused or missing; what is committed stays as it is")
        for name in STUDIES:
            (HERE / "results").mkdir(exist_ok=True)
            shutil.copy(arguments.out / f"{name}.json", HERE / "results")
        for folder in ("answers", "defects"):
            for path in sorted((arguments.out / folder).iterdir()):
                shutil.copy(path, HERE / folder)
        subprocess.run([arguments.raytruth, "plot", *(HERE / f"results/{name}.json" for name in STUDIES), "-o", HERE / "plots"], check=True)
        subprocess.run([PYTHON, HERE / "page.py"], check=True)
    sys.exit(bool(others) and not arguments.update)


if __name__ == "__main__":
    main()
