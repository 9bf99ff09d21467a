"""Errors, sigmas, time and memory of leonav-smooth beside the causal estimators; Markdown tables to standard output.

  smooth.py BIN OUT streets|tunnels|recorded|size [SCENES [SEEDS]]     exits with 1 if a bound does not hold
"""
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
import yaml

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.insert(0, str(ROOT / "tools/fleet"))

from experiments import judge  # noqa: E402
from fleet import matrix, measure  # noqa: E402
from golden.inputs import MEMS_SETTINGS  # noqa: E402

STREETS = yaml.safe_load((ROOT / "config/matrix/streets.yaml").read_text())
ALIGNMENT = STREETS["set"]
SEEDS = [1, 2, 3]
CAR = [*ALIGNMENT, "vehicle.kind=car"]
SYSTEMS = {"all": "gnss.systems=[gps, galileo, beidou, leo]", "GPS": "gnss.systems=[gps]"}
STREETS_S, SETTLE_S = 1200.0, 120.0
FAMILIES = {"city": ("urban", ["places=city"]), "dense city": ("urban", ["places=dense_city"]), "correlated": ("correlated", []),
            "recorded": ("recorded", [])}
RESIDUALS = ROOT / "residuals-output/residuals.csv"  # of the scenario recorded
LAGGED = "fixed lag"  # the smoother's state at its oldest keyframe
ESTIMATORS = ("filter", "smoother", LAGGED, "whole log", "forward")

# From and to, s from the start; no satellite at all.
TUNNELS, TUNNELS_S = ((600, 660), (840, 900), (1080, 1140)), 1300.0
OUTAGES = "faults=[" + ", ".join(f"{{kind: outage, from_s: {a}, to_s: {b}, systems: [gps, galileo, beidou, leo]}}"
                                 for a, b in TUNNELS) + "]"
GRADES = {"tactical": ([], []), "MEMS": (["imu.grade=mems", *MEMS_SETTINGS], MEMS_SETTINGS)}
VEHICLES = {"car": "vehicle.kind=car", "unconstrained": "vehicle.kind=handheld"}
TUNNEL_SHARE = 0.2  # of the filter's error at the end of an outage, at most, is the whole log's in its middle

# Preset and settings, how leonav-eval judges, what the smoother in real time is told beside.
ROVER = ["ekf.motion=constant_velocity", "ekf.carrier=true", "gnss.systems=[gps, galileo]"]
RECORDED = {
    "walk": ("walk", [], ["--remove-offset"], ["smoother.keyframe_interval_s=0.2"]),  # every epoch a keyframe, as rtklib
    "drive": ("phone", [], [], []),
    "semi-real": ("phone_imu", [], [], []),
    "rover": ("realtime", ROVER, ["--max-truth-gap", "1.5"], []),
}

SOLVERS, HOURS, DAY_HOURS, LIMIT_GB = ("chain", "ceres"), (1, 3), 24, 8.0


def with_settings(settings):
    return [word for setting in settings for word in ("--set", setting)]


def run(*command):
    """Ends all if the command fails. Returns seconds on the clock, of all processors together, and peak memory in MB."""
    begin = time.monotonic()
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as child:
        told = child.stderr.read()
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\nended with {child.returncode}\n{told}")
    return time.monotonic() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024.0


def simulate(bin_folder, folder, scenario, seed, duration_s, settings):
    """A drive in `folder`: run.lcmlog and truth.csv."""
    folder.mkdir(parents=True, exist_ok=True)
    own = [f"seed={seed}", f"duration_s={duration_s:g}"]
    own += [f"{key}={matrix.value_of_seed(value, seed):g}" for key, value in STREETS["per_seed"].items()]
    run(bin_folder / "leonav-sim", ROOT / f"config/scenario/{scenario}.yaml", *with_settings(own + settings), "-o", folder / "run.lcmlog")


def estimate(bin_folder, log, out, preset, settings, live=()):
    """{estimator: solution}; warns where the whole log has not converged."""
    words = ["--preset", preset, *with_settings(settings)]
    run(bin_folder / "leonav-replay", *words, *with_settings(["estimator=ekf"]), log, "--out", out / "filter")
    run(bin_folder / "leonav-replay", *words, *with_settings(["estimator=smoother", *live]), log, "--out", out / "smoother")
    run(bin_folder / "leonav-smooth", *words, "--solver", "chain", log, "--out", out / "whole")
    for line in (out / "whole/summary.txt").read_text().splitlines():
        if line.startswith("warning:"):
            print(f"{out.name}: {line}", file=sys.stderr)
    return dict(zip(ESTIMATORS, (out / "filter/solution.csv", out / "smoother/solution.csv", out / "smoother/smoothed.csv",
                                 out / "whole/solution.csv", out / "whole/forward.csv")))


