"""What runs tell of themselves: satellites and dilution of precision, and sigma with protection levels."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D

from . import style
from .gaps import gaps
from .map_view import horizontal_sigma

LEVEL_DASHES = (0, (4, 2))


def draw_satellites(runs, start, length):
    """Returns the figure: satellites used and PDOP over time."""
    figure, axes = plt.subplots(2, 1, figsize=(11, 5.8), sharex=True)
    tops = []
    for index, run in enumerate(runs):
        table = run.epochs if run.epochs is not None and "satellites" not in run.solution else run.solution
        t, found = table.time - start, gaps(table.time, 1.0) - start
        for axis, name, steps in ((axes[0], "satellites", "steps-post"), (axes[1], "pdop", "default")):
            axis.plot(*style.over_gaps(t, table[name], found), drawstyle=steps, linewidth=1.3, zorder=20 - index,
                      **style.run_style(index))
        pdop = table["pdop"][np.isfinite(table["pdop"])]
        if len(pdop):
            tops.append(np.percentile(pdop, 99))
    axes[0].set(ylabel="satellites used", title="Satellites and dilution of precision")
    axes[0].set_ylim(bottom=0)
    axes[1].set(ylabel="PDOP")
    axes[1].set_ylim(0, max(1.5 * max(tops, default=1.0), 2.0))
    style.time_axis(axes[1], start, length)
    style.legend_above(figure, [Line2D([], [], label=run.label, **style.run_style(index)) for index, run in enumerate(runs)])
    return figure


def draw_sigma(runs, errors, start, length):
    """Returns the figure: sigma, protection level, and error where there is a truth; None where no run has a sigma."""
    if not any(np.isfinite(run.solution["std_north_m"]).any() for run in runs):
        return None
    figure, axes = plt.subplots(2, 1, figsize=(11, 6.2), sharex=True)
    horizontal = [(horizontal_sigma(run.solution), run.solution["protection_horizontal_m"],
                   None if errors is None else np.hypot(*errors[index][:2])) for index, run in enumerate(runs)]
    vertical = [(run.solution["std_down_m"], run.solution["protection_vertical_m"], None if errors is None else np.abs(errors[index][2]))
                for index, run in enumerate(runs)]
    _draw_row(axes[0], runs, horizontal, start, "horizontal (m)")
    _draw_row(axes[1], runs, vertical, start, "vertical (m)")
    axes[0].set_title("Accuracy as the runs tell it")
    style.time_axis(axes[1], start, length)
    handles = [Line2D([], [], label=run.label, **style.run_style(index)) for index, run in enumerate(runs)]
    handles.append(Line2D([], [], color="#777777", linewidth=1.5, label="1 sigma"))
    if any(np.isfinite(level).any() for _, level, _ in horizontal + vertical):
        handles.append(Line2D([], [], color="#777777", linewidth=1.2, linestyle=LEVEL_DASHES, label="protection level"))
    if errors is not None:
        handles.append(Line2D([], [], color="#777777", linewidth=0.7, alpha=0.6, label="error"))
    style.legend_above(figure, handles)
    return figure


def _draw_row(axis, runs, quantities, start, name):
    """Sigma, level and error of all runs on one axis."""
    known = []
    for index, (run, (sigma, level, error)) in enumerate(zip(runs, quantities)):
        time, color = run.solution.time, style.run_style(index)["color"]
        found = gaps(time, 1.0) - start

        def draw(values, zorder, **line):
            axis.plot(*style.over_gaps(time - start, values, found), color=color, zorder=zorder - index, **line)
        draw(sigma, 20, linewidth=1.5)
        draw(level, 19, linewidth=1.2, linestyle=LEVEL_DASHES)
        if error is not None:
            draw(error, 10, linewidth=0.7, alpha=0.45)
        known += [values[np.isfinite(values) & (values > 0)] for values in (sigma, level)]
    known = [values for values in known if len(values)]
    axis.set_yscale("log")
    if known:  # errors go down to nothing and far beyond: they do not set the limits
        axis.set_ylim(0.15 * min(np.percentile(values, 1) for values in known), 4.0 * max(np.percentile(values, 99) for values in known))
    axis.yaxis.set_major_formatter(plt.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.yaxis.set_minor_formatter(plt.NullFormatter())
    axis.set_ylabel(name)
