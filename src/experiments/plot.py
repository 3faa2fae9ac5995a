"""Draws the plots of results, each from its result alone: plot.py LOOK [RESULT OUTPUT PLOT]...

LOOK is a JSON object: "format" ("svg", "png" or "pdf"), and where they are asked for "width" (inches), "columns" and
"font_size" (points). The experiment inside a result says what to draw ("plot"), unless PLOT, JSON too, is not empty; colours
and markers of schemes come from the result's "styles". A kind of panel is a function in PANELS: it draws on axes, and
returns how high it is to be, its groups and its legend. A panel whose rows are not there says so. A
plot that cannot be drawn stops no other: it leaves no OUTPUT, and a line on standard error, "cannot be drawn: RESULT: why";
one that cannot be written likewise, "cannot be written: RESULT: why".
"""

import io
import itertools
import json
import math
import os
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field
from html import escape

os.environ.setdefault("SOURCE_DATE_EPOCH", "0")  # the same bytes whenever it is drawn

try:
    import matplotlib
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import to_hex, to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

PANEL_WIDTH = 3.7  # inches, as all lengths here
LEAST_WIDTH = 5.2
GAP = 0.12  # between what belongs to neighbouring panels
FONT_SIZE = 8  # points; heights below are for it

# Below this many radii a value speaks of rounding, not of what it measures: drawn hollow.
MEANINGFUL_RADII = 10

