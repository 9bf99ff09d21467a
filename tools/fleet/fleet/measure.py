"""What one run came to: leonav-eval's numbers, the stated sigmas against the errors, and what leonav-replay counted."""
import csv
import json
import math
import re

import numpy as np
import yaml

WEEK_S = 604800.0
SEMI_MAJOR_AXIS, ECCENTRICITY_SQUARED = 6378137.0, 6.69437999014e-3
AXES = ("north", "east", "up")
MAX_TRUTH_GAP_S = 2.0  # as leonav-eval
SAME_TIME_S = 1e-6
POSITION = ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m")
VELOCITY = ("v_north_m_s", "v_east_m_s", "v_down_m_s")
SIGMA = ("std_north_m", "std_east_m", "std_down_m")


class MeasureError(Exception):
    pass


def number(text):
    try:
        return float(text) if text else math.nan
    except ValueError:
        return math.nan


def columns(path, names):
    """Columns of a CSV file as arrays; what is absent or empty is NaN. Rows without time or position are left out."""
    try:
        with open(path, newline="") as file:
            rows = csv.reader(file)
            header = next(rows)
            places = [header.index(name) if name in header else None for name in names]
            data = [[math.nan if p is None else number(row[p]) for p in places] for row in rows if len(row) == len(header)]
    except (OSError, UnicodeDecodeError, StopIteration) as error:
        raise MeasureError(f"{path}: {error or 'is empty'}") from None
    table = np.array(data).reshape(-1, len(names))
    return table[np.all(np.isfinite(table[:, :len(POSITION)]), axis=1)].T


def seconds(table, week):
    return (table[0] - week) * WEEK_S + table[1]


def start_of(truth_path):
    """GPS week and time of week of the truth's first row."""
    table = columns(truth_path, POSITION)
    if not table.shape[1]:
        raise MeasureError(f"{truth_path}: has no row")
    return int(table[0][0]), float(table[1][0])


def north_east_down(latitude, longitude):
    """Rows north, east, down of each point's rotation from ECEF, [point, 3, 3]."""
    sn, cn, se, ce = np.sin(latitude), np.cos(latitude), np.sin(longitude), np.cos(longitude)
    zero = np.zeros_like(sn)
    rows = [-sn * ce, -sn * se, cn], [-se, ce, zero], [-cn * ce, -cn * se, -sn]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def ecef(latitude, longitude, height):
    normal = SEMI_MAJOR_AXIS / np.sqrt(1.0 - ECCENTRICITY_SQUARED * np.sin(latitude) ** 2)
    level = (normal + height) * np.cos(latitude)
    z = (normal * (1.0 - ECCENTRICITY_SQUARED) + height) * np.sin(latitude)
    return np.stack([level * np.cos(longitude), level * np.sin(longitude), z], -1)


def errors_of(solution_path, truth_path, settle_s=0.0):
    """Errors and stated sigmas north, east, up of the judged epochs, [3, epoch], m, as leonav-eval compares them.

    The truth is interpolated: a cubic where both neighbours have a velocity, a line otherwise. Epochs of the first
    `settle_s` seconds after the truth's first row are not judged.
    """
    solution, truth = columns(solution_path, POSITION + SIGMA), columns(truth_path, POSITION + VELOCITY)
    if not solution.shape[1] or not truth.shape[1]:
        raise MeasureError(f"{truth_path if solution.shape[1] else solution_path}: has no row")
    week = truth[0][0]
    t, known = seconds(solution, week), seconds(truth, week)
    first = known[0]
    after = np.searchsorted(known, t - SAME_TIME_S)
    good = (after < len(known)) & (t >= first + settle_s - SAME_TIME_S)
    good[good] &= (after[good] > 0) | (np.abs(known[after[good]] - t[good]) <= SAME_TIME_S)
    b = after[good]
    same = np.abs(known[b] - t[good]) <= SAME_TIME_S
    a = np.where(same, b, b - 1)
    gap = np.where(same, 1.0, known[b] - known[a])
    within = gap <= MAX_TRUTH_GAP_S
    good[good] = within
    a, b, gap, same = a[within], b[within], gap[within], same[within]
    s = np.where(same, 0.0, (t[good] - known[a]) / gap)[:, None]
    latitude, longitude = np.radians(truth[2]), np.radians(truth[3])
    place, turn = ecef(latitude, longitude, truth[4]), north_east_down(latitude, longitude)
    speed = np.einsum("kji,kj->ki", turn, truth[5:8].T)
    line = place[a] + s * (place[b] - place[a])
    r = 1.0 - s
    cubic = (r * r * (1.0 + 2.0 * s) * place[a] + s * s * (3.0 - 2.0 * s) * place[b]
             + s * r * gap[:, None] * (r * speed[a] - s * speed[b]))
    reference = np.where(np.all(np.isfinite(speed[a]) & np.isfinite(speed[b]), axis=1)[:, None], cubic, line)
    own = solution[:, good]
    difference = ecef(np.radians(own[2]), np.radians(own[3]), own[4]) - reference
    ned = np.einsum("kij,kj->ki", turn[a], difference)  # between neighbours it turns by microradians
    return np.array([ned[:, 0], ned[:, 1], -ned[:, 2]]), own[5:8]


