"""What one run came to: leonav-eval's numbers, and the epochs' errors, satellites and PDOP for the plots."""
import csv
import json
import math
import os
import re
import shutil

import numpy as np

WEEK_S = 604800.0
MAX_PDOP = 20.0  # beyond it the mean would be of a few epochs alone


class JudgeError(Exception):
    pass


def columns(path, names):
    """Columns of a CSV file as arrays; empty is NaN."""
    try:
        with open(path, newline="") as file:
            rows = csv.reader(file)
            header = next(rows)
            places = [header.index(name) for name in names]
            data = [[float(row[p]) if row[p] else math.nan for p in places] for row in rows if len(row) == len(header)]
    except (OSError, ValueError, StopIteration) as error:
        raise JudgeError(f"{path}: {error}")
    if not data:
        raise JudgeError(f"{path}: has no row")
    return np.array(data).reshape(-1, len(names)).T


def numbers_of(path):
    """What leonav-eval wrote of the one solution that it was given."""
    try:
        with open(path) as file:
            read = json.load(file)[0]
        three_d = read["3d_m"]
        result = {
            "rmse": [read[k]["rmse"] for k in ("north_m", "east_m", "up_m", "3d_m")],
            "p50_3d": three_d["p50"], "p95_3d": three_d["p95"], "worst_3d": three_d["worst"],
            "epochs": read["epochs"],
        }
        maybe = {key: read[key] for key in ("convergence_s", "settled_s", "within_three_sigma")}
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise JudgeError(f"{path}: {type(error).__name__}: {error}; not what leonav-eval --json writes")
    flat = result["rmse"] + [v for k, v in result.items() if k != "rmse"] + [v for v in maybe.values() if v is not None]
    if any(isinstance(v, bool) or not isinstance(v, (int, float)) for v in flat):
        raise JudgeError(f"{path}: has something else in the place of a number; not what leonav-eval --json writes")
    return {**result, **maybe}


def errors_of(solution_path, truth_path):
    """Seconds since the truth's first epoch; north, east, up errors in m (solution minus truth)."""
    names = ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m")
    solution, truth = columns(solution_path, names), columns(truth_path, names)
    t_truth = truth[0] * WEEK_S + truth[1]
    t = solution[0] * WEEK_S + solution[1]
    place = np.searchsorted(t_truth, t - 1e-4)
    known = place < len(t_truth)
    known[known] &= np.abs(t_truth[place[known]] - t[known]) < 1e-3
    t, solution, truth = t[known], solution[:, known], truth[:, place[known]]
    latitude = np.radians(truth[2])
    w = 1.0 - 6.69437999014e-3 * np.sin(latitude) ** 2
    meridian = 6378137.0 * (1.0 - 6.69437999014e-3) / w ** 1.5 + truth[4]
    normal = 6378137.0 / np.sqrt(w) + truth[4]
    north = np.radians(solution[2] - truth[2]) * meridian
    east = np.radians(solution[3] - truth[3]) * normal * np.cos(latitude)
    return t - t_truth[0], np.array([north, east, solution[4] - truth[4]])


def judge(row, folder, out):
    result = numbers_of(os.path.join(out, "errors.json"))
    t, error = errors_of(os.path.join(out, "solution.csv"), os.path.join(folder, "truth.csv"))
    if row.is_whole_log():  # its epochs are the filter's, whose row has them
        t_epoch, satellites, pdop = t, np.zeros(0), np.zeros(0)
    else:
        week, tow, satellites, pdop = columns(os.path.join(out, "epochs.csv"), ("gps_week", "gps_tow_s", "satellites", "pdop"))
        t_epoch = (week - week[0]) * WEEK_S + tow - tow[0]
    settled = t >= row.settle_epochs
    judged = t_epoch >= row.settle_epochs
    told = judged[:len(satellites)]
    good = told & (pdop > 0.0) & (pdop < MAX_PDOP)
    np.savez_compressed(os.path.join(out, "series.npz"), t=t.astype(np.float32), error=error.astype(np.float32),
                        t_epoch=t_epoch.astype(np.float32), satellites=satellites.astype(np.float32),
                        pdop=pdop.astype(np.float32))
    result |= {
        "availability": float(np.count_nonzero(settled)) / max(1, int(np.count_nonzero(judged))),
        "within_5m": [100.0 * float(np.mean(np.abs(e[settled]) < 5.0)) for e in error] if settled.any() else None,
        "satellites": float(np.mean(satellites[told])) if told.any() else None,
        "below_four": float(np.mean(satellites[told] < 4)) if told.any() else None,
        "pdop": float(np.mean(pdop[good])) if good.any() else None,
    }
    result["odometer_scale_percent"] = odometer_scale_of(os.path.join(out, "summary.txt"))
    if row.is_set():
        result["after_convergence"] = after_convergence(t, error, result["convergence_s"])
    return result


def odometer_scale_of(path):
    """As found in the end, and 1 sigma of it, %; None: there was no odometer."""
    with open(path) as file:
        found = re.search(r"^odometer scale: (\S+) % \(1 sigma (\S+)\)$", file.read(), re.MULTILINE)
    return [float(found[1]), float(found[2])] if found else None


def after_convergence(t, error, convergence_s):
    if convergence_s is None or not len(t):
        return None
    later = t >= t[0] + convergence_s
    return float(np.sqrt(np.mean(np.sum(error[:, later] ** 2, axis=0))))


def save_series(source, target):
    temporary = f"{target}.{os.getpid()}.part"
    shutil.copyfile(source, temporary)
    os.replace(temporary, target)


def one_line(result):
    n, e, u, _ = result["rmse"]
    time = result["convergence_s"]
    return (f"RMSE N {n:.3f} E {e:.3f} U {u:.3f} m, {result['satellites'] or 0.0:.1f} satellites, converged "
            + ("never" if time is None else f"after {time:.0f} s"))
