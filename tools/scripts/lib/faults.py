"""Simulates scripted faults, replays them, and prints what the answer, its sigma and its protection levels made of each.

  faults.py BIN OUT [--seeds N] [--set KEY=VALUE]...
"""
import argparse
import csv
import math
import pathlib
import re
import subprocess
import sys

import numpy as np

from experiments.judge import WEEK_S, columns, errors_of

BEGIN_S, END_S, DURATION_S = 300, 900, 1200
# Events that tell of a fault of the inputs or of the estimate; others come in every run.
TELLING = {"improbable", "filter_reset", "clock_step", "constraints_left_out", "none_usable", "convention_suspect",
           "satellite_fault", "prediction_widened"}
ARM = "[0, 0, -1.2]"
SCENES = {
    "open sky": ("config/scenario/open_sky.yaml", f"receiver.lever_arm_b_m={ARM}"),
    "streets": ("config/scenario/correlated.yaml", f"receiver.lever_arm_b_m={ARM}"),
}
SYSTEMS = {"all": "[gps, galileo, beidou, leo]", "GPS": "[gps]"}
ESTIMATORS = {"filter": [], "smoother": ["--set", "estimator=smoother"]}
HEADER = """
{scene}, seed {seed}; satellites {gps} and {leo}

| fault | systems | estimator | largest 3D error, m (sigma; levels) | error / sigma | error / level | heading error / level | misleading | told | error then, m (sigma; levels) |
|---|---|---|---|---|---|---|---|---|---|"""


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stderr}")


def rows(path):
    with open(path, newline="") as file:
        yield from csv.DictReader(file)


def seconds(row):
    return int(row["gps_week"]) * WEEK_S + float(row["gps_tow_s"]) if row["gps_week"] else math.nan


def steadiest(table, begin, end, system):
    """The satellite of a system that is used from begin to end, s since the first epoch, the highest of these."""
    seen, first = {}, None
    for row in rows(table):
        first = seconds(row) if first is None else first
        t = seconds(row) - first
        if row["satellite"][0] in system and row["used"] == "1" and begin <= t < end:
            seen.setdefault(row["satellite"], []).append(float(row["elevation_deg"]))
    most = max(len(values) for values in seen.values())
    often = {name: values for name, values in seen.items() if len(values) > 0.9 * most}
    return max(often, key=lambda name: sum(often[name]) / len(often[name]))


def heading_share(folder, truth, begin):
    """The largest error of the heading over its protection level from `begin` on, s since the truth's first epoch."""
    week, tow, yaw, level = columns(folder / "solution.csv", ("gps_week", "gps_tow_s", "yaw_deg", "protection_heading_deg"))
    truth_week, truth_tow, truth_yaw = columns(truth, ("gps_week", "gps_tow_s", "yaw_deg"))
    first = truth_week[0] * WEEK_S + truth_tow[0]
    t, truth_t = (np.round(w * WEEK_S + s - first, 3) for w, s in ((week, tow), (truth_week, truth_tow)))
    t, at, truth_at = np.intersect1d(t, truth_t, return_indices=True)
    error = (yaw[at] - truth_yaw[truth_at] + 180.0) % 360.0 - 180.0
    share = np.abs(error) / level[at]
    # A level that is not known is none.
    return np.where(np.isnan(share), np.inf, share)[t >= begin].max()


def judge(folder, truth, begin, told_from, usual):
    """The largest errors from the fault's begin on, and the first event that tells of it, of a kind that is not in `usual`.

    Times: s since the truth's first.
    """
    t, error = errors_of(folder / "solution.csv", truth)
    week, tow = columns(truth, ("gps_week", "gps_tow_s"))
    first = week[0] * WEEK_S + tow[0]
    week, tow, *stated = columns(folder / "solution.csv", (
        "gps_week", "gps_tow_s", "std_north_m", "std_east_m", "std_down_m", "protection_horizontal_m", "protection_vertical_m"))
    stated = np.array(stated)[:, np.isin(np.round(week * WEEK_S + tow - first, 3), np.round(t, 3))]
    sigma, levels = stated[:3], stated[3:]
    size, sigma_3d = np.linalg.norm(error, axis=0), np.linalg.norm(sigma, axis=0)
    share = np.array([np.hypot(error[0], error[1]), np.abs(error[2])]) / levels
    # A level that is not known is none.
    share = np.where(np.isnan(share), np.inf, share).max(axis=0)
    late = t >= begin
    worst = np.flatnonzero(late)[np.argmax(size[late])]
    at = lambda k: (size[k], sigma_3d[k], levels[:, k])
    result = dict(worst=at(worst), sigmas=(np.abs(error) / sigma)[:, late].max(), share=share[late].max(),
                  heading=heading_share(folder, truth, begin), misleading=np.count_nonzero(share[late] > 1), epochs=np.count_nonzero(late), event=None, kinds=set())
    if result["misleading"]:
        result["until"] = t[late & (share > 1)].max() - told_from
    for row in rows(folder / "events.csv"):
        told = seconds(row) - first
        if row["event"] not in TELLING or not told >= told_from:
            continue
        result["kinds"].add(row["event"])
        if result["event"] is None and row["event"] not in usual:
            result["event"] = row["event"], told - told_from, at(np.argmin(np.abs(t - told)))
    return result