# Series that are no schemes, by order of appearance. Colour-blind readers tell the colours apart (M. Okabe and K. Ito,
# Color universal design, 2008), grayscale leaves markers and dashes.
COLORS = ["#0072B2", "#D55E00", "#009E73", "#000000", "#CC79A7", "#56B4E9", "#E69F00"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", ">"]
DASHES = ["-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)), (0, (3, 3)), (0, (6, 1, 1.2, 1, 1.2, 1))]

# Markers without an inside are too thin to be seen, and cannot be hollow: each has one that stands for it.
MARKERS_WITH_INSIDE = {"1": "8", "2": "*", "3": "h", "4": "H", "+": "P", "x": "X", "|": "d", "_": "D"}
LEAST_CONTRAST = 2  # to white, as the Web Content Accessibility Guidelines define it


@dataclass
class Panel:
    """What the figure should know of a panel that is drawn."""

    height: Callable[[float], float]  # by the width of its axes
    groups: list = None  # names along y, where there are some
    legend: list = field(default_factory=list)


def set_fonts(size):
    plt.rcParams.update(
        {
            "font.size": size,
            "axes.titlesize": size,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "xtick.minor.pad": 5,  # from shorter ticks, so that all numbers of an axis stand in line
            "ytick.minor.pad": 5,
            "svg.hashsalt": "raytruth",
            "svg.fonttype": "none",
            "pdf.fonttype": 42,  # TrueType; many publishers refuse Type 3
            "legend.frameon": False,
        }
    )


def scale():
    """By which lengths that hold text grow with it."""
    return plt.rcParams["font.size"] / FONT_SIZE


def smaller(points):
    """A size of text this much below the plot's, at its scale."""
    return (FONT_SIZE - points) * scale()


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


def name_of(result, value):
    """What is written for a value: what the plot's "names" say, or its words."""
    text = value if isinstance(value, str) else f"{value:g}"
    return result["experiment"]["plot"].get("names", {}).get(text, words(value))


def radius_of(result, row, column):
    name = result["columns"].get(column, {}).get("radius")
    return (row.get(name) if name else 0) or 0


def floor_of(values):
    """Where a log axis shows what is nothing but rounding: half a decade below the least value drawn as it is."""
    return min(values) / 3 if values else 1e-16


def contrast_to_white(color):
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in color]
    return 1.05 / (sum(weight * part for weight, part in zip((0.2126, 0.7152, 0.0722), linear)) + 0.05)


def visible_on_white(style):
    """The style with a pale colour darkened, and a marker that has an inside."""
    color = to_rgb(style["color"])
    while contrast_to_white(color) < LEAST_CONTRAST:
        color = tuple(0.95 * part for part in color)
    return {**style, "color": to_hex(color), "marker": MARKERS_WITH_INSIDE.get(style["marker"], style["marker"])}


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
            yield name, visible_on_white({**own, **scheme, "linestyle": DASHES[index % len(DASHES)]})


def draw_marker(axes, x, y, style, filled, size=4):
    axes.plot(
        [x],
        [y],
        marker=style["marker"],
        markersize=size,
        linestyle="none",
        markerfacecolor=style["color"] if filled else "white",
        markeredgecolor="black" if filled else style["color"],
        markeredgewidth=0.4 if filled else 0.8,
        clip_on=False,
        zorder=3,
    )


def label_log_axis(axis):
    """Numbers at 2 and 5 too where powers of ten alone would be one or none, and at round ones where these are."""
    low, high = axis.get_view_interval()

    def count(factors):
        return sum(low <= factor * 10.0**power <= high for power in range(-320, 309) for factor in factors)

    if high < 30 * low or count([1]) < 2:
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("{x:g}")
        axis.set_minor_locator(LogLocator(subs=(2, 5)))
        if count([1, 2, 5]) < 2:
            axis.set_major_locator(MaxNLocator(4, min_n_ticks=2))
            axis.set_minor_locator(NullLocator())


def draw_groups(axes, result, panel, columns, draw_bars, key_width):
    """One row of the result beside another: groups below one another, the series of each side by side.

    Of the columns the middle one is the value; draw_bars(values, place, color) draws the others. Dashed: published
    figures.
    """
    value = columns[len(columns) // 2]
    selected = select(result["rows"], panel["rows"])
    groups = distinct(selected, panel["group"])
    part, parts = panel.get("part", [1, 1])
    groups = groups[(part - 1) * len(groups) // parts : part * len(groups) // parts]
    series = list(styled_series(result, selected, panel["series"]))
    rows = [row for row in selected if row.get(value) is not None and row.get(panel["group"]) in groups]

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
        label = name_of(result, name)
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
    axes.set_yticks(range(len(groups)), [name_of(result, group) for group in groups])
    axes.set_ylim(len(groups) - 0.5, -0.5)
    for border in range(1, len(groups)):
        axes.axhline(border - 0.5, color="0.9", linewidth=0.6, zorder=0)
    if panel.get("log"):
        label_log_axis(axes.xaxis)
    axes.grid(axis="x", color="0.93", linewidth=0.6)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel(panel["label"])
    height = len(groups) * max(0.12 * max(len(series), 1) + 0.1, 0.17 * scale())
    return Panel(lambda width: height, groups, handles)


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


def height_of_plane(width):
    return min(2.4, max(1.6, 0.75 * width))


def covers(curves, log_y):
    """For each curve, how many of those drawn after it lie on it, two at most: at four of five points of the shorter one
    at least, to a hundredth of the panel's height."""
    values = [math.log(y) if log_y else y for curve in curves for x, y in curve]
    near = 0.01 * (max(values) - min(values)) if values else 0

    def is_on(curve, other):
        places = dict(other)
        shared = [(y, places[x]) for x, y in curve if x in places]
        close = [pair for pair in shared if abs(math.log(pair[0] / pair[1]) if log_y else pair[0] - pair[1]) <= near]
        return len(close) >= max(1, 0.8 * min(len(curve), len(other)))

    return [min(2, sum(is_on(curve, other) for other in curves[index + 1 :])) for index, curve in enumerate(curves)]


def draw_lines(axes, result, panel):
    """A curve per series. What lies at or below the floor, exact zeros on a log axis too, stands on it, hollow; hollow is
    also what its radius hardly tells from nothing. A curve on which others lie is wider and paler, with larger
    markers.
    `front`: the column that says which rows a grey line joins."""
    x, y = panel["x"], panel["y"]
    rows = [row for row in select(result["rows"], panel["rows"]) if None not in (row.get(x), row.get(y))]
    floor = panel.get("floor", -float("inf"))
    if panel.get("log_y"):
        floor = max(floor, floor_of([row[y] for row in rows if row[y] > max(floor, 0)]))
    handles = []
    if front := sorted((row[x], max(row[y], floor)) for row in rows if row.get(panel.get("front"))):
        axes.plot(*zip(*front), color="0.82", linewidth=4, solid_capstyle="round", zorder=0)
    series = list(styled_series(result, rows, panel["series"]))
    owned = [sorted(select(rows, {panel["series"]: name}), key=lambda row: row[x]) for name, style in series]
    curves = [[(row[x], max(row[y], floor)) for row in own] for own in owned]
    covered = covers([[place for place in curve if place[1] > floor] for curve in curves], panel.get("log_y"))
    for index, ((name, style), own, shown) in enumerate(zip(series, owned, curves)):
        line = {"color": style["color"], "linestyle": style["linestyle"], "marker": style["marker"]}
        line |= {"markeredgecolor": "black", "markeredgewidth": 0.4}
        own_look = {"linewidth": 1.1 + 1.8 * covered[index], "markersize": 3.5 + 2 * covered[index]}
        if covered[index]:
            own_look |= {"linestyle": "-", "alpha": 0.5}
        # Of many points a few carry a marker, each series at places of its own.
        spacing = len(own) // 12 + 1
        axes.plot(*zip(*shown), **{**line, **own_look}, markevery=(index * spacing // 3 % spacing, spacing))
        for row, (point, value) in zip(own, shown):
            if value <= floor or 0 < abs(value) <= MEANINGFUL_RADII * radius_of(result, row, y):
                draw_marker(axes, point, value, style, filled=False, size=own_look["markersize"] + 0.5)
        handles.append(Line2D([], [], **line, linewidth=1.1, markersize=3.5, label=name_of(result, name)))
    finish_plane(axes, panel)
    return Panel(height_of_plane, legend=handles)


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
        handles.append(Line2D([], [], **marks, label=name_of(result, name)))
    finish_plane(axes, panel)
    if panel.get("diagonal"):
        ends = [min(axes.get_xlim()[0], axes.get_ylim()[0]), max(axes.get_xlim()[1], axes.get_ylim()[1])]
        axes.plot(ends, ends, color="0.7", linewidth=0.8, zorder=0, scalex=False, scaley=False)
    return Panel(height_of_plane, legend=handles)


def draw_image(axes, result, panel):
    """A picture: a row of the result for each of its lines, 8-bit grays or colours in hexadecimal. `turned`: by a quarter
    turn, to the left or to the right."""
    lines = [row for row in select(result["rows"], panel["rows"]) if row.get(panel["line"]) is not None]
    lines.sort(key=lambda row: row[panel["line"]])
    pixels = [list(bytes.fromhex(row[panel["pixels"]])) for row in lines]
    if panel.get("is_color"):
        pixels = [[line[i : i + 3] for i in range(0, len(line), 3)] for line in pixels]
    if turned := panel.get("turned"):
        columns = [list(column) for column in zip(*pixels)]
        pixels = columns[::-1] if turned == "left" else [column[::-1] for column in columns]
    axes.imshow(pixels, cmap="gray", vmin=0, vmax=255, interpolation="none", aspect="auto")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.set_xlabel(panel["label"])
    return Panel(lambda width: width * len(pixels) / len(pixels[0]))


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
    place = {"ha": "center", "va": "center", "transform": axes.transAxes}
    axes.text(0.5, 0.5, text, fontsize=smaller(1.5), color="0.3", wrap=False, **place)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.set_xlabel(panel.get("label") or f"{panel['label_x']}: {panel['label_y']}")
    # As high as it would be with its rows, where that does not depend on them: the others keep their sizes.
    least = max(1.0 if "group" in panel else 0, 0.13 * scale() * len(text.splitlines()))
    return Panel(lambda width: least if "group" in panel else max(least, min(2.4, width)))


def refused_rows(result):
    """One line for each field that could not be measured at all."""
    measured = distinct([row for row in result["rows"] if row.get("status") != "refused"], "field")
    refused = [row for row in result["rows"] if row.get("field") not in measured and row.get("status") == "refused"]
    return [f"{field}: refused" for field in distinct(refused, "field")]


def sections_of(plot, asked_columns):
    """(columns, panels) of each stretch of pictures and of each of other panels, in their order."""
    columns = asked_columns or plot.get("columns", 2)
    for are_images, section in itertools.groupby(plot["panels"], lambda panel: panel["kind"] == "image"):
        section = list(section)
        yield plot.get("image_columns", columns) if are_images else columns, section


def key_of_legend(panel):
    return [(line.get_label(), line.get_color(), line.get_marker()) for line in panel.legend]


def legend_runs(row, columns, above):
    """(first, last, handles) of the legends that a row of panels needs: one for neighbours that have the same, none where
    what is above them, by twelfths of the figure's width and more, has it already."""
    runs = []
    for column, (axes, panel) in enumerate(row):
        if not panel.legend:
            continue
        if runs and runs[-1][1] == column - 1 and key_of_legend(row[runs[-1][0]][1]) == key_of_legend(panel):
            runs[-1][1] = column
        else:
            runs.append([column, column])
    for first, last in runs:
        key = key_of_legend(row[first][1])
        places = range(first * len(above) // columns, (last + 1) * len(above) // columns)
        if any(above[place] != key for place in places):
            yield first, last, row[first][1].legend
        for place in places:
            above[place] = key


def wrapped_labels(axes, texts, width, height):
    """Breaks the axes' labels, which `texts` has whole, where they are longer than the axes."""
    label_x, label_y, title = texts
    per_inch = 15 / scale()
    axes.set_xlabel(textwrap.fill(label_x, max(16, int(per_inch * width))))
    axes.set_ylabel(textwrap.fill(label_y, max(16, int(per_inch * height))))
    axes.set_title(textwrap.fill(title, max(16, int(per_inch * width))), pad=3)


def overhang(figure, axes):
    """How far what belongs to the axes reaches beyond them: left, below, right, above."""
    outer = axes.get_tightbbox(figure.canvas.get_renderer())
    inner = axes.get_window_extent()
    return [
        length / figure.dpi
        for length in (inner.x0 - outer.x0, inner.y0 - outer.y0, outer.x1 - inner.x1, outer.y1 - inner.y1)
    ]


def rows_of_legend(handles, width):
    """How many entries fit side by side, and how high they then are."""
    widest = max(len(line.get_label()) for line in handles)
    entries = max(1, min(len(handles), int(width / ((0.055 * widest + 0.5) * scale()))))
    return entries, (0.155 * -(-len(handles) // entries) + 0.08) * scale()


def draw(result, look):
    plot = result["experiment"]["plot"]
    sections = list(sections_of(plot, look.get("columns")))
    most = max(min(columns, len(panels)) for columns, panels in sections if panels[0]["kind"] != "image" or len(sections) == 1)
    width = look.get("width") or max(PANEL_WIDTH * most, LEAST_WIDTH)
    figure = plt.figure(figsize=(width, width))

    # Rows of panels, each with its columns and the legends above it.
    rows = []
    above = [None] * 840  # places along the width: every number of columns up to 8 divides them
    for columns, panels in sections:
        columns = min(columns, max(len(others) for number, others in sections if number == columns))
        for first in range(0, len(panels), columns):
            row = []
            for panel in panels[first : first + columns]:
                axes = figure.add_axes([0.1, 0.1, 0.8, 0.8], label=str(len(figure.axes)))
                draw_panel = PANELS[panel["kind"]] if has_data(result, panel) else draw_absence
                drawn = draw_panel(axes, result, panel)
                axes.set_axisbelow(True)
                if row and drawn.groups is not None:
                    axes.tick_params(labelleft=drawn.groups != row[0][1].groups)
                row.append((axes, drawn))
            texts = [
                (axes.get_xlabel(), axes.get_ylabel(), panel.get("title", ""))
                for (axes, drawn), panel in zip(row, panels[first : first + columns])
            ]
            is_pictures = panels[0]["kind"] == "image"
            rows.append((columns, is_pictures, row, texts, list(legend_runs(row, columns, above))))

    title = textwrap.fill(plot["title"], int(14 * width / scale()))
    notes = [plot["note"]] if "note" in plot else []
    notes += ["; ".join(refused_rows(result))] if refused_rows(result) else []
    note = "\n".join(textwrap.fill(text, int(20 * width / scale())) for text in notes)
    top = 0.17 * scale() * len(title.splitlines()) + 0.16
    bottom = (0.12 * len(note.splitlines()) + 0.1) * scale()

    # Labels decide how much room axes have, and axes where labels break: the second time both fit.
    for attempt in range(3):
        figure_height, legends = arrange(figure, rows, width, top, bottom)

    figure.suptitle(title, fontsize=smaller(-1), y=1 - 0.1 / figure_height)
    figure.supxlabel(note, fontsize=smaller(1.5), color="0.3", y=0.06 / figure_height)
    for handles, entries, x, y in legends:
        place = {"loc": "upper center", "bbox_to_anchor": (x / width, y / figure_height), "borderaxespad": 0}
        figure.legend(handles=handles, ncol=entries, fontsize=smaller(1), **place)
    return figure


def arrange(figure, rows, width, top, bottom):
    """Places all axes, rows below one another, columns of the same number in line; gives the figure's height and its
    legends with their places."""
    hanging = [[overhang(figure, axes) for axes, drawn in row] for columns, is_pictures, row, texts, legends in rows]
    places = []
    y = top  # from above
    legends_placed = []
    for (columns, is_pictures, row, texts, legends), own in zip(rows, hanging):
        alike = [hung for other, hung in zip(rows, hanging) if other[:2] == (columns, is_pictures)]
        left = [max((hung[column][0] for hung in alike if column < len(hung)), default=0) for column in range(columns)]
        right = [max((hung[column][2] for hung in alike if column < len(hung)), default=0) for column in range(columns)]
        if is_pictures:  # captions below them are broken to their width
            left = right = [0] * columns
        free = width - sum(left) - sum(right) - GAP * (columns + 1)
        panel_width = max(0.5, free / columns)
        starts = [GAP + left[0]]
        for column in range(1, columns):
            starts.append(starts[-1] + panel_width + right[column - 1] + GAP + left[column])
        for first, last, handles in legends:
            x0 = starts[first] - left[first]
            x1 = starts[last] + panel_width + right[last]
            entries, height = rows_of_legend(handles, x1 - x0)
            legends_placed.append((handles, entries, (x0 + x1) / 2, y, height))
        y += max((height for *others, place, height in legends_placed if place == y), default=0)
        y += max(hung[3] for hung in own)
        height = max(drawn.height(panel_width) for axes, drawn in row)
        for start, (axes, drawn), labels in zip(starts, row, texts):
            own_height = drawn.height(panel_width) if is_pictures else height
            places.append((axes, labels, start, y, panel_width, own_height))
        y += height + max(hung[1] for hung in own) + GAP
    figure_height = y + bottom
    figure.set_size_inches(width, figure_height)
    for axes, labels, x, y, panel_width, height in places:
        axes.set_position([x / width, 1 - (y + height) / figure_height, panel_width / width, height / figure_height])
        wrapped_labels(axes, labels, panel_width, height)
    return figure_height, [(handles, entries, x, figure_height - y) for handles, entries, x, y, height in legends_placed]


def description(result):
    """What the plot shows, for those who do not see it."""
    plot = result["experiment"]["plot"]
    panels = []
    for panel in plot["panels"]:
        axes = panel.get("label") or f"{panel['label_y']} against {panel['label_x']}"
        panels.append(f"{panel['title']}: {axes}" if "title" in panel else axes)
    sentences = [result["experiment"]["question"], "Panels: " + "; ".join(panels), plot.get("note", "")]
    return " ".join(sentence if sentence[-1] in ".?!" else sentence + "." for sentence in sentences if sentence)


def image_bytes(figure, result, file_format):
    """The figure as a file of this format, with its title and description in it."""
    title = result["experiment"]["plot"]["title"]
    told = description(result)
    metadata = {
        "svg": {"Date": None, "Title": title, "Description": told},
        "pdf": {"CreationDate": None, "Title": title, "Subject": told},
        "png": {"Title": title, "Description": told},
    }[file_format]
    output = io.BytesIO()
    figure.savefig(output, format=file_format, dpi=200, metadata=metadata)
    if file_format != "svg":
        return output.getvalue()
    text = output.getvalue().decode()
    return text.replace("</title>", f"</title>\n <desc>{escape(told, quote=False)}</desc>", 1).encode()


def main():
    look, *drawings = sys.argv[1:]
    look = json.loads(look)
    set_fonts(look.get("font_size", FONT_SIZE))
    for source, output, plot in zip(*[iter(drawings)] * 3):
        try:
            with open(source, encoding="utf-8") as file:
                result = json.load(file)
            if plot:
                result["experiment"]["plot"] = json.loads(plot)
            image = image_bytes(draw(result, look), result, look["format"])
            try:
                with open(output, "wb") as file:
                    file.write(image)
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
