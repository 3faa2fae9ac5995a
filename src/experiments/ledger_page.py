"""Makes the ledger's page: ledger_page.py LEDGER PLOTS OUTPUT.

One file that needs nothing else: the plots, of which PLOTS holds NAME.svg for each experiment, are part of it, compressed,
and unfolded by the browser when a claim is opened; larger ones, pictures mostly, are linked. Its links to experiments and plots work where it lies in plots/.
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
LARGEST_PLOT = 60_000  # letters of a plot in the page
VERDICTS = ["reproduced", "compatible", "mixed", "contradicted", "not comparable", "not measured"]
AGREEMENTS = ["consistent", "mixed", "inconsistent"]

PAGE = string.Template(
    """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Raytruth: the ledger</title>
<style>
:root { color-scheme: light dark; --line: #8884; --soft: #8882; --good: #0a7d4f; --bad: #b3400f; --between: #8a6a00;
  --open: #6b6b75; }
@media (prefers-color-scheme: dark) { :root { --good: #4cc38a; --bad: #ff9a6a; --between: #e0bb4d; --open: #a5a5b0; } }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 66rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; margin: .5rem 0; }
h2 { font-size: 1.2rem; margin: 2rem 0 .25rem; }
table { border-collapse: collapse; margin: .6rem 0; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .2rem .7rem .2rem 0; border-bottom: 1px solid var(--line);
  font-weight: normal; }
thead th { opacity: .75; }
table.counts th:not(:first-child), table.counts td:not(:first-child) { text-align: right; }
.scroll { overflow-x: auto; }
form { position: sticky; top: 0; background: Canvas; border-bottom: 1px solid var(--line); padding: .5rem 0; display: flex;
  flex-wrap: wrap; gap: .3rem 1.1rem; align-items: center; z-index: 1; }
input[type=search] { font: inherit; min-width: 14rem; }
article { border-top: 1px solid var(--line); padding: .8rem 0; scroll-margin-top: 4rem; }
article > header { display: flex; justify-content: space-between; gap: 1rem; }
article h3 { font-size: 1rem; margin: 0; } article h3 a { color: inherit; text-decoration: none; }
.verdict { font-weight: 600; white-space: nowrap; }
.reproduced, .consistent, .found { color: var(--good); } .contradicted, .inconsistent, .not-found { color: var(--bad); }
.mixed, .compatible { color: var(--between); } .not-comparable, .not-measured { color: var(--open); }
blockquote { margin: .3rem 0; padding-left: .8rem; border-left: 3px solid var(--line); }
.small { font-size: .9rem; opacity: .85; margin: .2rem 0; }
td .small { max-width: 34rem; }
summary { cursor: pointer; }
.plot { overflow-x: auto; background: #fff; border-radius: 6px; padding: .5rem; margin-top: .4rem; }
.plot svg { display: block; width: 100%; height: auto; min-width: 26rem; }
@media (max-width: 40rem) { h1 { font-size: 1.3rem; } table { font-size: .85rem; } th, td { padding-right: .4rem; }
  form { position: static; } }
@media print { form, details { display: none; } body { max-width: none; font-size: 10pt; } article { break-inside: avoid; }
  a { color: inherit; text-decoration: none; } .small { opacity: 1; } }
</style>
</head>
<body>
<h1>What the publications claim, and what was measured</h1>
<p>Every testable claim of five publications on ray integration, in their own words, against a certified reference. A claim of
several parts is <em>mixed</em> where they differ; parts that are not comparable are left out of that. What decides stands in one
<a href="#criteria">table of criteria</a>. What no publication says, but a reader should know, is a finding, and no verdict; printed
numbers that are compared with each other are internal consistency.</p>
<div class="scroll"><table class="counts"><thead><tr><th>claims</th>$verdicts<th>findings</th></tr></thead><tbody>$counts</tbody></table>
<table class="counts"><thead><tr><th>internal consistency</th>$agreements</tr></thead><tbody>$agreement_counts</tbody></table></div>
<form aria-label="Show">
<input type="search" placeholder="search" aria-label="search">
<select aria-label="publication"><option value="">all publications</option>$papers</select>
<select aria-label="verdict"><option value="">all verdicts</option>$words</select>
<span id="shown"></span>
</form>
$sections
<section><h2 id="criteria">Criteria</h2>
<div class="scroll"><table><thead><tr><th>criterion</th><th>it holds where</th><th>reason</th></tr></thead><tbody>$criteria</tbody></table></div></section>
<p class="small">Raytruth $version, commit $commit.</p>
<script type="application/json" id="plots">$plots</script>
<script>
const plots = JSON.parse(document.getElementById("plots").textContent);
const form = document.querySelector("form");
const [search] = form.querySelectorAll("input");
const [paper, verdict] = form.querySelectorAll("select");
const show = () => {
  const words = search.value.toLowerCase().split(/\\s+/).filter(Boolean);
  let count = 0;
  for (const article of document.querySelectorAll("article")) {
    const text = article.textContent.toLowerCase();
    article.hidden = (paper.value && article.dataset.paper !== paper.value)
      || (verdict.value && !article.dataset.verdicts.split("|").includes(verdict.value))
      || !words.every((word) => text.includes(word));
    count += !article.hidden;
  }
  for (const section of document.querySelectorAll("section[data-paper]"))
    section.hidden = !section.querySelector("article:not([hidden])");
  document.getElementById("shown").textContent = count + " shown";
};
form.addEventListener("input", show);
form.addEventListener("submit", (event) => event.preventDefault());
for (const details of document.querySelectorAll("details"))
  details.addEventListener("toggle", async () => {
    const plot = details.querySelector(".plot");
    if (!details.open || plot.childElementCount) return;
    const bytes = Uint8Array.from(atob(plots[plot.dataset.plot]), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    plot.innerHTML = await new Response(stream).text();
  });
show();
</script>
</body>
</html>
"""
)


def escaped(value):
    return html.escape(f"{value:.4g}" if isinstance(value, (int, float)) else str(value))


def badge(verdict):
    return f'<span class="verdict {verdict.replace(" ", "-")}">{verdict}</span>'


def measured(row):
    if row["measured"] is None:
        return "–"
    unit = f' {escaped(row["unit"])}' if row["unit"] else ""
    text = f'{escaped(row["measured"])}{unit}'
    if row["low"] != row["high"]:
        text += f' <span class="small">({escaped(row["low"])} to {escaped(row["high"])}: {escaped(row["range"])})</span>'
    if row["percentile"] is not None:
        text += f'<div class="small">the printed figure is above {100 * row["percentile"]:.3g} % of these</div>'
    if row["column"]:
        text += f'<div class="small">column {escaped(row["column"])}</div>'
    return text


def words(row):
    """How a part is read and judged, and why it is as it is."""
    lines = []
    for name in ("reading", "criterion", "deviation"):
        if row[name]:
            value = escaped(row[name])
            if name == "criterion":
                value = f'<a href="#criteria">{value}</a>'
            lines.append(f'<div class="small"><b>{name}</b> {value}</div>')
    if row["why"]:
        lines.append(f'<div class="small">{escaped(row["why"])}</div>')
    return "".join(lines)


def experiment(row):
    name = row["experiment"]
    return f'<a href="../experiments/{escaped(name)}.json">{escaped(name)}</a>' if name else "–"


def table(rows):
    """The parts of a claim, or the findings about it."""
    lines = [
        f'<tr><td>{escaped(row["part"] or "")}</td><td>{escaped(row["stated"])}{words(row)}</td><td>{measured(row)}</td>'
        f'<td>{badge(row["verdict"])}</td><td>{experiment(row)}</td></tr>'
        for row in rows
    ]
    head = "<th>part</th><th>stated</th><th>measured</th><th></th><th>experiment</th>"
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{"".join(lines)}</tbody></table></div>'


def plots_of(rows, plots):
    names = [name for name in dict.fromkeys(row["experiment"] for row in rows) if name in plots]
    return "".join(
        f'<p class="small"><a href="{escaped(name)}.svg">plot of {escaped(name)}</a></p>'
        if len(plots[name]) > LARGEST_PLOT
        else f'<details><summary>plot of {escaped(name)} (<a href="{escaped(name)}.svg">file</a>)</summary>'
        f'<div class="plot" data-plot="{escaped(name)}"></div></details>'
        for name in names
    )


def article(name, rows, plots):
    first = rows[0]
    judged = [row for row in rows if row["kind"] != "finding"]
    findings = [row for row in rows if row["kind"] == "finding"]
    verdict = judged[0]["claim_verdict"] if judged else "finding"
    verdicts = [verdict, *(row["verdict"] for row in rows)]
    parts = [f'<article id="{escaped(name)}" data-paper="{escaped(first["paper"])}" data-verdicts="{"|".join(verdicts)}">']
    parts.append(f'<header><h3><a href="#{escaped(name)}">{escaped(name)}</a></h3>{badge(verdict)}</header>')
    if first["text"]:
        parts.append(f'<blockquote>{escaped(first["text"])} <span class="small">{escaped(first["place"])}</span></blockquote>')
    terms = [(term, first[term]) for term in ("method", "baseline", "subject") if first[term]]
    if terms:
        parts.append('<p class="small">' + " · ".join(f"<b>{term}</b> {escaped(text)}" for term, text in terms) + "</p>")
    if any(row["experiment"] for row in judged):
        parts.append(table(judged))
    elif judged:
        parts.append(f'<p class="small">{escaped(judged[0]["why"])}</p>')
    if findings:
        parts.append(f'<p class="small">Findings about it</p>{table(findings)}')
    return "\n".join(parts) + plots_of(rows, plots) + "</article>"


def compressed(file):
    text = file.read_text(encoding="utf-8")
    return base64.b64encode(gzip.compress(text[text.index("<svg") :].encode(), mtime=0)).decode()


def claims_of(rows):
    claims = {}
    for row in rows:
        claims.setdefault(row["claim"], []).append(row)
    return claims


def counts_of(rows, kind, verdicts):
    joint = [
        next(row["claim_verdict"] for row in parts if row["kind"] == kind)
        for parts in claims_of(rows).values()
        if any(row["kind"] == kind for row in parts)
    ]
    return [sum(word == verdict for word in joint) for verdict in verdicts]


def cells(numbers):
    return "".join(f"<td>{number or '–'}</td>" for number in numbers)


def main():
    ledger, folder, output = map(pathlib.Path, sys.argv[1:])
    document = json.loads(ledger.read_text(encoding="utf-8"))
    rows = document["rows"]
    experiments = dict.fromkeys(row["experiment"] for row in rows if row["experiment"])
    plots = {name: compressed(folder / f"{name}.svg") for name in experiments if (folder / f"{name}.svg").is_file()}

    papers = list(dict.fromkeys(row["paper"] for row in rows))
    by_paper = {paper: [row for row in rows if row["paper"] == paper] for paper in papers}
    titles = {paper: html.escape(PAPERS.get(paper) or paper or "Claims of other experiments") for paper in papers}

    def count(name, of_rows):
        findings = sum(row["kind"] == "finding" for row in of_rows)
        return f"<tr><td>{name}</td>{cells([*counts_of(of_rows, 'claim', VERDICTS), findings])}</tr>"

    def agreement(name, of_rows):
        return f"<tr><td>{name}</td>{cells(counts_of(of_rows, 'internal consistency', AGREEMENTS))}</tr>"

    with_numbers = [paper for paper in papers if any(row["kind"] == "internal consistency" for row in by_paper[paper])]
    page = PAGE.substitute(
        verdicts="".join(f"<th>{verdict}</th>" for verdict in VERDICTS),
        counts="".join(count(titles[paper], by_paper[paper]) for paper in papers) + count("all", rows),
        agreements="".join(f"<th>{word}</th>" for word in AGREEMENTS),
        agreement_counts="".join(agreement(titles[paper], by_paper[paper]) for paper in with_numbers) + agreement("all", rows),
        papers="".join(f'<option value="{html.escape(str(paper))}">{titles[paper]}</option>' for paper in papers),
        words="".join(f"<option>{word}</option>" for word in dict.fromkeys([*VERDICTS, *AGREEMENTS, "found"])),
        sections="\n".join(
            f'<section data-paper="{html.escape(str(paper))}"><h2>{titles[paper]}</h2>'
            + "\n".join(article(name, parts, plots) for name, parts in claims_of(by_paper[paper]).items())
            + "</section>"
            for paper in papers
        ),
        criteria="".join(
            f'<tr><td>{escaped(one["name"])}</td><td>{escaped(one["sentence"])}</td><td>{escaped(one["reason"])}</td></tr>'
            for one in document["criteria"]
        ),
        version=html.escape(document["provenance"]["version"]),
        commit=html.escape(document["provenance"]["commit"]),
        plots=json.dumps({name: plot for name, plot in plots.items() if len(plot) <= LARGEST_PLOT}),
    )
    try:
        output.write_text(page, encoding="utf-8")
    except OSError as error:
        sys.exit(error.strerror)


main()
