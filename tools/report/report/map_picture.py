"""The map: the tracks of all runs over a truth, on a scale, with gaps, start, end, and what lies outside."""
import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from matplotlib.lines import Line2D

from . import style
from .gaps import gaps, was_answered
from .labels import Labels
from .map_marks import draw_graticule, draw_scale_and_arrow
from .map_view import extent, horizontal_sigma, speed

COLORS_BY = ("source", "sigma", "speed")
MAP_INCH = (8.6, 8.2)  # the largest width and height of the map itself
SHORTEST_GAP_S = 0.5  # a shorter one is no gap to the eye
MOST_LABELS = 15
MAP_COLORS = ListedColormap(matplotlib.colormaps["viridis"](np.linspace(0.0, 0.9, 256)))  # the last ones are too light on white


class Track:
    """One run on the map."""

    def __init__(self, run, offset, frame):
        self.run, self.label, self.table = run, run.label, run.solution
        self.north, self.east = frame.of(run.solution)[:2] - offset[:2]
        finite = np.isfinite(self.north + self.east)
        ok = finite & was_answered(run.solution)  # what was only predicted is no track, but a gap
        if not ok.any():
            ok = finite
        self.north, self.east = np.where(ok, self.north, np.nan), np.where(ok, self.east, np.nan)
        self.ok, self.time = ok, run.solution.time
        found = run.solution_gaps if run.continuous else gaps(self.time[ok])
        self.gaps = [(begin, end) for begin, end in found if end - begin > SHORTEST_GAP_S]

    def at(self, time):
        """North and east of the row of a time."""
        row = int(np.argmin(np.where(self.ok, np.abs(self.time - time), np.inf)))
        return self.north[row], self.east[row]

    def segments(self, box):
        """The lines between rows that follow each other, and the later row of each; none across a gap, nor to a row outside the box."""
        rows = np.flatnonzero(self.ok)
        points = np.stack([self.east[rows], self.north[rows]], axis=1)
        joined = np.ones(max(len(rows) - 1, 0), dtype=bool)
        for begin, end in self.gaps:
            joined &= ~((self.time[rows[:-1]] >= begin) & (self.time[rows[1:]] <= end))
        inside = (points >= (box[0], box[2])).all(axis=1) & (points <= (box[1], box[3])).all(axis=1)
        joined &= inside[1:] & inside[:-1]
        return np.stack([points[:-1], points[1:]], axis=1)[joined], rows[1:][joined]

    def labelled_gaps(self, others):
        """Its gaps but those that another track has too: at both ends within a second."""
        return [gap for gap in self.gaps if not any(abs(gap[0] - one[0]) < 1.0 and abs(gap[1] - one[1])
                                                    < 1.0 for other in others for one in other.gaps)]


def draw_map(runs, offsets, truth, frame, color_by):
    """Returns the figure. `offsets` are rows north, east, up to take off each run; `truth` is a Table or None."""
    tracks = [Track(run, offset, frame) for run, offset in zip(runs, offsets)]
    truth_ne = frame.of(truth)[:2] if truth is not None else None
    box = extent([(one.north, one.east, one.table) for one in tracks], truth_ne)
    figure, axis, bar_axis = _page(box, color_by, 2 * len(runs) + 4)
    axis.set(xlim=box[:2], ylim=box[2:], xlabel="east (m)", ylabel="north (m)")
    axis.set_aspect("equal")
    inches = axis.get_position().width * figure.get_figwidth(), axis.get_position().height * figure.get_figheight()
    draw_graticule(axis, frame, box, (max(2, int(inches[0] / 1.5)), max(2, int(inches[1] / 1.2))))
    handles = []
    if truth is not None:
        axis.plot(truth_ne[1], truth_ne[0], color=style.LIGHT, linewidth=6, solid_capstyle="round", zorder=1)
        handles.append(Line2D([], [], color=style.LIGHT, linewidth=6, label="truth"))
    for index in range(len(tracks) - 1, 0, -1):
        handles.append(_plain(axis, tracks[index], box, style.run_style(index), 5 - 0.1 * index))
    handles = handles[:1 if truth is not None else 0] + \
        _colored(axis, tracks[0], box, color_by, bar_axis) + handles[:0:-1 if truth is not None else -1]
    points = np.concatenate([np.array([one.east, one.north]) for one in tracks], axis=1)
    labels = Labels(axis, points)
    draw_scale_and_arrow(axis, labels, box)
    handles += _marks(axis, tracks, labels)
    handles += _outside(axis, tracks, box)
    _legend_below(figure, handles)
    first, last = tracks[0].time[tracks[0].ok][[0, -1]]
    figure.text(
    axis.get_position().x0,
    1.0 -
    0.12 /
    figure.get_figheight(),
    f"{tracks[0].label}: {style.utc_text(first)}, {style.duration(last - first)}, {style.distance(_length(tracks[0], box))}",
    va="top",
    fontsize=11,
     weight="bold")
    return figure


