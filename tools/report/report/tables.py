"""Reads the tables of leonav's programs, and RTKLIB's .pos files, into columns of numpy arrays."""
import csv
import math

import numpy as np

from .errors import ReportError

WEEK_S = 604800.0
LATEST_S = 10_000 * WEEK_S  # leonav takes no later times
POSITION = ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m")
SOLUTION = POSITION + ("v_north_m_s", "v_east_m_s", "v_down_m_s", "std_north_m", "std_east_m", "std_down_m", "satellites", "pdop",
                       "protection_horizontal_m", "protection_vertical_m")
TEXTS = ("source", "satellite", "reason", "observable", "signals", "event", "status", "why", "orbit")
POS_COLUMNS = ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m", "quality", "satellites", "std_north_m",
               "std_east_m", "std_down_m")


class Table:
    """Columns of one length in the order of their times, which are seconds of GPS time since 1980-01-06."""

    def __init__(self, path, columns):
        """Keeps the rows that have a time: finite, from 1980 on, in the first 10,000 weeks."""
        with np.errstate(invalid="ignore", over="ignore"):
            time = columns["gps_week"] * WEEK_S + columns["gps_tow_s"]
            rows = np.flatnonzero((time > 0.0) & (time < LATEST_S))
        rows = rows[np.argsort(time[rows], kind="stable")]
        self.path, self.time = path, time[rows]
        self.columns = {name: column[rows] for name, column in columns.items()}

    def __len__(self):
        return len(self.time)

    def __contains__(self, name):
        return name in self.columns

    def __getitem__(self, name):
        """A column; NaN, or "" of a text, where the table does not have it."""
        if name in self.columns:
            return self.columns[name]
        return np.full(len(self), "", dtype=object) if name in TEXTS else np.full(len(self), np.nan)

    def rows(self, mask):
        """The table of those rows only."""
        return Table(self.path, {name: column[mask] for name, column in self.columns.items()})


def number(text, path, line, name):
    """A field as a number; what is empty or not finite is NaN."""
    try:
        value = float(text) if text else math.nan
    except ValueError:
        raise ReportError(f"{path}:{line}: '{text[:40]}' is no number ({name}); delete or mend the line") from None
    return value if math.isfinite(value) else math.nan


def lines_of(path):
    """The lines of a text file."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            return file.read().splitlines()
    except OSError as error:
        raise ReportError(f"{path}: {error.strerror}; check the path") from error
    except UnicodeDecodeError:
        raise ReportError(f"{path}: is no text file; give a solution.csv, a .pos file, a journal, or a folder of leonav-replay") from None


def read_csv(path, wanted, required, tell):
    """Returns a Table of those columns of `wanted` that the file has.

    Lines with another number of fields are left out, and `tell` is called with a sentence. ReportError names the line of a field that
    is no number, and the column of `required` that is missing.
    """
    rows = list(csv.reader(line.replace("\0", "") for line in lines_of(path)))
    if not rows:
        raise ReportError(f"{path}: the file is empty; did the run end with an answer?")
    for name in required:
        if name not in rows[0]:
            raise ReportError(f"{path}:1: no column '{name}'; give a solution.csv of leonav-replay or leonav-smooth")
    body = [(line, row) for line, row in enumerate(rows[1:], 2) if len(row) == len(rows[0])]
    if len(body) < len(rows) - 1:
        tell(f"{path}: {len(rows) - 1 - len(body)} incomplete lines left out")
    if not body:
        raise ReportError(f"{path}: no data below the header; did the run end with an answer?")
    columns = {}
    for index, name in enumerate(rows[0]):
        if name in TEXTS and name in wanted:
            columns[name] = np.array([row[index] for _, row in body], dtype=object)
        elif name in wanted:
            columns[name] = np.array([number(row[index], path, line, name) for line, row in body])
    return Table(path, columns)


def read_pos(path):
    """Returns an RTKLIB .pos file (latitude, longitude, height; time of week) with the columns of a solution."""
    rows = [(line, text.split()) for line, text in enumerate(lines_of(path), 1) if not text.startswith("%")]
    rows = [(line, row) for line, row in rows if len(row) >= 10 and row[0].isdigit()]
    if not rows:
        raise ReportError(f"{path}: no solution with week, time of week and sigmas in it; write it with rnx2rtkp -t=off (weeks), degrees")
    values = np.array([[number(value, path, line, name) for name, value in zip(POS_COLUMNS, row)] for line, row in rows]).T
    return Table(path, dict(zip(POS_COLUMNS, values)))
