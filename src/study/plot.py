"""Draws the plot of one result, from the result alone: plot.py OUTPUT FORMAT RESULT.

The experiment inside the result says what to draw ("plot"); colours, markers and labels of schemes come from its "styles".
A kind of panel is a function in PANELS.
"""

import json
import os
import sys

os.environ.setdefault("SOURCE_DATE_EPOCH", "0")  # the same bytes whenever it is drawn

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

plt.rcParams.update(
    {
        "font.size": 8,
        "axes.titlesize": 8,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "svg.hashsalt": "raytruth",
        "svg.fonttype": "none",
        "legend.frameon": False,
    }
)

# Below this many radii an error speaks of the reference's rounding, not of the scheme: drawn hollow.
MEANINGFUL_RADII = 10


def select(rows, selector):
    """The rows whose members equal the selector's; a list allows any of its items."""

    def matches(row, key, wanted):
        return row.get(key) in (wanted if isinstance(wanted, list) else [wanted])

    return [row for row in rows if all(matches(row, key, wanted) for key, wanted in selector.items())]


def distinct(rows, key):
    """Values of a key in the order of the rows."""
    return list(dict.fromkeys(row[key] for row in rows if row.get(key) is not None))


def radius_of(result, row, column):
    name = result["columns"].get(column, {}).get("radius")
    return (row.get(name) if name else 0) or 0


def floor_of(values):
    """Where a log axis shows what is nothing but rounding: half a decade below the least value drawn as it is."""
    return min(values) / 3 if values else 1e-16


def draw_quantiles(axes, result, panel):
    """A distribution per row: 5th to 95th percentile thin, 25th to 75th thick, the median a marker.

    Groups stand below one another, the series of each side by side. Dashed: the published figure of the series.
    """
    rows = select(result["rows"], panel["rows"])
    groups = distinct(rows, panel["group"])
    series = [name for name in result["styles"] if name in distinct(rows, panel["series"])]
    percents = ["05", "25", "50", "75", "95"]
    columns = [f"{panel['value']}_p{percent}" for percent in percents]

    def meaningful(row):
        values = [row.get(column) for column in columns]
        return None not in values and values[2] > MEANINGFUL_RADII * radius_of(result, row, columns[2])

    floor = floor_of([row[columns[0]] for row in rows if meaningful(row) and row[columns[0]] > 0])
    handles = []
    for index, name in enumerate(series):
        style = result["styles"][name]
        offset = (index - (len(series) - 1) / 2) * 0.8 / max(len(series), 1)
        printed = None
        for row in select(rows, {panel["series"]: name}):
            place = groups.index(row[panel["group"]]) + offset
            values = [row.get(column) for column in columns]
            printed = row.get(panel["printed"]) if "printed" in panel else None
            if None in values:
                continue
            filled = meaningful(row)
            low, quarter, median, three_quarters, high = [max(value, floor) if panel.get("log") else value for value in values]
            if filled:
                axes.plot([low, high], [place, place], color=style["color"], linewidth=0.8)
                axes.plot([quarter, three_quarters], [place, place], color=style["color"], linewidth=2.6)
            axes.plot(
                [median],
                [place],
                marker=style["marker"],
                markersize=4,
                color=style["color"],
                markerfacecolor=style["color"] if filled else "white",
                markeredgecolor="black" if filled else style["color"],
                markeredgewidth=0.4,
                clip_on=False,
            )
        label = name.replace("_", " ")
        if printed is not None:
            axes.axvline(printed, color=style["color"], linestyle=(0, (4, 2)), linewidth=0.9, zorder=0)
            label += f" (published {printed:.4g})"
        handles.append(
            Line2D([], [], color=style["color"], marker=style["marker"], markersize=4, linewidth=2.6, label=label)
        )

    if panel.get("log"):
        axes.set_xscale("log")
    axes.set_yticks(range(len(groups)), [group.replace("_", " ") for group in groups])
    axes.set_ylim(len(groups) - 0.5, -0.5)
    for border in range(1, len(groups)):
        axes.axhline(border - 0.5, color="0.9", linewidth=0.6, zorder=0)
    axes.grid(axis="x", color="0.93", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(panel["label"])
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=7)
    return len(groups) * (0.12 * max(len(series), 1) + 0.1)


PANELS = {"quantiles": draw_quantiles}


def refused_rows(result):
    """One line for each field that could not be measured."""
    refused = [row for row in result["rows"] if row.get("status") == "refused"]
    return [f"{field}: refused" for field in distinct(refused, "field")]


def draw(result):
    plot = result["experiment"]["plot"]
    panels = plot["panels"]
    figure, all_axes = plt.subplots(1, len(panels), figsize=(3.7 * len(panels), 4), squeeze=False)
    heights = [PANELS[panel["kind"]](axes, result, panel) for axes, panel in zip(all_axes[0], panels)]
    labels = [[label.get_text() for label in axes.get_yticklabels()] for axes in all_axes[0]]
    for axes, own in zip(all_axes[0][1:], labels[1:]):
        axes.tick_params(labelleft=own != labels[0])
    figure.set_size_inches(3.7 * len(panels), max(heights) + 1.6)
    figure.suptitle(plot["title"], fontsize=9)
    notes = [plot["note"]] if "note" in plot else []
    notes += ["; ".join(refused_rows(result))] if refused_rows(result) else []
    if notes:
        figure.supxlabel("\n".join(notes), fontsize=6.5, color="0.3")
    figure.tight_layout()
    return figure


def main():
    output, file_format, source = sys.argv[1:]
    with open(source, encoding="utf-8") as file:
        result = json.load(file)
    metadata = {"Date": None} if file_format == "svg" else {"CreationDate": None} if file_format == "pdf" else {}
    draw(result).savefig(output, format=file_format, dpi=200, metadata=metadata)


main()