def cell(size, sigma, levels):
    return f"{size:.2f} ({sigma:.2f}; {levels[0]:.1f}, {levels[1]:.1f})"


def print_row(name, systems, estimator, result):
    told = "no | -"
    until = f", the last after {result['until']:.0f} s" if "until" in result else ""
    if result["event"]:
        kind, after, then = result["event"]
        told = f"`{kind}` after {after:.0f} s | {cell(*then)}"
    print(f"| {name} | {systems} | {estimator} | {cell(*result['worst'])} "
          f"| {result['sigmas']:.1f} | {result['share']:.2f} | {result['heading']:.2f} | {result['misleading']} of {result['epochs']}{until} | {told} |",
          flush=True)


class Drive:
    """One seed of a scene: simulates it with a fault, and replays that."""

    def __init__(self, options, scene, seed):
        self.options, self.seed = options, str(seed)
        self.scenario, self.key = SCENES[scene]
        self.folder = options.out / f"{scene.replace(' ', '_')}_{seed}"

    def simulate(self, name, faults):
        folder = self.folder / re.sub("[^a-z0-9]+", "_", name.lower())
        folder.mkdir(parents=True, exist_ok=True)
        run(self.options.bin / "leonav-sim", self.scenario, "--seed", self.seed, "--set", self.key, "--set",
            f"duration_s={DURATION_S}", "--set", f"faults={faults}", "-o", folder / "run.lcmlog", "--truth", folder / "truth.csv")
        return folder

    def replay(self, folder, systems, estimator, *more):
        at = folder / estimator / systems
        at.mkdir(parents=True, exist_ok=True)
        settings = [word for key in self.options.set for word in ("--set", key)]
        run(self.options.bin / "leonav-replay", "--preset", "urban", "--set", "vehicle.kind=car", "--set",
            f"gnss.systems={SYSTEMS[systems]}", *ESTIMATORS[estimator], *settings, *more, folder / "run.lcmlog", "--out", at)
        return at


def faults_of(gps, leo):
    """Name, script of the simulator, systems of the replay, its other settings. What has no BEGIN_S acts from the start."""
    span = f"from_s: {BEGIN_S}, to_s: {END_S}"
    always = "from_s: -36000, to_s: 36000, systems: [gps, galileo, beidou, leo]"
    return [
        ("none", "[]", ("all", "GPS"), ()),
        ("satellite clock 1 cm/s", f"[{{kind: satellite_clock, {span}, satellites: [{gps}], drift_m_s: 0.01}}]", ("all", "GPS"), ()),
        ("range spoofed by 0.2 m/s", f"[{{kind: spoofing, {span}, satellites: [{gps}], pull_m_s: 0.2}}]", ("all", "GPS"), ()),
        ("BeiDou 30 m off", f"[{{kind: satellite_clock, {span}, systems: [beidou], jump_m: 30}}]", ("all",), ()),
        ("a LEO orbit 5 m off", f"[{{kind: bad_orbit, {span}, satellites: [{leo}], radial_m: 5}}]", ("all",), ()),
        ("all LEO orbits 5 m off", f"[{{kind: bad_orbit, {span}, systems: [leo], radial_m: 5}}]", ("all",), ()),
        ("all orbits 15 m off along", f"[{{kind: bad_orbit, {always}, along_m: 15}}]", ("all", "GPS"), ()),
        ("all orbits 300 m off along", f"[{{kind: bad_orbit, {always}, along_m: 300}}]", ("all", "GPS"), ()),
        ("antenna 2 m higher", "[]", ("all", "GPS"), ("--set", "vehicle.lever_arm_b_m=[0, 0, 0.8]")),
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    for scene in SCENES:
        for seed in range(1, options.seeds + 1):
            drive = Drive(options, scene, seed)
            plain = drive.simulate("none", "[]")
            at = drive.replay(plain, "all", "filter")
            start = errors_of(at / "solution.csv", plain / "truth.csv")[0][0]
            begin = start + BEGIN_S
            gps = steadiest(at / "satellites.csv", BEGIN_S, END_S, "G")
            leo = steadiest(at / "satellites.csv", BEGIN_S, BEGIN_S + 100, "LMNO")
            print(HEADER.format(scene=scene, seed=seed, gps=gps, leo=leo), flush=True)
            usual = {}  # kinds of events of the drive without a fault, by systems and estimator
            for name, script, choices, more in faults_of(gps, leo):
                folder = plain if script == "[]" else drive.simulate(name, script)
                told_from = begin if script == "[]" and not more or f"from_s: {BEGIN_S}," in script else start
                for systems in choices:
                    for estimator in ESTIMATORS:
                        at = drive.replay(folder, systems, estimator, *more)
                        result = judge(at, folder / "truth.csv", begin, told_from, usual.get((systems, estimator), set()))
                        print_row(name, systems, estimator, result)
                        usual.setdefault((systems, estimator), result["kinds"])


if __name__ == "__main__":
    main()
