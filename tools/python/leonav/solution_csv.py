"""Reads solution.csv of leonav-replay and leonav-smooth."""
import warnings

import numpy as np
import pandas as pd

from . import gps_time
from .errors import LeonavError, LeonavWarning

REQUIRED = ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m")


def read_solution(path):
    """Returns the rows of a solution.csv as a DataFrame with its columns and `utc`.

    Also reads truth.csv, smoothed.csv, filter.csv and forward.csv, which have the same columns. Fields that are empty are NaN.
    Columns are found by name; those that are not known stay, but for one with the name `utc`, which is made anew. Rows with another number of fields, or without time or position, are left
    out with a LeonavWarning that names the first line. LeonavError says which column is missing or that no row can be used.
    """
    try:
        with open(path, encoding="utf-8", newline="") as file:
            lines = file.read().splitlines()
    except OSError as error:
        raise LeonavError(f"{path}: {error.strerror}; check the path") from error
    except UnicodeDecodeError as error:
        raise LeonavError(f"{path}: byte {error.start}: this is no text; give a solution.csv, and read logs with read_log") from error
    names = lines[0].strip().split(",") if lines else []
    missing = [name for name in REQUIRED if name not in names]
    if missing:
        raise LeonavError(f"{path}:1: no column '{missing[0]}'; give a solution.csv of leonav-replay or leonav-smooth")
    rows = [(number, line.split(",")) for number, line in enumerate(lines[1:], 2) if line.strip()]
    whole = [(number, fields) for number, fields in rows if len(fields) == len(names)]
    frame = pd.DataFrame({name: _column(path, name, [fields[i] for _, fields in whole], [number for number, _ in whole])
                          for i, name in enumerate(names)}, index=[number for number, _ in whole])
    good = frame[list(REQUIRED)].notna().all(axis=1) if len(frame) else pd.Series([], dtype=bool)
    good &= frame["gps_week"].between(0, 9999) & frame["gps_tow_s"].between(0, 604_800)
    good &= frame["gps_week"] % 1 == 0
    left_out = len(rows) - int(good.sum())
    if not good.any():
        raise LeonavError(f"{path}: no row with time and position below the header; did the run find a position?")
    if left_out:
        kept = set(frame.index[good])
        first = next(number for number, _ in rows if number not in kept)
        warnings.warn(f"{path}:{first}: {left_out} rows are left out, this is the first: fields are missing or out of range", LeonavWarning,
                      stacklevel=2)
    frame = frame[good].reset_index(drop=True).drop(columns="utc", errors="ignore")
    frame["gps_week"] = frame["gps_week"].astype(np.int64)
    ns = gps_time.gps_ns(frame["gps_week"].to_numpy(), frame["gps_tow_s"].to_numpy())
    frame.insert(2, "utc", pd.to_datetime(gps_time.unix_ns(ns), utc=True))
    return frame


def _column(path, name, fields, numbers):
    if name == "source":
        return np.array(fields, dtype=object)
    try:
        return np.array([float(field) if field else np.nan for field in fields], dtype=float)
    except ValueError:
        pass
    for field, number in zip(fields, numbers):
        try:
            float(field or "nan")
        except ValueError:
            if name in REQUIRED:
                raise LeonavError(f"{path}:{number}: '{field}' is no number ({name}); delete or mend the line") from None
            return np.array(fields, dtype=object)  # a column of text that others have added
    return np.array(fields, dtype=object)
