"""What all pictures share: colours that colour-blind people tell apart, fonts, and an axis of time.

Colours: Okabe and Ito, Color Universal Design, 2008, https://jfly.uni-koeln.de/color/.
"""
import datetime

import matplotlib
import numpy as np
from matplotlib.ticker import FuncFormatter, MultipleLocator

from leonav.gps_time import NS_PER_S, unix_ns

BLACK, GREY, ORANGE, SKY, GREEN = "#000000", "#8c8c8c", "#e69f00", "#56b4e9", "#009e73"
YELLOW, BLUE, VERMILLION, PURPLE, LIGHT = "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#d9d9d9"
RUN_COLORS = (BLUE, GREEN, PURPLE, VERMILLION, SKY, BLACK, ORANGE)
RUN_DASHES = ("-", "--", "-.", ":")
SOURCE_COLORS = {"smoother": BLUE, "ekf": ORANGE, "ins": VERMILLION, "prediction": BLACK, "aligning": GREY}
SOURCE_NAMES = {"smoother": "smoother", "ekf": "filter", "ins": "INS alone", "prediction": "prediction", "aligning": "aligning"}
SYSTEM_COLORS = {"GPS": BLUE, "Galileo": ORANGE, "BeiDou": GREEN, "LEO": PURPLE}
SYSTEM_MARKS = {"GPS": "o", "Galileo": "s", "BeiDou": "^", "LEO": "D"}
SYSTEM_LETTERS = {"G": "GPS", "E": "Galileo", "C": "BeiDou", "L": "LEO", "M": "LEO", "N": "LEO", "O": "LEO"}
STATUS_COLORS = {"OK": GREEN, "DEGRADED": ORANGE, "FAULT": VERMILLION}
TIME_STEPS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 900, 1200, 1800, 3600, 7200, 10800, 21600, 43200, 86400)

matplotlib.rcParams.update({
    "font.size": 9.5, "axes.titlesize": 11, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.grid": True,
    "grid.color": "#e3e3e3", "grid.linewidth": 0.7, "axes.edgecolor": "#555555", "axes.axisbelow": True, "legend.fontsize": 9,
    "legend.framealpha": 0.9, "legend.edgecolor": "#cccccc", "figure.dpi": 110, "savefig.dpi": 110, "axes.spines.top": False,
    "axes.spines.right": False, "agg.path.chunksize": 10000, "axes.formatter.useoffset": False})


def run_style(index):
    """Colour and line of the run of a number, the same in every picture."""
    return {"color": RUN_COLORS[index % len(RUN_COLORS)], "linestyle": RUN_DASHES[index // len(RUN_COLORS) % len(RUN_DASHES)]}


def system_of(satellite):
    """"G05" is of "GPS"; a satellite that is not known of none."""
    return SYSTEM_LETTERS.get(satellite[:1], "")


def utc_text(time_s):
    """UTC of GPS seconds, to the second."""
    stamp = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=int(unix_ns(int(round(time_s * NS_PER_S)))) // 1000)
    return stamp.strftime("%Y-%m-%d %H:%M:%S UTC")


def duration(seconds):
    """A duration for people: "0.05 s", "12 s", "3 min 20 s", "2 h 05 min"."""
    if seconds < 9.95:
        return f"{seconds:.2g} s"
    whole = int(round(seconds))
    if whole < 100:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    minutes = int(round(seconds / 60.0))
    return f"{minutes // 60} h {minutes % 60:02d} min"


def distance(metres):
    """A distance for people: "3 cm", "250 m", "1.2 km"."""
    if metres < 0.995:
        return f"{metres * 100.0:.2g} cm"
    return f"{metres:.3g} m" if metres < 999.5 else f"{metres / 1000.0:.4g} km"


def clock_text(seconds, with_hours):
    """Seconds since the start as m:ss or h:mm:ss."""
    sign, whole = "-" if seconds < 0 else "", abs(int(round(seconds)))
    if with_hours:
        return f"{sign}{whole // 3600}:{whole // 60 % 60:02d}:{whole % 60:02d}"
    return f"{sign}{whole // 60}:{whole % 60:02d}"


def time_axis(axis, start, length_s, ticks=9, label=True, until=1.1):
    """Gives an axis that shows seconds since `start` round ticks and, where it has a label, one that names the start in UTC.

    Ticks beyond `until`, a share of the length, have no text, where another axis follows at once.
    """
    length_s = max(length_s, 1.0)
    step = next((one for one in TIME_STEPS if length_s / one <= ticks), None)
    if step is None:
        step = 86400.0 * np.ceil(length_s / 86400.0 / ticks)
    with_hours = length_s >= 3600
    axis.set_xlim(-0.005 * length_s, 1.005 * length_s)
    axis.xaxis.set_major_locator(MultipleLocator(step))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: clock_text(value, with_hours) if value <= until * length_s else ""))
    if label:
        axis.set_xlabel(f"time since {utc_text(start)} ({'h:mm:ss' if with_hours else 'min:s'})")


def percent(share):
    """A share from 0 to 1 for people: "0 %", "<1 %", "12 %"."""
    return "<1 %" if 0 < share < 0.01 else f"{100.0 * share:.0f} %"


def over_gaps(time, values, found):
    """A series with a NaN in each of its gaps, so that no line crosses them."""
    if not len(found):
        return time, values
    rows = np.searchsorted(time, found[:, 0], side="right")
    return np.insert(time, rows, 0.5 * (found[:, 0] + found[:, 1])), np.insert(values.astype(float), rows, np.nan)


def legend_above(figure, handles, columns=6):
    """Lays out a figure with its legend above its axes."""
    figure.tight_layout(rect=(0, 0, 1, 1.0 - 0.22 * (-(-len(handles) // columns)) / figure.get_figheight()))
    figure.legend(handles=handles, loc="upper right", ncol=columns, frameon=False, columnspacing=1.4, borderaxespad=0.3)
