"""The sky plot: a track for each satellite, by system, with what was left out and where signals were lost."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import style
from .labels import Labels
from .sky import horizon, lost_share, sky_tracks

KIND_MARKS = {"weakened": dict(marker="o", markerfacecolor="white", markeredgewidth=0.9, markersize=3.6),
              "rejected": dict(marker="x", markeredgewidth=1.2, markersize=4.5, color="black")}
MARK_PIXELS = 7.0  # that marks of a kind are apart on one track
SHADES = LinearSegmentedColormap.from_list("lost", ["#ffffff", "#6d6d6d"])


def draw_sky(run):
    """Returns the figure; None where no satellite has a direction."""
    tracks = [one for one in sky_tracks(run.satellites) if style.system_of(one.satellite) and (one.elevation > -5.0).any()]
    if not tracks:
        return None
    figure = plt.figure(figsize=(9.6, 7.6))
    axis = figure.add_axes([0.06, 0.06, 0.66, 0.84], projection="polar")
    axis.set_theta_zero_location("N")
    axis.set_theta_direction(-1)
    axis.set_ylim(0, 90)
    axis.set_yticks([30, 60, 90])
    axis.set_yticklabels([])
    axis.set_xticks(np.radians(np.arange(0, 360, 30)))
    axis.set_xticklabels(["N", "30°", "60°", "E", "120°", "150°", "S", "210°", "240°", "W", "300°", "330°"])
    azimuth, elevation, share = lost_share(tracks)
    shades = axis.pcolormesh(np.radians(azimuth), 90.0 - elevation, np.ma.masked_invalid(100.0 * share.T), cmap=SHADES, vmin=0, vmax=100,
                             zorder=0.1, linewidth=0)
    axis.grid(color="#c9c9c9", linewidth=0.7)
    top = horizon(azimuth, elevation, share)
    _draw_horizon(axis, azimuth, top)
    for track in tracks:
        _draw_track(axis, track)
    points = np.concatenate([[np.radians(one.azimuth), 90.0 - one.elevation] for one in tracks], axis=1)
    labels = Labels(axis, points)
    for text, radius in (("90°", 0), ("60°", 30), ("30°", 60)):
        labels.place(np.radians(15), radius, text, fontsize=8, color="#666666")
    for track in sorted(tracks, key=lambda one: -len(one.time)):
        last = np.flatnonzero(track.elevation >= 0.0)
        if len(last):
            labels.place(np.radians(track.azimuth[last[-1]]),
    90.0 - track.elevation[last[-1]],
    track.satellite,
    must=len(tracks) < 60,
    fontsize=8,
    weight="bold",
     color=style.SYSTEM_COLORS[style.system_of(track.satellite)])
    _legend(figure, tracks, shades, np.isfinite(top).any())
    figure.text(0.03, 0.965, f"{run.label}: sky seen from the antenna, centre is the zenith", fontsize=11, weight="bold", va="center")
    return figure


def _draw_horizon(axis, azimuth, top):
    """The outline of where signals were lost: an arc for each sector, joined where neighbours have one too."""
    theta, radius = [], []
    for index, elevation in enumerate(top):
        arc = np.radians(np.linspace(azimuth[index], azimuth[index + 1], 6))
        theta += [*arc]
        radius += [90.0 - elevation] * len(arc)
    axis.plot(theta, radius, color="black", linewidth=1.6, zorder=6)


def _draw_track(axis, track):
    system = style.system_of(track.satellite)
    color = style.SYSTEM_COLORS[system]
    theta, radius = np.radians(track.azimuth), 90.0 - track.elevation
    for kinds, line in ((("used", "weakened", "rejected"), dict(color=color, linewidth=2.4, solid_capstyle="round", zorder=8)),
                        (("lost",), dict(color=color, linewidth=0.9, linestyle=(0, (1, 1.5)), zorder=7)),
                        (("left out",), dict(color="#9a9a9a", linewidth=1.1, zorder=7))):
        mine = np.isin(track.kind, kinds) & (track.elevation >= 0.0)
        mine |= np.concatenate([[False], mine[:-1]]) & (track.elevation >= 0.0)  # on to the next point, so that no line has holes
        axis.plot(np.where(mine, theta, np.nan), np.where(mine, radius, np.nan), **line)
    for kind, mark in KIND_MARKS.items():
        rows = np.flatnonzero((track.kind == kind) & (track.elevation >= 0.0))
        rows = _apart(axis, theta, radius, rows)
        axis.plot(theta[rows], radius[rows], linestyle="", zorder=9, **
                  {"markeredgecolor": color if kind == "weakened" else "black", **mark})
    shown = np.flatnonzero(track.elevation >= 0.0)
    if len(shown):
        axis.plot(theta[shown[-1]], radius[shown[-1]], style.SYSTEM_MARKS[system],
                  color=color, markeredgecolor="white", markersize=7, zorder=10)


def _apart(axis, theta, radius, rows):
    """Those rows whose marks would not lie on each other."""
    kept, last = [], None
    for row, point in zip(rows, axis.transData.transform(np.stack([theta[rows], radius[rows]], axis=1))):
        if last is None or np.hypot(*(point - last)) >= MARK_PIXELS:
            kept.append(row)
            last = point
    return np.array(kept, dtype=int)


def _legend(figure, tracks, shades, has_horizon):
    handles = []
    for system, color in style.SYSTEM_COLORS.items():
        count = sum(style.system_of(one.satellite) == system for one in tracks)
        if count:
            handles.append(
    Line2D(
        [],
        [],
        color=color,
        linewidth=2.4,
        marker=style.SYSTEM_MARKS[system],
        markersize=8,
        markeredgecolor="white",
         label=f"{system}: {count} satellites"))
    kinds = np.concatenate([one.kind for one in tracks])
    if (kinds == "weakened").any():
        handles.append(Line2D([], [], linestyle="", markeredgecolor="#444444", label="down-weighted", **KIND_MARKS["weakened"]))
    if (kinds == "rejected").any():
        handles.append(Line2D([], [], linestyle="", label="rejected", **KIND_MARKS["rejected"]))
    if (kinds == "lost").any():
        handles.append(Line2D([], [], color="#444444", linewidth=0.9, linestyle=(0, (1, 1.5)), label="signal lost"))
    if (kinds == "left out").any():
        handles.append(Line2D([], [], color="#9a9a9a", linewidth=1.1, label="left out (low, no orbit, ...)"))
    if has_horizon:
        handles.append(Line2D([], [], color="black", linewidth=1.6, label="below it half or more\nof the epochs lost"))
    handles.append(Patch(facecolor="none", edgecolor="none", label="mark: where it was last"))
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.755, 0.9), frameon=False, labelspacing=0.7)
    bar_axis = figure.add_axes([0.775, 0.16, 0.17, 0.02])
    bar = figure.colorbar(shades, cax=bar_axis, orientation="horizontal")
    bar.set_label("epochs lost (%)")
    bar.set_ticks([0, 50, 100])
