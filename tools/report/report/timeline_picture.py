"""The picture of what happened when: health, answers, misses, gaps of inputs, events, and how long the computer took."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from . import style, timeline

ROW_INCH = 0.27
LOAD_INCH = 1.7
NARROWEST = 0.0015  # of the picture's width: a shorter span is widened so that it is seen


def draw_timeline(run, start, length):
    """Returns the figure."""
    groups = [[timeline.health_row(run)], timeline.answer_rows(run), timeline.miss_rows(run),
                                   timeline.input_rows(run), timeline.event_rows(run)]
    groups = [group for group in groups if group]
    loads = _loads(run)
    rows_inch = ROW_INCH * (sum(len(group) for group in groups) + 0.5 * len(groups))
    below = 0.6 + (LOAD_INCH + 0.35 if loads else 0.0)
    width, height = 11.0, rows_inch + below + 0.75
    figure = plt.figure(figsize=(width, height))
    left, right = 1.55 / width, 1.0 - 3.1 / width
    axis = figure.add_axes([left, below / height, right - left, rows_inch / height])
    _draw_rows(axis, groups, start, length)
    style.time_axis(axis, start, length, label=not loads)
    if loads:
        load_axis = figure.add_axes([left, 0.6 / height, right - left, LOAD_INCH / height], sharex=axis)
        axis.tick_params(labelbottom=False)
        _draw_loads(load_axis, loads, start)
        style.time_axis(load_axis, start, length)
    _legend(figure, run, groups, 1.0 - 0.33 / height)
    figure.text(0.15 / width, 1.0 - 0.17 / height, f"{run.label}: what happened when", fontsize=11, weight="bold", va="center")
    return figure


def _draw_rows(axis, groups, start, length):
    y, places, names = 0.0, [], []
    for group in groups:
        for row in group:
            for begin, end, color in row.spans:
                extra = max(0.0, NARROWEST * length - (end - begin))
                important = color == timeline.GAP_COLOR
                axis.broken_barh([(begin - start - 0.5 * extra, end - begin + extra)], (y - 0.36, 0.72), facecolor=color, linewidth=0,
                                 zorder=4 if important else 3)
            ticks = row.ticks - start
            axis.vlines(ticks, y - 0.36, y + 0.36, color=row.color, linewidth=1.0, zorder=5)
            axis.annotate(row.note, (1.0, y), xycoords=("axes fraction", "data"), xytext=(6, 0), textcoords="offset points", va="center",
                          fontsize=8.5, color="#333333", annotation_clip=False)
            places.append(y)
            names.append(row.name)
            y += 1.0
        axis.axhline(y - 0.25, color="#d0d0d0", linewidth=0.7)
        y += 0.5
    axis.set_ylim(y - 0.75, -0.75)
    axis.set_yticks(places)
    axis.set_yticklabels(names)
    axis.tick_params(axis="y", length=0)
    axis.grid(axis="y", visible=False)


def _loads(run):
    """Times of the computer from HEALTH, by their names; none where it tells none."""
    if run.health is None:
        return {}
    found = {
    "smoother, one solve": (
        run.health["worst_solve_ms"],
        style.BLUE),
        "filter, one epoch": (
            run.health["worst_ekf_ms"],
             style.ORANGE)}
    return {name: (run.health.time, values, color) for name, (values, color) in found.items() if (np.nan_to_num(values) > 0).any()}


def _draw_loads(axis, loads, start):
    for name, (time, values, color) in loads.items():
        axis.plot(time - start, np.where(values > 0, values, np.nan), color=color, linewidth=1.0, marker=".", markersize=3)
        axis.annotate(
    f"{name}:\nmedian {np.median(values[values > 0]):.3g} ms, worst {values.max():.3g} ms",
    (1.0,
    0.95 if "solve" in name else 0.4),
    xycoords="axes fraction",
    xytext=(
        6,
        0),
        textcoords="offset points",
        va="top",
        fontsize=8.5,
         color="#333333")
    axis.set_yscale("log")
    axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.yaxis.set_minor_formatter(NullFormatter())
    axis.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_ylabel("worst of\na second (ms)")


def _legend(figure, run, groups, y):
    colors = {color for group in groups for row in group for _, _, color in row.spans}
    handles = []
    if run.health is not None:
        statuses = set(run.health["status"])
        handles += [Patch(color=color, label=status) for status, color in style.STATUS_COLORS.items() if status in statuses]
    used = set(run.solution["source"])
    handles += [Patch(color=style.SOURCE_COLORS[one], label=name) for one, name in style.SOURCE_NAMES.items() if one in used]
    if style.SKY in colors:
        handles.append(Patch(color=style.SKY, label="input there"))
    handles.append(Patch(color=timeline.GAP_COLOR, label="gap"))
    figure.legend(handles=handles, loc="center left", bbox_to_anchor=(0.01, y - 0.12 / figure.get_figheight()), ncol=10, frameon=False,
                  columnspacing=1.3, handlelength=1.2)