def print_table(header, rows):
    print("| " + " | ".join(header) + " |\n|" + "---|" * len(header))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


def verdict(kept, text):
    print(f"{text}: {'met' if kept else 'MISSED'}.", flush=True)
    return kept


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def geometric_mean(values):
    return float(np.exp(np.mean(np.log(values))))


def choose(scenes="", seeds=""):
    """Leaves only these scenes and seeds, each a list with commas; empty: all."""
    wanted = [scene.strip() for scene in scenes.split(",") if scene.strip()]
    for scene in wanted:
        if scene not in FAMILIES:
            sys.exit(f"no scene '{scene}'; there are: {', '.join(FAMILIES)}")
    if not RESIDUALS.exists():
        told = f"the scene 'recorded' needs {RESIDUALS.relative_to(ROOT)}, which tools/validate street-residuals makes"
        if "recorded" in wanted:
            sys.exit(told)
        print(f"Left out: {told}.\n")
        del FAMILIES["recorded"]
    for scene in list(FAMILIES):
        if wanted and scene not in wanted:
            del FAMILIES[scene]
    try:
        SEEDS[:] = [int(seed) for seed in seeds.split(",") if seed.strip()] or SEEDS
    except ValueError:
        sys.exit(f"seeds are whole numbers with commas, not '{seeds}'")


# Simulated streets.
def street_errors(bin_folder, out):
    """{(family, systems, estimator): [(errors, sigmas) of a seed]}"""
    result = {}
    for family, (scenario, settings) in FAMILIES.items():
        for seed in SEEDS:
            folder = out / f"{family.replace(' ', '_')}-{seed}"
            simulate(bin_folder, folder, scenario, seed, STREETS_S, settings)
            for systems, key in SYSTEMS.items():
                for name, solution in estimate(bin_folder, folder / "run.lcmlog", folder / systems, "urban", [*CAR, key]).items():
                    result.setdefault((family, systems, name), []).append(measure.errors_of(solution, folder / "truth.csv", SETTLE_S))
            (folder / "run.lcmlog").unlink()
    return result


def consistency(runs):
    """Shares within three sigma of all epochs, of the worst drive, and mean sigma over RMSE, each north, east, up."""
    every = measure.sigmas(*(np.concatenate(parts, axis=1) for parts in zip(*runs)))
    single = [measure.sigmas(*one) for one in runs]

    def shown(values, digits):
        return " / ".join(f"{value:.{digits}f}" for value in values)

    share = {axis: 100.0 * every[axis]["within"] / every[axis]["count"] for axis in measure.AXES}
    worst = [min(100.0 * one[axis]["within"] / one[axis]["count"] for one in single) for axis in measure.AXES]
    return shown(share.values(), 1), shown(worst, 1), shown((every[axis]["sigma_over_rmse"] for axis in measure.AXES), 2)


def streets(bin_folder, out):
    runs = street_errors(bin_folder, out)
    rows, ratios = [], {name: [] for name in ESTIMATORS}
    for (family, systems, name), seeds in runs.items():
        of_seed = [rms(np.linalg.norm(errors, axis=0)) for errors, _ in seeds]
        of_filter = [rms(np.linalg.norm(errors, axis=0)) for errors, _ in runs[family, systems, "filter"]]
        ratio = [own / other for own, other in zip(of_seed, of_filter)]
        ratios[name] += ratio
        rows.append((family, systems, name, f"{np.mean(of_seed):.3f}", f"{geometric_mean(ratio):.2f}", f"{min(ratio):.2f} to {max(ratio):.2f}",
                     *consistency(seeds)))
    print(f"{len(SEEDS)} drives of {STREETS_S:g} s a row, without the first {SETTLE_S:g} s.\n")
    print_table(("scene", "systems", "estimator", "3D RMSE, m", "over the filter's", "single drives", "within 3 sigma N / E / U, %", "worst drive, %",
                 "sigma / RMSE"), rows)
    print_table(("estimator", "3D RMSE over the filter's, geometric mean", "drives that are better than the filter's"),
                [(name, f"{geometric_mean(values):.3f}", f"{sum(v < 1.0 for v in values)} of {len(values)}")
                 for name, values in ratios.items() if name != "filter"])
    whole = geometric_mean(ratios["whole log"])
    return verdict(whole < 1.0, f"Bound, the whole log is better than the filter in the geometric mean: {whole:.3f}")


