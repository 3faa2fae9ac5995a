"""Fills the tables of README.md and writes plots/peers.html, from results, conventions and defects: page.py"""

import html
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
TOP = HERE.parents[1]
sys.path[:0] = [str(HERE / "defects")]

import defect  # noqa: E402
import study  # noqa: E402

STEPS = (1, 0.25, 0.0625)


def load(name):
    return json.loads((HERE / name).read_text())


def number(x, digits=1):
    return "" if x is None else f"{x:.{digits}f}"


def small(x):
    return "" if x is None else "0" if x == 0 else f"{x:.1e}".replace("e-0", "e-")


# --- tables: a head and rows of texts ---


def vectors_table():
    rows = load("results/peers_vectors.json")["rows"]
    levels = list(dict.fromkeys(row["level"] for row in rows))
    table = [["", *(level.replace("_", " ") for level in levels), "largest, mean error"]]
    for scheme in dict.fromkeys(row["scheme"] for row in rows):
        for against in ("ray", "samples"):
            of = {row["level"]: row for row in rows if row["scheme"] == scheme and row["against"] == against}
            cells = [f"{number(of[level]['digits_min'])} ({number(of[level]['digits_median'])})" if of[level]["answered"] else "-" for level in levels]
            last = of["all"]
            worst = max(last["color_error_max"], last["opacity_error_max"])
            answered = f" ({last['answered']} of {last['cases']})" if last["answered"] < last["cases"] and against == "ray" else ""
            table.append([f"{scheme}{answered}" if against == "ray" else ". alone", *cells, f"{worst:.2f}, {last['error_mean']:.3f}"])
    return table


def images_rows():
    return [row for row in load("results/peers_images.json")["rows"] if row.get("against") == "certified" and row.get("frame") == "linear" and row.get("line") is None and row["status"] == "ok"]


def images_table(view):
    rows = [row for row in images_rows() if row["view"] == view]
    table = [["", *(f"step {step:g}" for step in STEPS), "largest error at the last"]]
    for scheme in dict.fromkeys(row["scheme"] for row in rows):
        of = {row["step"]: row for row in rows if row["scheme"] == scheme}
        last = of.get(STEPS[-1])
        table.append([scheme, *(small(of[step]["rmse"]) if step in of else "" for step in STEPS), small(last["maximum"]) if last else ""])
    return table


def single_table(views, columns=("rmse", "maximum", "opacity_rmse")):
    rows = images_rows()
    found = list(dict.fromkeys(row["variant"] for row in rows if row["view"] == views[-1]))
    table = [["", *(f"{view}: {column}" if len(views) == 1 else view for view in views for column in columns)]]
    for variant in found:
        of = {row["view"]: row for row in rows if row["variant"] == variant}
        table.append([variant, *(small(of[view][column]) if view in of else "" for view in views for column in columns)])
    return table


def conventions_table():
    conventions = load("conventions.json")
    columns = list(conventions["columns"])
    return [["", *(column.replace("_", " ") for column in columns)], *([name, *(program[column] for column in columns)] for name, program in conventions["programs"].items())]


def defects():
    """(name, what its script states, version, rows)."""
    for script in study.scripts():
        found = load(f"defects/{script.stem}.json")
        yield script.stem, __import__(script.stem).DEFECT, found["version"], found["rows"]


def defects_table():
    table = [["defect", "worst case: expected", "obtained", "by", "script"]]
    for name, stated, version, rows in defects():
        case, expected, obtained = max(rows, key=lambda row: abs(row[2] - row[1]))
        table.append([stated.title, f"{expected:.3f}", f"{obtained:.3f}", version, f"[{name}](defects/{name}.txt)"])
    return table


# --- as Markdown and as HTML ---


def markdown(table):
    head, *rows = table
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows])


def html_table(table):
    head, *rows = table
    line = lambda cells, tag: "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"
    return "<table>\n" + "\n".join([line(head, "th"), *(line(row, "td") for row in rows)]) + "\n</table>"


def fill(text, tables):
    for name, table in tables.items():
        text, count = re.subn(rf"(<!-- {name}: [^>]*-->\n).*?(<!-- /{name} -->)", lambda found: found[1] + markdown(table) + "\n" + found[2], text, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"README.md: found {count} places for {name}, 1 is allowed")
    return text


STYLE = """body { font: 15px/1.5 sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; color: #222 }
table { border-collapse: collapse; font-size: 12px; display: block; overflow-x: auto; margin: 1em 0 } td, th { border: 1px solid #ccc; padding: 2px 6px; text-align: left; vertical-align: top }
pre { background: #f6f6f6; padding: .6em; overflow-x: auto; font-size: 12px } img { max-width: 100% } h3 { margin-bottom: .2em } code { background: #f6f6f6 }"""


def page():
    parts = ["<h1>Shipping renderers, measured</h1>",
             "<p>What each renderer assumes, what is off, and how to see it. All numbers are those of <code>experiments/peers/results</code>, and of the scripts in <code>experiments/peers/defects</code>; "
             "<code>experiments/peers/run</code> measures them again.</p>",
             "<h2>What each assumes</h2>", html_table(conventions_table()),
             "<h2>Vectors</h2><p>Least (median) digits that are right, by level. <i>Alone</i>: against the certified answer for the signal that is linear between the 64 samples, so that sampling is no part of the error.</p>",
             html_table(vectors_table()), '<img src="../experiments/peers/plots/peers_vectors.svg" alt="digits by level">',
             "<h2>Images</h2><p>RMS of colours against certified images of 96 x 96 pixels.</p>"]
    for view in ("marschner_lobb smooth", "marschner_lobb peaks", "neghip smooth", "neghip peaks"):
        parts += [f"<h3>{view}</h3>", html_table(images_table(view))]
    parts += ["<h3>Cells: a scalar that is linear in space</h3>", html_table(single_table(["ramp"])),
              "<h3>Lit (references are estimates), step 1/4</h3>", html_table(single_table(["marschner_lobb ambient", "marschner_lobb one-sided", "marschner_lobb two-sided"], ("rmse",))),
              '<img src="../experiments/peers/plots/peers_images.svg" alt="error against step, images and their errors">', "<h2>Defects</h2>"]
    for name, stated, version, rows in defects():
        text = defect.text_of(stated, version, rows)
        parts += [f'<h3 id="{name}">{html.escape(stated.title)}</h3>', f"<p>{html.escape(' '.join(stated.what.split()))}</p><p>Where: {html.escape(stated.where)}</p><p>A repair: {html.escape(' '.join(stated.repair.split()))}</p>",
                  f"<pre>{html.escape(text.split(chr(10) * 2, 1)[1])}</pre><p><code>experiments/peers/defects/{name}.py</code></p>"]
    return f'<!doctype html>\n<html lang="en">\n<head><meta charset="utf-8"><title>Shipping renderers, measured</title><style>{STYLE}</style></head>\n<body>\n' + "\n".join(parts) + "\n</body>\n</html>\n"


def main():
    readme = HERE / "README.md"
    tables = {"conventions": conventions_table(), "vectors": vectors_table(), "smooth": images_table("neghip smooth"), "peaks": images_table("neghip peaks"),
              "always": images_table("marschner_lobb smooth"), "ramp": single_table(["ramp"]), "lit": single_table(["marschner_lobb ambient", "marschner_lobb one-sided", "marschner_lobb two-sided"], ("rmse",)), "defects": defects_table()}
    readme.write_text(fill(readme.read_text(), tables))
    (TOP / "plots/peers.html").write_text(page())


if __name__ == "__main__":
    main()
