"""One run with all that is known of it, from a journal or from the tables of leonav-replay and leonav-smooth."""
import os

import numpy as np

from . import journal
from .errors import ReportError
from .tables import POSITION, SOLUTION, Table, read_csv, read_pos

SATELLITES = ("gps_week", "gps_tow_s", "satellite", "reason", "elevation_deg", "azimuth_deg", "cn0_dbhz")
MEASUREMENTS = ("gps_week", "gps_tow_s", "satellite", "observable", "signals", "innovation_sigma", "reason", "residual")
SMOOTHED_RESIDUALS = ("gps_week", "gps_tow_s", "satellite", "observable", "signals", "residual", "sigma", "weight_factor")
EVENTS = ("gps_week", "gps_tow_s", "event")
# What no table of a replay holds.
ONLY_IN_JOURNAL = "HEALTH, misses by their decisions, and gaps of the inputs stand in a journal only; give it with --journal PATH"


class Run:
    """What is known of one run. What is None is not known; `missing` says in sentences why, and what would help."""

    def __init__(self, label, path):
        self.label, self.path = label, path
        self.solution = None  # Table
        self.continuous = False  # whether the solution is the service's at the IMU's rate, not one row an epoch
        self.solution_gaps = np.zeros((0, 2))  # found before rows are thinned
        self.satellites = self.measurements = self.events = None  # Tables: each satellite, measurement, event
        self.epochs = None  # Table with satellites and pdop where the solution has none
        self.sigma_of = "innovation"  # whose sigma stands beside a residual
        self.health = self.decisions = None  # Tables
        self.inputs = None  # dict of times by channel
        self.missing = []


def read_run(word, prefix, tell):
    """Returns the Run that a word [LABEL=]PATH of the command line names."""
    label, equals, path = word.partition("=")
    if not equals or os.path.exists(word):
        label, path = None, word
    path = journal.name_of(path)
    folder = path if os.path.isdir(path) else os.path.dirname(os.path.abspath(path))
    if os.path.isdir(path) and os.path.exists(os.path.join(path, "solution.csv")):
        path = os.path.join(path, "solution.csv")
    elif os.path.isdir(path) and not journal.is_journal(path):
        raise ReportError(f"{folder}: neither solution.csv nor a journal's pieces in this folder; give the folder that leonav-replay --out "
                          "wrote, or a journal")
    if journal.is_journal(path):
        run = Run(label or os.path.basename(os.path.abspath(path)), path)
        journal.read_into(run, path, prefix, tell)
        if run.solution is None:
            raise ReportError(f"{path}: no SOLUTION with a position in this log; replay it with leonav-replay --out FOLDER, and give FOLDER")
        return run
    run = Run(label or os.path.basename(folder), path)
    run.solution = read_pos(path) if path.endswith(".pos") else read_csv(path, SOLUTION + ("source",), POSITION, tell)
    if os.path.basename(path) == "solution.csv":
        _read_siblings(run, folder, tell)
    else:
        run.missing.append(f"{os.path.basename(path)} has positions alone; satellites, residuals and events stand beside a solution.csv "
                           "or in a journal (--journal PATH)")
    if run.health is None:
        run.missing.append(ONLY_IN_JOURNAL)
    return run


def add_journal(run, path, prefix, tell):
    """Adds what only a journal holds, and what its tables lack, to a run."""
    path = journal.name_of(path)
    if not journal.is_journal(path):
        raise ReportError(f"{path}: this is no LCM log, and no folder with the pieces of one; give --journal the journal of leonavd")
    run.missing.clear()
    journal.read_into(run, path, prefix, tell)


def _read_siblings(run, folder, tell):
    """The tables beside a solution.csv, as leonav-replay or leonav-smooth have written them."""
    def table(name, wanted):
        path = os.path.join(folder, name)
        return read_csv(path, wanted, ("gps_week", "gps_tow_s"), tell) if _has_rows(path) else None

    run.satellites, run.events = table("satellites.csv", SATELLITES), table("events.csv", EVENTS)
    run.measurements = table("measurements.csv", MEASUREMENTS)
    if run.measurements is None:
        smoothed = table("residuals.csv", SMOOTHED_RESIDUALS)
        if smoothed is not None:
            run.sigma_of, run.measurements = "measurement", _as_measurements(smoothed)
    for what, found, name in (("sky plot", run.satellites, "satellites.csv"), ("residuals", run.measurements, "measurements.csv"),
                              ("events", run.events, "events.csv")):
        if found is None:
            run.missing.append(f"no {what}: no {name} beside {run.path}; give a folder of leonav-replay --out, or --journal PATH")


def _has_rows(path):
    """Whether a table is there with more than its header: a run without events has such a one."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return bool(file.readline() and file.readline())
    except OSError:
        return False


def _as_measurements(residuals):
    """Residuals of leonav-smooth with the names of measurements.csv: a weight of zero is an outlier, of less than one down-weighted."""
    weight = residuals["weight_factor"]
    reason = np.where(weight <= 0.0, "outlier", np.where(weight < 1.0, "downweighted", "used")).astype(object)
    columns = dict(residuals.columns)
    columns.update(reason=reason, innovation_sigma=columns.pop("sigma"))
    return Table(residuals.path, columns)
