"""Residuals over time: by kind in their units with three sigma, and by satellite over the RMS of its kind, with counts of rejected ones."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from . import style
from .residuals import KINDS, REJECTED, counts, kinds_of, largest, over_time, tried

MOST_DOTS = 40000  # of a kind; more are thinned evenly
BAND_BINS = 300
MAP_BINS = 240
WORST = 4.0  # RMS


def draw_residuals(run, start):
    """Returns the figure with a row for each kind; None where there is no residual."""
    table = run.measurements
    good = tried(table)
    kinds = [kind for kind in kinds_of(table) if (good & (table["observable"] == kind)).any()]
    if not kinds:
        return None
    figure, axes = plt.subplots(len(kinds), 1, figsize=(11, 0.9 + 2.6 * len(kinds)), sharex=True, squeeze=False)
    axes = axes[:, 0]
    length = table.time[-1] - start
    systems = np.array([style.system_of(one) for one in table["satellite"]], dtype=object)
    shown = [one for one in style.SYSTEM_COLORS if (good & (systems == one)).any()]
    for axis, kind in zip(axes, kinds):
        _draw_kind(axis, run, good & (table["observable"] == kind), kind, systems, start, length)
    style.time_axis(axes[-1], start, length)
    handles = [Line2D([], [], linestyle="", marker="o", markersize=5, color=style.SYSTEM_COLORS[one], label=one) for one in shown]
    handles.append(Line2D([], [], linestyle="", marker="x", color="black", label="rejected"))
    handles.append(Line2D([], [], color="#333333", linewidth=1.1, label=f"3 sigma of the {run.sigma_of}, median"))
    axes[0].set_title(f"{run.label}: residuals")
    figure.legend(handles=handles, loc="upper right", ncol=len(handles), frameon=False, bbox_to_anchor=(0.995, 0.998), columnspacing=1.2,
                  handletextpad=0.4)
    figure.tight_layout(rect=(0, 0, 1, 1.0 - 0.22 / figure.get_figheight()))
    return figure


def _draw_kind(axis, run, mine, kind, systems, start, length):
    table, (name, unit) = run.measurements, KINDS[kind]
    residual, t, sigma = table["residual"], table.time - start, table["innovation_sigma"]
    rejected = mine & np.isin(table["reason"], REJECTED)
    used = mine & ~rejected
    edges = np.linspace(t[mine].min() - 1e-3, t[mine].max() + 1e-3, min(BAND_BINS, max(2, len(np.unique(t[mine])))) + 1)
    band = 3.0 * over_time(t[mine], sigma[mine], edges, np.median)
    usual = np.percentile(np.abs(residual[used]), 99) if used.any() else 0.0
    three_sigma = np.nanmedian(band) if np.isfinite(band).any() else np.nan
    # Three sigma of an innovation may be far beyond what is left of it: of carriers, whose ambiguity is not known at first.
    limit = 1.35 * max(usual, min(np.nan_to_num(three_sigma), 4.0 * usual) if usual > 0 else np.nan_to_num(three_sigma), 1e-3)
    for system, color in style.SYSTEM_COLORS.items():
        rows = np.flatnonzero(used & (systems == system))
        rows = rows[::max(1, len(rows) * 4 // MOST_DOTS)]
        axis.plot(
    t[rows],
    residual[rows],
    style.SYSTEM_MARKS[system],
    color=color,
    markersize=1.8,
    markeredgewidth=0,
    alpha=0.6,
     rasterized=True)
    rows = np.flatnonzero(rejected)
    rows = rows[::max(1, len(rows) * 4 // MOST_DOTS)]
    # What is beyond the picture stands at its edge.
    axis.plot(t[rows], np.clip(residual[rows], -0.97 * limit, 0.97 * limit),
              "x", color="black", markersize=3.4, markeredgewidth=0.7, alpha=0.8)
    middle = 0.5 * (edges[1:] + edges[:-1])
    for sign in (1.0, -1.0):
        axis.plot(middle, sign * band, color="#333333", linewidth=1.1)
    axis.set_ylim(-limit, limit)
    axis.set_ylabel(f"{name} ({unit})")
    one = counts(table["reason"][mine])
    rms = np.sqrt(np.mean(residual[used] ** 2)) if used.any() else np.nan
    axis.set_title(f"3 sigma {three_sigma:.3g} {unit};  {one.used} used, RMS {rms:.3g} {unit};  "
                   f"{one.weakened} of them down-weighted;  {one.rejected} rejected "
                   f"({100.0 * one.rejected / max(one.total, 1):.1f} %)", loc="right", fontsize=8.5, fontweight="normal", color="#333333")


def draw_residuals_by_satellite(run, start):
    """Returns the figure: a row for each satellite, its largest residual over time, and its counts; None without residuals."""
    table = run.measurements
    good = tried(table)
    kinds = [kind for kind in kinds_of(table) if (good & (table["observable"] == kind)).any()]
    if not kinds:
        return None
    order = {letter: index for index, letter in enumerate("GECLMNO")}
    satellites = sorted(set(table["satellite"][good]), key=lambda name: (order.get(name[:1], 9), name), reverse=True)
    length = table.time[-1] - start
    edges = np.linspace(0.0, max(length, 1e-3) * (1.0 + 1e-9), MAP_BINS + 1)
    height = max(2.6, 0.9 + 0.185 * len(satellites))
    figure, axes = plt.subplots(1, len(kinds) + 1, figsize=(3.2 * len(kinds) + 2.4, height), sharey=True,
                                gridspec_kw={"width_ratios": [3.2] * len(kinds) + [1.5], "wspace": 0.1})
    figure.subplots_adjust(
    left=0.6 / figure.get_figwidth(),
    right=1.0 - 0.95 / figure.get_figwidth(),
    bottom=0.55 / height,
     top=1.0 - 0.6 / height)
    t = table.time - start
    ratio, rejected = table["residual"].copy(), np.isin(table["reason"], REJECTED)
    for kind in kinds:
        ratio[table["observable"] == kind] /= max(np.sqrt(np.mean(ratio[good & ~rejected & (table["observable"] == kind)] ** 2)), 1e-9)
    of = {name: table["satellite"] == name for name in satellites}
    image = None
    for axis, kind in zip(axes, kinds):
        mine = good & (table["observable"] == kind)
        values = np.array([over_time(t[mine & of[name] & ~rejected], ratio[mine & of[name] & ~rejected], edges, largest)
                          for name in satellites])
        image = axis.pcolormesh(edges, np.arange(len(satellites) + 1) - 0.5, np.ma.masked_invalid(values), cmap="PuOr", vmin=-WORST,
                                vmax=WORST, rasterized=True)
        for row, name in enumerate(satellites):
            some = t[mine & of[name] & rejected]
            axis.plot(some, np.full(len(some), row), "|", color="black", markersize=5.5, markeredgewidth=0.6)
        axis.set_facecolor("#f4f4f4")
        axis.grid(False)
        axis.set_title(KINDS[kind][0])
        style.time_axis(axis, start, length, ticks=4, label=False, until=0.9)
    axes[0].set_yticks(range(len(satellites)))
    axes[0].set_yticklabels(satellites, fontsize=8, fontfamily="monospace")
    axes[0].set_ylim(-0.6, len(satellites) - 0.4)
    axes[(len(kinds) - 1) // 2].set_xlabel(f"time since {style.utc_text(start)} ({'h:mm:ss' if length >= 3600 else 'min:s'})")
    _draw_counts(axes[-1], [counts(table["reason"][good & of[name]]) for name in satellites])
    bar = figure.colorbar(image, cax=figure.add_axes([1.0 - 0.62 / figure.get_figwidth(), 0.55 / height, 0.14 / figure.get_figwidth(),
                                                      1.0 - 1.15 / height]), extend="both")
    bar.set_label("residual / RMS of its kind")
    figure.text(
    0.1 / figure.get_figwidth(),
    1.0 - 0.14 / height,
    f"{run.label}: residuals by satellite (black: rejected)",
    fontsize=11,
    weight="bold",
     va="center")
    return figure


def _draw_counts(axis, all_counts):
    """Bars of what was rejected and down-weighted of each satellite, in percent."""
    rows = np.arange(len(all_counts))
    weakened = np.array([100.0 * one.weakened / max(one.total, 1) for one in all_counts])
    rejected = np.array([100.0 * one.rejected / max(one.total, 1) for one in all_counts])
    axis.barh(rows, rejected, color="black", height=0.62)
    axis.barh(rows, weakened, left=rejected, color=style.SKY, height=0.62)
    right = max(5.0, 1.3 * (weakened + rejected).max())
    for row, one in enumerate(all_counts):
        axis.text(weakened[row] + rejected[row] + 0.03 * right, row, f"{one.rejected}", va="center", fontsize=7.5, color="#333333")
    axis.set_xlim(0, right)
    axis.tick_params(left=False)
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("%")
    axis.set_title("black: rejected, number\nblue: down-weighted", fontsize=8.5, fontweight="normal")
    axis.title.set_color("#333333")
