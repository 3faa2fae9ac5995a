"""Draws the plots of results, each from its result alone: plot.py FORMAT [RESULT OUTPUT]...

The experiment inside a result says what to draw ("plot"); colours and markers of schemes come from its "styles".
A kind of panel is a function in PANELS: it draws on axes, and returns its height in inches and its groups. A panel whose
rows are not there says so. A plot that cannot be drawn stops no other: it leaves no OUTPUT, and a line on standard error,
"cannot be drawn: RESULT: why"; one that cannot be written likewise, "cannot be written: RESULT: why".
"""

import json
import os
import sys
import textwrap

os.environ.setdefault("SOURCE_DATE_EPOCH", "0")  # the same bytes whenever it is drawn

try:
    import matplotlib
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

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

PANEL_WIDTH = 3.7  # inches
LEAST_WIDTH = 5.2

# Below this many radii a value speaks of rounding, not of what it measures: drawn hollow.
MEANINGFUL_RADII = 10

# Series that are no schemes, by order of appearance. Colour-blind readers tell the colours apart (M. Okabe and K. Ito,
# Color universal design, 2008), grayscale leaves markers and dashes.
COLORS = ["#0072B2", "#D55E00", "#009E73", "#000000", "#CC79A7", "#56B4E9", "#E69F00"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", ">"]
DASHES = ["-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)), (0, (3, 3)), (0, (6, 1, 1.2, 1, 1.2, 1))]


def select(rows, selector):
    """The rows whose members equal the selector's; a list allows any of its items."""

    def matches(row, key, wanted):
        return row.get(key) in (wanted if isinstance(wanted, list) else [wanted])

    return [row for row in rows if all(matches(row, key, wanted) for key, wanted in selector.items())]


def distinct(rows, key):
    """Values of a key in the order of the rows."""
    return list(dict.fromkeys(row[key] for row in rows if row.get(key) is not None))


def words(value):
    return value.replace("_", " ") if isinstance(value, str) else f"{value:g}"


def radius_of(result, row, column):
    name = result["columns"].get(column, {}).get("radius")
    return (row.get(name) if name else 0) or 0


def floor_of(values):
    """Where a log axis shows what is nothing but rounding: half a decade below the least value drawn as it is."""
    return min(values) / 3 if values else 1e-16


def styled_series(result, rows, key):
    """(name, style) of each series: schemes first, as the catalogue orders and styles them. A name looks the same in
    all panels of the figure."""
    panels = [panel for panel in result["experiment"]["plot"]["panels"] if panel.get("series") == key]
    everywhere = list(dict.fromkeys(name for panel in panels for name in distinct(select(result["rows"], panel["rows"]), key)))
    ordered = [name for name in result["styles"] if name in everywhere]
    ordered += [name for name in everywhere if name not in ordered]
    present = distinct(rows, key)
    for index, name in enumerate(ordered):
        own = {"color": COLORS[index % len(COLORS)], "marker": MARKERS[index % len(MARKERS)]}
        scheme = {part: value for part, value in result["styles"].get(name, {}).items() if part in own}
        if name in present:
            yield name, {**own, **scheme, "linestyle": DASHES[index % len(DASHES)]}


def draw_marker(axes, x, y, style, filled):
    axes.plot(
        [x],
        [y],
        marker=style["marker"],
        markersize=4,
        linestyle="none",
        markerfacecolor=style["color"] if filled else "white",
        markeredgecolor="black" if filled else style["color"],
        markeredgewidth=0.4 if filled else 0.8,
        clip_on=False,
        zorder=3,
    )


def show_legend(axes, handles):
    axes.set_axisbelow(True)
    axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=7)


def share_legend(figure, all_axes, width):
    """One legend for the figure where all panels that have one have the same: its handles and number of columns, else
    none."""
    legends = [legend for legend in (axes.get_legend() for axes in all_axes) if legend is not None]
    keys = [[(line.get_label(), line.get_color(), line.get_marker()) for line in legend.get_lines()] for legend in legends]
    if len(legends) <= 1 or any(key != keys[0] for key in keys):
        return None, 0
    handles = legends[0].get_lines()
    for legend in legends:
        legend.remove()
    widest = max(len(line.get_label()) for line in handles)
    return handles, max(1, min(len(handles), int(width / (0.055 * widest + 0.55))))


def label_log_axis(axis):
    """Numbers at 2 and 5 too where powers of ten alone would be one or none."""
    low, high = axis.get_view_interval()
    if high < 30 * low:
        axis.set_minor_locator(LogLocator(subs=(2, 5)))
        axis.set_minor_formatter("{x:g}")
        axis.set_major_formatter("{x:g}")


def draw_groups(axes, result, panel, columns, draw_bars, key_width):
    """One row of the result beside another: groups below one another, the series of each side by side.

    Of the columns the middle one is the value; draw_bars(values, place, color) draws the others. Dashed: published
    figures.
    """
    value = columns[len(columns) // 2]
    selected = select(result["rows"], panel["rows"])
    groups = distinct(selected, panel["group"])
    series = list(styled_series(result, selected, panel["series"]))
    rows = [row for row in selected if row.get(value) is not None]

    def is_filled(row):
        beyond_rounding = abs(row[value]) > MEANINGFUL_RADII * radius_of(result, row, value)
        return row[value] > 0 and beyond_rounding if panel.get("log") else beyond_rounding or row[value] == 0

    shown = [row.get(column) or 0 for row in rows if is_filled(row) for column in columns]
    floor = floor_of([value for value in shown if value > 0])
    handles = []
    for index, (name, style) in enumerate(series):
        offset = (index - (len(series) - 1) / 2) * 0.8 / len(series)
        own = select(rows, {panel["series"]: name})
        for row in own:
            place = groups.index(row[panel["group"]]) + offset
            values = [row.get(column) for column in columns]
            if panel.get("log"):
                values = [None if value is None else max(value, floor) for value in values]
            if is_filled(row):
                draw_bars(values, place, style["color"])
            draw_marker(axes, values[len(values) // 2], place, style, is_filled(row))
        label = words(name)
        with_printed = [row for row in own if row.get(panel.get("printed")) is not None]
        printed = {groups.index(row[panel["group"]]): row[panel["printed"]] for row in with_printed}
        dashed = {"color": style["color"], "linestyle": (0, (4, 2)), "linewidth": 0.9, "zorder": 0}
        if len(set(printed.values())) == 1:
            figure = next(iter(printed.values()))
            axes.axvline(figure, **dashed)
            label += f" (published {figure:.4g})"
        else:
            for group, figure in printed.items():
                axes.plot([figure, figure], [group - 0.5, group + 0.5], **dashed)
        key = {"color": style["color"], "marker": style["marker"], "markersize": 4, "linewidth": key_width}
        handles.append(Line2D([], [], **key, label=label))

    if panel.get("log"):
        axes.set_xscale("log")
    axes.set_yticks(range(len(groups)), [words(group) for group in groups])
    axes.set_ylim(len(groups) - 0.5, -0.5)
    for border in range(1, len(groups)):
        axes.axhline(border - 0.5, color="0.9", linewidth=0.6, zorder=0)
    if panel.get("log"):
        label_log_axis(axes.xaxis)
    axes.grid(axis="x", color="0.93", linewidth=0.6)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(panel["label"])
    show_legend(axes, handles)
    return len(groups) * (0.12 * max(len(series), 1) + 0.1), groups


def draw_quantiles(axes, result, panel):
    """A distribution per row: 5th to 95th percentile thin, 25th to 75th thick, the median a marker."""

    def draw_bars(values, place, color):
        axes.plot([values[0], values[4]], [place, place], color=color, linewidth=0.8)
        axes.plot([values[1], values[3]], [place, place], color=color, linewidth=2.6)

    columns = [f"{panel['value']}_p{percent}" for percent in ("05", "25", "50", "75", "95")]
    return draw_groups(axes, result, panel, columns, draw_bars, key_width=2.6)


def draw_points(axes, result, panel):
    """A value per row: a marker, with a bar from `low` to `high` where the panel names these columns."""

    def draw_bars(values, place, color):
        ends = [values[1] if end is None else end for end in (values[0], values[-1])]
        axes.plot(ends, [place, place], color=color, linewidth=1.2)

    columns = [panel.get("low", panel["value"]), panel["value"], panel.get("high", panel["value"])]
    return draw_groups(axes, result, panel, columns, draw_bars, key_width=0)


def finish_plane(axes, panel):
    """Scales, ranges, numbers and names of the axes x and y."""
    if panel.get("log_x"):
        axes.set_xscale("log")
    if panel.get("log_y"):
        axes.set_yscale("log")
    axes.set_xlim(panel.get("x_range"))
    axes.set_ylim(panel.get("y_range"))
    for log, axis in (("log_x", axes.xaxis), ("log_y", axes.yaxis)):
        if panel.get(log):
            label_log_axis(axis)
    axes.grid(color="0.93", linewidth=0.6)
    axes.set_xlabel(panel["label_x"])
    axes.set_ylabel(panel["label_y"])


def draw_lines(axes, result, panel):
    """A curve per series. What lies at or below the floor, exact zeros on a log axis too, stands on it, hollow; hollow is
    also what its radius hardly tells from nothing. `front`: the column that says which rows a grey line joins."""
    x, y = panel["x"], panel["y"]
    rows = [row for row in select(result["rows"], panel["rows"]) if None not in (row.get(x), row.get(y))]
    floor = panel.get("floor", -float("inf"))
    if panel.get("log_y"):
        floor = max(floor, floor_of([row[y] for row in rows if row[y] > max(floor, 0)]))
    handles = []
    if front := sorted((row[x], max(row[y], floor)) for row in rows if row.get(panel.get("front"))):
        axes.plot(*zip(*front), color="0.82", linewidth=4, solid_capstyle="round", zorder=0)
    for index, (name, style) in enumerate(styled_series(result, rows, panel["series"])):
        own = sorted(select(rows, {panel["series"]: name}), key=lambda row: row[x])
        line = {"color": style["color"], "linestyle": style["linestyle"], "linewidth": 1.1, "marker": style["marker"]}
        line |= {"markersize": 3.5, "markeredgecolor": "black", "markeredgewidth": 0.4}
        # Of many points a few carry a marker, each series at places of its own.
        spacing = len(own) // 12 + 1
        shown = [(row[x], max(row[y], floor)) for row in own]
        axes.plot(*zip(*shown), **line, markevery=(index * spacing // 3 % spacing, spacing))
        for row, (point, value) in zip(own, shown):
            if value <= floor or 0 < abs(value) <= MEANINGFUL_RADII * radius_of(result, row, y):
                draw_marker(axes, point, value, style, filled=False)
        handles.append(Line2D([], [], **line, label=words(name)))
    finish_plane(axes, panel)
    show_legend(axes, handles)
    return 2.4, None


def draw_scatter(axes, result, panel):
    """A marker for each row. `diagonal`: a grey line where x and y are equal."""
    x, y = panel["x"], panel["y"]
    rows = [row for row in select(result["rows"], panel["rows"]) if None not in (row.get(x), row.get(y))]
    handles = []
    for name, style in styled_series(result, rows, panel["series"]):
        own = select(rows, {panel["series"]: name})
        marks = {"color": style["color"], "linestyle": "none", "marker": style["marker"], "markersize": 3.5}
        marks |= {"markeredgecolor": "black", "markeredgewidth": 0.3}
        axes.plot([row[x] for row in own], [row[y] for row in own], alpha=0.75, **marks)
        handles.append(Line2D([], [], **marks, label=words(name)))
    finish_plane(axes, panel)
    if panel.get("diagonal"):
        ends = [min(axes.get_xlim()[0], axes.get_ylim()[0]), max(axes.get_xlim()[1], axes.get_ylim()[1])]
        axes.plot(ends, ends, color="0.7", linewidth=0.8, zorder=0, scalex=False, scaley=False)
    show_legend(axes, handles)
    return 2.4, None


def draw_image(axes, result, panel):
    """A picture: a row of the result for each of its lines, 8-bit grays or colours in hexadecimal."""
    lines = [row for row in select(result["rows"], panel["rows"]) if row.get(panel["line"]) is not None]
    lines.sort(key=lambda row: row[panel["line"]])
    pixels = [list(bytes.fromhex(row[panel["pixels"]])) for row in lines]
    if panel.get("is_color"):
        pixels = [[line[i : i + 3] for i in range(0, len(line), 3)] for line in pixels]
    axes.imshow(pixels, cmap="gray", vmin=0, vmax=255, interpolation="none")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.set_xlabel(panel["label"])
    return 2.4, None


PANELS = {
    "quantiles": draw_quantiles,
    "points": draw_points,
    "lines": draw_lines,
    "scatter": draw_scatter,
    "image": draw_image,
}


def has_data(result, panel):
    """Whether a row of the panel has the values that it shows."""
    shown = {"image": ["line"], "lines": ["x", "y"], "scatter": ["x", "y"]}.get(panel["kind"], ["value"])
    columns = [panel[name] + ("_p50" if panel["kind"] == "quantiles" else "") for name in shown]
    return any(all(row.get(column) is not None for column in columns) for row in select(result["rows"], panel["rows"]))


def why_without_data(result, panel):
    """Which rows the panel lacks: those of refused fields that could be among them, each with its reason."""

    def could_match(row, key, wanted):
        return row.get(key) is None or row[key] in (wanted if isinstance(wanted, list) else [wanted])

    # A refused row names its field, not the view of it that the panel shows.
    views = {view.get("name"): view.get("field") for measure in result["experiment"]["measures"] for view in measure.get("views", [])}
    asked = panel["rows"].get("view", [])
    fields = [views.get(view) for view in (asked if isinstance(asked, list) else [asked])]
    refused = [row for row in result["rows"] if row.get("status") == "refused" and (not fields or row.get("field") in fields)]
    absent = [row for row in refused if all(could_match(row, key, wanted) for key, wanted in panel["rows"].items())]
    reasons = list(dict.fromkeys(f"{row.get('field') or row['measure']}: {row.get('why')}" for row in absent))
    wanted = ", ".join(f"{key} {words(value) if isinstance(value, (str, float, int)) else value}" for key, value in panel["rows"].items())
    return "\n".join(reasons) if reasons else f"no row with {wanted} has what this shows"


def draw_absence(axes, result, panel):
    """In place of a panel: that its rows are absent, and why."""
    text = "\n".join(textwrap.fill(line, 44) for line in ["No data", *why_without_data(result, panel).splitlines()])
    axes.text(0.5, 0.5, text, fontsize=6.5, color="0.3", ha="center", va="center", transform=axes.transAxes, wrap=False)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.set_xlabel(panel.get("label") or f"{panel['label_x']}: {panel['label_y']}")
    # As high as it would be with its rows, where that does not depend on them: the others keep their sizes.
    return max(1.0 if "group" in panel else 2.4, 0.11 * len(text.splitlines())), None


def refused_rows(result):
    """One line for each field that could not be measured at all."""
    measured = distinct([row for row in result["rows"] if row.get("status") != "refused"], "field")
    refused = [row for row in result["rows"] if row.get("field") not in measured and row.get("status") == "refused"]
    return [f"{field}: refused" for field in distinct(refused, "field")]


def draw(result):
    plot = result["experiment"]["plot"]
    panels = plot["panels"]
    columns = min(plot.get("columns", 2), len(panels))
    lines = -(-len(panels) // columns)
    figure, all_axes = plt.subplots(lines, columns, squeeze=False)
    heights = [0] * lines
    for place, axes in enumerate(all_axes.flat):
        line, column = divmod(place, columns)
        if place >= len(panels):
            axes.set_visible(False)
            continue
        draw_panel = PANELS[panels[place]["kind"]] if has_data(result, panels[place]) else draw_absence
        height, groups = draw_panel(axes, result, panels[place])
        heights[line] = max(heights[line], height)
        if column == 0:
            first_groups = groups
        elif groups is not None:
            axes.tick_params(labelleft=groups != first_groups)
    width = max(PANEL_WIDTH * columns, LEAST_WIDTH)
    title = textwrap.fill(plot["title"], int(14 * width))
    notes = [plot["note"]] if "note" in plot else []
    notes += ["; ".join(refused_rows(result))] if refused_rows(result) else []
    note = "\n".join(textwrap.fill(text, int(20 * width)) for text in notes)
    handles, entries = share_legend(figure, list(all_axes.flat)[: len(panels)], width)

    # In inches: the title, below it the legend, at the bottom the note.
    top = 0.17 * len(title.splitlines()) + 0.16
    legend = 0.16 * -(-len(handles) // entries) + 0.12 if handles else 0
    bottom = 0.12 * len(note.splitlines()) + 0.1
    height = sum(heights) + (0.6 if handles else 1) * lines + top + legend + bottom
    figure.set_size_inches(width, height)
    all_axes[0][0].get_gridspec().set_height_ratios(heights)
    figure.suptitle(title, fontsize=9, y=1 - 0.1 / height, in_layout=False)
    if handles:
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, 1 - top / height), "borderaxespad": 0}
        figure.legend(handles=handles, ncol=entries, fontsize=7, **place)
    figure.supxlabel(note, fontsize=6.5, color="0.3", y=0.06 / height, in_layout=False)
    figure.tight_layout(rect=(0, bottom / height, 1, 1 - (top + legend) / height))
    return figure


def main():
    file_format, *files = sys.argv[1:]
    metadata = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(file_format, {})
    for source, output in zip(files[::2], files[1::2]):
        try:
            with open(source, encoding="utf-8") as file:
                result = json.load(file)
            figure = draw(result)
            try:
                figure.savefig(output, format=file_format, dpi=200, metadata=metadata)
            except OSError as error:
                print(f"cannot be written: {source}: {error.strerror or error}".replace("\n", " "), file=sys.stderr, flush=True)
                if os.path.exists(output):
                    os.remove(output)
        except Exception as error:  # whatever it is, the other plots are drawn
            print(f"cannot be drawn: {source}: {type(error).__name__}: {error}".replace("\n", " "), file=sys.stderr, flush=True)
            if os.path.exists(output):
                os.remove(output)
        plt.close("all")


main()