# Tunnels.
def tunnel_errors(solution, truth):
    """{place: horizontal errors over the sigma and in m} of the tunnels' middles and last epochs, and their largest."""
    t, (north, east, _) = judge.errors_of(solution, truth)
    week, tow, sigma_north, sigma_east = judge.columns(solution, ("gps_week", "gps_tow_s", "std_north_m", "std_east_m"))
    truth_week, truth_tow = (column[0] for column in judge.columns(truth, ("gps_week", "gps_tow_s")))
    stamps = (week - truth_week) * judge.WEEK_S + tow - truth_tow
    sigma = np.hypot(sigma_north, sigma_east)[np.isin(np.round(stamps, 3), np.round(t, 3))]
    error = np.hypot(north, east)
    result = {"middle": [], "end": [], "worst": []}
    for begin, end in TUNNELS:
        for place, when in (("middle", 0.5 * (begin + end)), ("end", end - 1.0)):
            at = int(np.argmin(np.abs(t - when)))
            # An estimator that has no answer there has no error either.
            there = abs(t[at] - when) < 0.5
            result[place].append((error[at], sigma[at]) if there else (np.nan, np.nan))
        inside = (t > begin) & (t < end)
        worst = np.flatnonzero(inside)[np.argmax(error[inside])] if inside.any() else None
        result["worst"].append((error[worst], sigma[worst]) if worst is not None else (np.nan, np.nan))
    return result


def tunnels(bin_folder, out):
    rows, kept = [], True
    verdicts = []
    for grade, (simulated, told) in GRADES.items():
        logs = []
        for seed in SEEDS:
            folder = out / f"{grade}-{seed}"
            simulate(bin_folder, folder, "urban", seed, TUNNELS_S, ["places=city", OUTAGES, *simulated])
            logs.append(folder)
        for vehicle, kind in VEHICLES.items():
            found = {}
            for folder in logs:
                settings = [*ALIGNMENT, SYSTEMS["GPS"], kind, *told]
                solutions = estimate(bin_folder, folder / "run.lcmlog", folder / vehicle, "urban", settings)
                solutions.pop(LAGGED)  # no states without satellites
                for name, solution in solutions.items():
                    for place, values in tunnel_errors(solution, folder / "truth.csv").items():
                        found.setdefault((name, place), []).extend(values)
            errors = {key: np.array(values) for key, values in found.items()}
            for name in solutions:
                cells = []
                for place in ("middle", "end", "worst"):
                    error, sigma = errors[name, place].T
                    cells.append(f"{rms(error):.2f} ({np.max(error):.2f}; {rms(sigma):.2f})")
                rows.append((grade, vehicle, name, *cells))
            middle, end = rms(errors["whole log", "middle"].T[0]), rms(errors["filter", "end"].T[0])
            of_filter = rms(errors["filter", "middle"].T[0])
            single = errors["whole log", "middle"].T[0] / errors["filter", "end"].T[0]
            verdicts.append((middle <= TUNNEL_SHARE * end,
                             f"{grade}, {vehicle}: the whole log's error in the middle is {middle / end:.3f} of the filter's at the end (single "
                             f"outages {min(single):.3f} to {max(single):.3f}) and {middle / of_filter:.3f} of the filter's in the middle; "
                             f"bound {TUNNEL_SHARE:g} of that at the end"))
        for folder in logs:
            (folder / "run.lcmlog").unlink()
    print(f"Horizontal errors in {len(SEEDS) * len(TUNNELS)} outages of {TUNNELS[0][1] - TUNNELS[0][0]} s a row: rms, in brackets the largest and "
          "the stated sigma, m.\n")
    print_table(("IMU", "vehicle", "estimator", "in the middle", "at the end", "largest within"), rows)
    for good, text in verdicts:
        kept = verdict(good, text) and kept
    return kept


# Recordings, which the calling script has prepared.
def evaluated(bin_folder, folder, solution, judged):
    run(bin_folder / "leonav-eval", "--truth", folder / "truth.csv", *judged, "--json", folder / "errors.json", solution)
    return json.loads((folder / "errors.json").read_text())[0]