def rounded(value):
    return None if value is None or not math.isfinite(value) else round(float(value), 6)


def sigmas(errors, stated):
    """Per axis: epochs with a sigma, those within three of them, the mean sigma, and that over the RMSE of these epochs."""
    result = {}
    for axis, error, sigma in zip(AXES, errors, stated):
        known = np.isfinite(sigma)
        error, sigma = error[known], sigma[known]
        count = len(error)
        mean, rmse = (float(np.mean(sigma)), float(np.sqrt(np.mean(error ** 2)))) if count else (math.nan, math.nan)
        result[axis] = {"count": count, "within": int(np.count_nonzero(np.abs(error) <= 3.0 * sigma)),
                        "mean_sigma_m": rounded(mean), "sigma_over_rmse": rounded(mean / rmse) if rmse > 0.0 else None}
    return result


def evaluated(path):
    """What leonav-eval wrote of the one solution that it was given."""
    try:
        with open(path) as file:
            read = json.load(file)[0]
        errors = {key: {name: float(read[key + "_m"][name]) for name in ("rmse", "p95", "worst")}
                  for key in (*AXES, "horizontal", "3d")}
        result = {"errors": errors, **{key: read[key] for key in ("epochs", "answered", "expected", "expected_in_truth",
                                                                  "availability", "convergence_s", "within_three_sigma")}}
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise MeasureError(f"{path}: {type(error).__name__}: {error}; not what leonav-eval --json writes") from None
    result["integrity"] = read["integrity"] if isinstance(read.get("integrity"), dict) else None
    return result


def integrity_of(path):
    """The quantities (horizontal, ...) that leonav-eval --integrity counted of the one solution that it was given."""
    try:
        with open(path) as file:
            read = json.load(file)[0]
        return {key: value for key, value in read.items() if isinstance(value, dict)}
    except (OSError, ValueError, LookupError, AttributeError) as error:
        raise MeasureError(f"{path}: {type(error).__name__}: {error}; not what leonav-eval --integrity --json writes") from None


def integrity_model_of(path):
    """What decides about the multiple of its sigma that a level is, of the configuration.yaml of leonav-replay; None: there is none."""
    try:
        with open(path) as file:
            read = yaml.safe_load(file)["integrity"]
        return {name: float(read[name]) for name in ("risk_per_hour", "error_correlation_s", "sigma_factor", "tail_share", "tail_factor")}
    except FileNotFoundError:
        return None  # of an older leonav-replay
    except (OSError, yaml.YAMLError, ValueError, LookupError, TypeError) as error:
        raise MeasureError(f"{path}: {type(error).__name__}: {error}; not what leonav-replay writes") from None


def counted(summary):
    """What leonav-replay's summary.txt says: counts, and its warnings."""
    def count(name):
        found = re.search(rf"^{re.escape(name)}: (\d+)$", summary, re.MULTILINE)
        return int(found[1]) if found else 0
    return {"epochs_replayed": count("epochs"), "empty_epochs": count("empty epochs"),
            "misses": count("deadline misses") + count("smoother deadline misses"), "resets": count("events filter_reset"),
            "warnings": re.findall(r"^warning: (.*)$", summary, re.MULTILINE)}