def _legend_below(figure, handles):
    """As many columns as fit."""
    top = figure.axes[0].get_position().y0 - 0.55 / figure.get_figheight()
    for columns in (4, 3, 2, 1):
        legend = figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, top), ncol=columns, frameon=False)
        if legend.get_window_extent(figure.canvas.get_renderer()).width < figure.bbox.width or columns == 1:
            return
        legend.remove()


def _page(box, color_by, entries):
    """A figure whose map has the shape of the box; below it room for a legend, above for labels and a title, at the right for a bar."""
    width, height = box[1] - box[0], box[3] - box[2]
    scale = min(MAP_INCH[0] / width, MAP_INCH[1] / height)
    width, height = scale * width, scale * height
    left, right, bottom, top = 0.8, 0.45, 0.75 + 0.21 * (entries // 2 + 1), 0.6
    bar = 0.95 if color_by != "source" else 0.0
    total = (left + width + right + bar, bottom + height + top)
    figure = plt.figure(figsize=total)
    axis = figure.add_axes([left / total[0], bottom / total[1], width / total[0], height / total[1]])
    for side in ("top", "right"):
        axis.spines[side].set_visible(True)
    bar_axis = None
    if bar:
        bar_axis = figure.add_axes([(left + width + right) / total[0], (bottom + 0.15 * height) / \
                                   total[1], 0.18 / total[0], 0.7 * height / total[1]])
    return figure, axis, bar_axis


def _plain(axis, track, box, line, zorder):
    """A run in one colour."""
    segments, _ = track.segments(box)
    axis.add_collection(LineCollection(segments, colors=line["color"], linestyles=line["linestyle"], linewidths=1.3, zorder=zorder),
                        autolim=False)
    if len(track.time) < 2000 and len(segments) == 0:
        axis.plot(track.east, track.north, ".", color=line["color"], markersize=2.5, zorder=zorder)
    _dashes(axis, track, line["color"])
    return Line2D([], [], linewidth=1.6, label=track.label, **line)


def _colored(axis, track, box, color_by, bar_axis):
    """The first run, by who gave each answer, or by a number; returns what the legend needs."""
    segments, rows = track.segments(box)
    if color_by != "source":
        values, title = (
    horizontal_sigma(
        track.table), "horizontal 1 sigma (m)") if color_by == "sigma" else (
            speed(
                track.table), "speed (m/s)")
        values = values[rows]
        known = values[np.isfinite(values) & (values > 0)]
        lines = LineCollection(
    segments,
    array=np.ma.masked_invalid(values),
    cmap=MAP_COLORS,
    norm=_scale_of(
        known,
        color_by),
        linewidths=2.4,
        zorder=10,
         capstyle="round")
        axis.add_collection(lines, autolim=False)
        bar = axis.figure.colorbar(lines, cax=bar_axis, extend="max" if color_by == "speed" else "both")
        bar.set_label(title if len(known) or color_by == "speed" else title + ": not known")
        bar.ax.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
        bar.ax.yaxis.set_minor_formatter(plt.NullFormatter())
        _dashes(axis, track, "#444444")
        return [Line2D([], [], color="#3b528b", linewidth=2.2, label=track.label)]
    sources, handles = track.table["source"], []
    for source in [*style.SOURCE_COLORS, None]:
        mine = sources[rows] == source if source else ~np.isin(sources[rows], list(style.SOURCE_COLORS))
        if not mine.any():
            continue
        color = style.SOURCE_COLORS.get(source, style.BLUE)
        axis.add_collection(LineCollection(segments[mine], colors=color, linewidths=2.2, zorder=10, capstyle="round"), autolim=False)
        name = f"{track.label}: {style.SOURCE_NAMES[source]}" if source else track.label
        handles.append(Line2D([], [], color=color, linewidth=2.2, label=name))
    _dashes(axis, track, "#444444")
    return handles


def _scale_of(known, color_by):
    """From 0 for a speed; from the smallest for a sigma, by its logarithm where it varies much. The last hundredth is beyond."""
    if not len(known):
        return Normalize(0.0, 1.0)
    low, high = np.percentile(known, (1, 99))
    if color_by == "speed":
        return Normalize(0.0, max(high, 0.1))
    return LogNorm(low, high) if high > 5.0 * low else Normalize(0.9 * low, 1.1 * high)


def _dashes(axis, track, color):
    for begin, end in track.gaps:
        (n0, e0), (n1, e1) = track.at(begin), track.at(end)
        axis.plot([e0, e1], [n0, n1], color=color, linewidth=1.1, linestyle=(0, (4, 3)), zorder=9)


def _marks(axis, tracks, labels):
    """Start and end of the first run, and the durations of the longest gaps of all."""
    track = tracks[0]
    times = track.time[track.ok]
    for time, text, mark in ((times[0], "start", "o"), (times[-1], "end", "s")):
        n, e = track.at(time)
        axis.plot(e, n, mark, color="white", markeredgecolor="black", markeredgewidth=1.4, markersize=7.5, zorder=30)
        labels.place(e, n, text, must=True, fontsize=9.5, weight="bold")
    some = [(end - begin, begin, end, one, index) for index, one in enumerate(tracks) for begin, end in one.labelled_gaps(tracks[:index])]
    some.sort(key=lambda gap: -gap[0])
    for length, begin, end, one, index in some[:MOST_LABELS]:
        (n0, e0), (n1, e1) = one.at(begin), one.at(end)
        labels.place(0.5 * (e0 + e1), 0.5 * (n0 + n1), style.duration(length), fontsize=8.5,
                     color=style.run_style(index)["color"] if index else "#333333")
    return [Line2D([], [], color="#444444", linewidth=1.1, linestyle=(0, (4, 3)), label="no solution, for how long")] if some else []


def _outside(axis, tracks, box):
    """Arrows at the edge towards positions that are not on the map; returns what the legend says of them."""
    handles = []
    for index, track in enumerate(tracks):
        n, e = track.north[track.ok], track.east[track.ok]
        out = (e < box[0]) | (e > box[1]) | (n < box[2]) | (n > box[3])
        if not out.any():
            continue
        color = style.run_style(index)["color"]
        far = np.hypot(np.maximum(np.maximum(box[0] - e, e - box[1]), 0.0), np.maximum(np.maximum(box[2] - n, n - box[3]), 0.0))[out].max()
        axis.plot(np.clip(e[out], *box[:2]), np.clip(n[out], *box[2:]), "X", color=color,
                  markeredgecolor="white", markersize=7, clip_on=False, zorder=45)
        handles.append(Line2D([], [], linestyle="", marker="X", color=color, markersize=7,
                              label=f"outside the map: {out.sum()} of {track.label}, up to {style.distance(far)}"))
    return handles


def _length(track, box):
    """The way in m, without what lies in gaps, where the vehicle moved faster than its noise."""
    v = speed(track.table)
    if np.isfinite(v).any():
        step = np.diff(track.time)
        usable = np.isfinite(v[1:]) & (step < 5.0) & track.ok[1:] & track.ok[:-1]
        return float(np.sum(v[1:][usable] * step[usable]))
    segments, _ = track.segments(box)
    return float(np.sum(np.hypot(*(segments[:, 1] - segments[:, 0]).T)))