def recorded(bin_folder, out):
    rows = []
    for name, (preset, settings, judged, live) in RECORDED.items():
        folder = out.parent / name
        if not (folder / "run.lcmlog").exists():
            print(f"skipped: {name}", file=sys.stderr)
            continue
        for estimator, solution in estimate(bin_folder, folder / "run.lcmlog", folder, preset, settings, live).items():
            read, moved = (evaluated(bin_folder, folder, solution, [*judged, *more]) for more in ([], ["--remove-offset"]))
            offset = " / ".join(f"{value:.2f}" for value in moved["removed_offset_neu_m"]) if "--remove-offset" not in judged else "unknown"
            rows.append((name, estimator, str(read["epochs"]), f"{read['horizontal_m']['rmse']:.3f}", f"{read['horizontal_m']['p95']:.3f}",
                         f"{read['up_m']['rmse']:.3f}", offset, f"{moved['horizontal_m']['rmse']:.3f}", f"{moved['up_m']['rmse']:.3f}",
                         f"{100.0 * read['within_three_sigma']:.1f}"))
    print_table(("recording", "estimator", "epochs", "horizontal RMSE, m", "95 %, m", "vertical RMSE, m", "mean error N / E / U, m",
                 "around the mean: horizontal, m", "vertical, m", "within 3 sigma, %"), rows)
    return True


# Time and memory.
def apart(first, second):
    """The largest distance between positions of two solutions, m."""
    places = [measure.ecef(np.radians(table[2]), np.radians(table[3]), table[4]) for table in
              (measure.columns(path, measure.POSITION) for path in (first, second))]
    return float(np.max(np.linalg.norm(places[0] - places[1], axis=1)))


def size(bin_folder, out):
    rows, verdicts, kept = [], [], True
    folders = {hours: out / f"{hours}h" for hours in HOURS}
    for hours, folder in folders.items():
        simulate(bin_folder, folder, "urban", 1, 3600.0 * hours, ["places=city"])
    for systems, key in SYSTEMS.items():
        for solver in SOLVERS:
            peaks = {}
            for hours, folder in folders.items():
                told = folder / f"{systems}-{solver}"
                seconds, busy, peaks[hours] = run(bin_folder / "leonav-smooth", "--preset", "urban", *with_settings([*CAR, key]), "--solver", solver,
                                                  folder / "run.lcmlog", "--out", told)
                summary = (told / "summary.txt").read_text()
                rows.append((systems, solver, f"{hours} h", str(measure.columns(told / "solution.csv", measure.POSITION).shape[1]),
                             str(summary.count("\niteration ")), "yes" if "converged: yes" in summary else "NO", f"{seconds:.0f}", f"{busy:.0f}",
                             f"{peaks[hours]:.0f}"))
            per_hour = (peaks[HOURS[1]] - peaks[HOURS[0]]) / (HOURS[1] - HOURS[0])
            day = (peaks[HOURS[1]] + per_hour * (DAY_HOURS - HOURS[1])) / 1024.0
            verdicts.append((solver, day, f"{systems}, {solver}: {per_hour:.0f} MB an hour, {day:.1f} GB for {DAY_HOURS} h"))
    print("One epoch a second, IMU 200 times a second, preset urban; the pass of the filter is in the time.\n")
    print_table(("systems", "solver", "log", "epochs", "iterations", "converged", "time, s", "processor, s", "peak memory, MB"), rows)
    for solver, day, text in verdicts:
        if solver == "chain":
            kept = verdict(day <= LIMIT_GB, f"{text}; bound {LIMIT_GB:g} GB") and kept
        else:
            print(f"{text}.")
    for hours, folder in folders.items():
        for systems in SYSTEMS:
            solutions = [folder / f"{systems}-{solver}/solution.csv" for solver in SOLVERS]
            print(f"{systems}, {hours} h: positions of both solvers are at most {1000.0 * apart(*solutions):.2g} mm apart.")
        (folder / "run.lcmlog").unlink()
    return kept


PARTS = {"streets": streets, "tunnels": tunnels, "recorded": recorded, "size": size}


def main():
    if len(sys.argv) not in (4, 5, 6) or sys.argv[3] not in PARTS:
        sys.exit(__doc__)
    choose(*sys.argv[4:])
    out = pathlib.Path(sys.argv[2]) / sys.argv[3]
    out.mkdir(parents=True, exist_ok=True)
    return 0 if PARTS[sys.argv[3]](pathlib.Path(sys.argv[1]).resolve(), out) else 1


if __name__ == "__main__":
    sys.exit(main())
