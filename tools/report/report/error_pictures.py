"""Errors against a truth: over time with three sigma, and their distribution."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from . import style
from .gaps import gaps


def errors_against(table, north_east_up, truth, truth_neu, longest_hole_s):
    """Rows north, east, up of a track less its truth; NaN where the truth has a hole longer than longest_hole_s or none at all."""
    at = np.array([np.interp(table.time, truth.time, row, left=np.nan, right=np.nan) for row in truth_neu])
    if len(truth) > 1:
        after = np.clip(np.searchsorted(truth.time, table.time), 1, len(truth) - 1)
        at[:, truth.time[after] - truth.time[after - 1] > longest_hole_s] = np.nan
    return north_east_up - at


def draw_errors(runs, errors, start, length):
    """Returns the figure with rows north, east, up. The first run lies on top: it is the one that the others are held against."""
    figure, axes = plt.subplots(3, 1, figsize=(11, 7.6), sharex=True)
    for row, name in enumerate(("north", "east", "up")):
        axis, limit = axes[row], 0.0
        for index, (run, error) in enumerate(zip(runs, errors)):
            t, line = run.solution.time - start, style.run_style(index)
            found = gaps(run.solution.time, 1.0) - start
            finite = np.abs(error[row][np.isfinite(error[row])])
            limit = max(limit, np.percentile(finite, 98))
            axis.plot(*style.over_gaps(t, error[row], found), linewidth=1.1, zorder=20 - index, **line)
            bound = 3.0 * run.solution[("std_north_m", "std_east_m", "std_down_m")[row]]
            for sign in (1.0, -1.0):
                axis.plot(*style.over_gaps(t, sign * bound, found), color=line["color"], linewidth=0.7, alpha=0.55, zorder=19 - index)
            if np.isfinite(bound).any():
                limit = max(limit, 0.6 * np.nanmedian(bound))  # the bounds belong in the picture
        limit = max(2.0 * limit, 0.1)
        axis.set_ylim(-limit, limit)
        axis.set_ylabel(f"{name} (m)")
    style.time_axis(axes[2], start, length)
    axes[0].set_title("Error against the truth")
    handles = [Line2D([], [], label=run.label, **style.run_style(index)) for index, run in enumerate(runs)]
    handles.append(Line2D([], [], color="#777777", linewidth=0.7, label="3 sigma"))
    style.legend_above(figure, handles)
    return figure


def draw_distribution(runs, errors):
    """Returns the figure of the shares of epochs below an error."""
    figure, axis = plt.subplots(figsize=(8, 5))
    right = 0.0
    for index, (run, error) in enumerate(zip(runs, errors)):
        color = style.run_style(index)["color"]
        for values, dash, what in ((np.hypot(error[0], error[1]), "-", "horizontal"), (np.sqrt((error ** 2).sum(axis=0)), "--", "3D")):
            values = np.sort(values[np.isfinite(values)])
            axis.plot(values, np.arange(1, len(values) + 1) / len(values) * 100.0,
                      dash, color=color, linewidth=1.6, label=f"{run.label}, {what}")
            right = max(right, np.percentile(values, 97))
    axis.set(xlabel="error (m)", ylabel="share of epochs (%)",
             title="Cumulative distribution of the errors", xlim=(0, max(right, 1e-3)), ylim=(0, 100))
    axis.legend(loc="lower right")
    figure.tight_layout()
    return figure
