"""Makes the ledger's page: ledger_page.py LEDGER PLOTS OUTPUT.

One file that needs nothing else: the plots, of which PLOTS holds NAME.svg for each experiment, are part of it, compressed,
and unfolded by the browser when a claim is opened.
"""

import base64
import gzip
import html
import json
import pathlib
import string
import sys

PAPERS = {
    "guetat2010": "Guetat et al. 2010, nonlinear normals and specular cone",
    "elhajjar2008": "El Hajjar et al. 2008, second-order pre-integration",
    "lum2004": "Lum et al. 2004, subrange tables, interpolated lighting",
    "lee2010": "Lee et al. 2010, virtual samples",
    "dissertation": "The dissertation: gray-value models, tables, coherence, deformation",
}
VERDICTS = ["reproduced", "contradicted", "not comparable", "not measured"]

PAGE = string.Template(
    """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Raytruth: the ledger</title>
<style>
:root { color-scheme: light dark; --line: #8884; --soft: #8882; --reproduced: #0a7d4f; --contradicted: #b3400f;
  --comparable: #6b6b75; --measured: #6b6b75; }
@media (prefers-color-scheme: dark) { :root { --reproduced: #4cc38a; --contradicted: #ff9a6a; --comparable: #a5a5b0;
  --measured: #a5a5b0; } }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 62rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; margin: .5rem 0; }
h2 { font-size: 1.15rem; margin: 2rem 0 .25rem; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .2rem .7rem; border-bottom: 1px solid var(--line); font-weight: normal; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
.scroll { overflow-x: auto; }
fieldset { border: 0; padding: 0; margin: 1rem 0; display: flex; flex-wrap: wrap; gap: .3rem 1.2rem; }
article { border-top: 1px solid var(--line); padding: .8rem 0; display: grid; gap: .1rem 1rem;
  grid-template-columns: 1fr auto; }
article > * { grid-column: 1 / -1; margin: 0; min-width: 0; overflow-wrap: anywhere; }
article > h3 { grid-column: 1; font-size: 1rem; margin: 0; }
article > .verdict { grid-column: 2; grid-row: 1; font-weight: 600; white-space: nowrap; }
.reproduced { color: var(--reproduced); } .contradicted { color: var(--contradicted); }
.comparable { color: var(--comparable); } .measured { color: var(--measured); }
.place, .why { font-size: .9rem; opacity: .85; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0 .8rem; }
dt { opacity: .75; } dd { margin: 0; overflow-wrap: anywhere; }
summary { cursor: pointer; }
.plot { overflow-x: auto; background: #fff; border-radius: 6px; padding: .5rem; margin-top: .4rem; }
.plot svg { display: block; width: 100%; height: auto; min-width: 26rem; }
@media (max-width: 40rem) {
  h1 { font-size: 1.3rem; } table { font-size: .85rem; } th, td { padding: .2rem .25rem; }
  thead th:not(:first-child) { writing-mode: vertical-rl; transform: rotate(180deg); }
}
</style>
</head>
<body>
<h1>What the publications claim, and what was measured</h1>
<p>Every testable claim of five publications on ray integration, against a certified reference. A figure is reproduced if what
was measured, with its radius or as the 5th to 95th percentile of a distribution, meets it to half its last printed digit.</p>
<div class="scroll"><table><thead><tr><th>claims and their parts</th>$verdicts</tr></thead><tbody>$counts</tbody></table></div>
<fieldset aria-label="Show">$filters</fieldset>
$sections
<p class="place">Raytruth $version, commit $commit.</p>
<script type="application/json" id="plots">$plots</script>
<script>
const plots = JSON.parse(document.getElementById("plots").textContent);
for (const box of document.querySelectorAll("fieldset input"))
  box.addEventListener("change", () => {
    for (const article of document.querySelectorAll("article"))
      if (article.dataset.verdict === box.value) article.hidden = !box.checked;
  });
for (const details of document.querySelectorAll("details"))
  details.addEventListener("toggle", async () => {
    const plot = details.querySelector(".plot");
    if (!details.open || plot.childElementCount) return;
    const bytes = Uint8Array.from(atob(plots[plot.dataset.plot]), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    plot.innerHTML = await new Response(stream).text();
  });
</script>
</body>
</html>
"""
)


def figure(value):
    return f"{value:.4g}" if isinstance(value, (int, float)) else html.escape(str(value))


def measured(row):
    if row["measured"] is None:
        return "nothing"
    ends = "" if row["low"] == row["high"] == row["measured"] else f" ({figure(row['low'])} to {figure(row['high'])})"
    return figure(row["measured"]) + ends


def article(row, plots):
    part = f" <small>({html.escape(row['part'])})</small>" if row["part"] else ""
    style = row["verdict"].split()[-1]
    lines = [
        f'<article data-verdict="{row["verdict"]}"><h3>{html.escape(row["claim"])}{part}</h3>',
        f'<span class="verdict {style}">{row["verdict"]}</span>',
    ]
    if row["text"]:
        lines.append(f'<p>{html.escape(row["text"])} <span class="place">({html.escape(row["place"])})</span></p>')
    if row["experiment"]:
        lines.append(f"<dl><dt>stated</dt><dd>{figure(row['stated'])}</dd><dt>measured</dt><dd>{measured(row)}</dd></dl>")
    if row["why"]:
        lines.append(f'<p class="why">{html.escape(row["why"])}</p>')
    if row["experiment"] in plots:
        name = html.escape(row["experiment"])
        lines.append(f'<details><summary>plot of {name}</summary><div class="plot" data-plot="{name}"></div></details>')
    return "\n".join(lines) + "</article>"


def compressed(file):
    text = file.read_text(encoding="utf-8")
    return base64.b64encode(gzip.compress(text[text.index("<svg") :].encode(), mtime=0)).decode()


def main():
    ledger, folder, output = map(pathlib.Path, sys.argv[1:])
    document = json.loads(ledger.read_text(encoding="utf-8"))
    rows = document["rows"]
    experiments = dict.fromkeys(row["experiment"] for row in rows if row["experiment"])
    plots = {name: compressed(folder / f"{name}.svg") for name in experiments if (folder / f"{name}.svg").is_file()}

    def count(of_rows):
        numbers = [sum(row["verdict"] == verdict for row in of_rows) for verdict in VERDICTS]
        return "".join(f"<td>{number or '–'}</td>" for number in numbers)

    papers = list(dict.fromkeys(row["paper"] for row in rows))
    by_paper = {paper: [row for row in rows if row["paper"] == paper] for paper in papers}
    titles = {paper: html.escape(PAPERS.get(paper) or paper or "Claims of other experiments") for paper in papers}
    counts = "".join(f"<tr><td>{titles[paper]}</td>{count(by_paper[paper])}</tr>" for paper in papers)
    box = '<label><input type="checkbox" value="{0}" checked> {0}</label>'
    page = PAGE.substitute(
        verdicts="".join(f"<th>{verdict}</th>" for verdict in VERDICTS),
        counts=counts + f"<tr><td>all</td>{count(rows)}</tr>",
        filters="".join(box.format(verdict) for verdict in VERDICTS),
        sections="\n".join(
            f"<section><h2>{titles[paper]}</h2>" + "\n".join(article(row, plots) for row in by_paper[paper]) + "</section>"
            for paper in papers
        ),
        version=html.escape(document["provenance"]["version"]),
        commit=html.escape(document["provenance"]["commit"]),
        plots=json.dumps(plots),
    )
    try:
        output.write_text(page, encoding="utf-8")
    except OSError as error:
        sys.exit(error.strerror)


main()
