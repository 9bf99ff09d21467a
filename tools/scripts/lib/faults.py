"""Simulates scripted faults, replays them and prints what the answer, its sigma and its protection level made of each.

  faults.py BIN OUT [--smoother] [--set KEY=VALUE]...
"""
import argparse
import csv
import math
import pathlib
import subprocess
import sys

BEGIN_S, END_S, DURATION_S = 300, 900, 1200
# Events that tell of a fault of the inputs or of the estimate; others come in every run.
TELLING = {"improbable", "filter_reset", "clock_step", "constraints_left_out", "none_usable", "convention_suspect",
           "solution_jump", "satellite_fault"}
SCENES = {
    "open sky": ("config/scenario/open_sky.yaml", ["receiver.lever_arm_b_m=[0, 0, -1.2]"]),
    "streets": ("config/scenario/correlated.yaml", []),
}
SYSTEMS = {"all": "[gps, galileo, beidou, leo]", "GPS": "[gps]"}


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stderr}")


def rows(path):
    with open(path, newline="") as file:
        yield from csv.DictReader(file)


def seconds(row):
    return int(row["gps_week"]) * 604800 + float(row["gps_tow_s"]) if row["gps_week"] else math.nan


def steadiest(table, begin, end, system, step):
    """The satellite of a system that is used from begin to end, the highest of these."""
    seen = {}
    for row in rows(table):
        t = seconds(row)
        if row["satellite"][0] in system and row["used"] == "1" and begin <= t < end:
            seen.setdefault(row["satellite"], []).append(float(row["elevation_deg"]))
    most = max(len(values) for values in seen.values())
    often = {name: values for name, values in seen.items() if len(values) > 0.9 * most}
    return max(often, key=lambda name: sum(often[name]) / len(often[name]) * step)


def errors_of(solution, truth):
    """Per epoch: time, errors north, east, up with their sigmas, levels."""
    known = {}
    for row in rows(truth):
        known[round(seconds(row), 3)] = row
    for row in rows(solution):
        t = round(seconds(row), 3)
        if t not in known:
            continue
        at = known[t]
        latitude = math.radians(float(at["latitude_deg"]))
        w = math.sqrt(1 - 0.00669438 * math.sin(latitude) ** 2)
        north = math.radians(float(row["latitude_deg"]) - float(at["latitude_deg"])) * 6335439.3 / w**3
        east = math.radians(float(row["longitude_deg"]) - float(at["longitude_deg"])) * 6378137.0 / w * math.cos(latitude)
        up = float(row["height_m"]) - float(at["height_m"])
        yield (t, (north, east, up), [float(row[f"std_{axis}_m"]) for axis in ("north", "east", "down")],
               float(row["protection_horizontal_m"] or "nan"), float(row["protection_vertical_m"] or "nan"))


def judge(folder, truth, begin, end):
    """What the run says of the time of the fault, and after it."""
    result = dict(error=0.0, sigmas=0.0, share=0.0, misleading=0, epochs=0)
    track = {}
    for t, error, sigma, level_h, level_v in errors_of(folder / "solution.csv", truth):
        size = math.sqrt(sum(e * e for e in error))
        track[t] = size, math.sqrt(sum(s * s for s in sigma)), level_h, level_v
        if t < begin:
            continue
        result["epochs"] += 1
        horizontal, vertical = math.hypot(error[0], error[1]), abs(error[2])
        if size > result["error"]:
            result.update(error=size, error_sigma=track[t][1], error_level=(level_h, level_v), error_s=t - begin)
        result["sigmas"] = max([result["sigmas"]] + [abs(e) / s for e, s in zip(error, sigma)])
        result["share"] = max(result["share"], horizontal / level_h, vertical / level_v)
        result["misleading"] += horizontal > level_h or vertical > level_v
    result["event"] = None
    for row in rows(folder / "events.csv"):
        t = seconds(row)
        if row["event"] in TELLING and t >= begin:
            at = min(track, key=lambda known: abs(known - t))
            result["event"] = row["event"], t - begin, track[at]
            break
    return result


def text(name, result):
    if result["event"]:
        kind, after, (size, sigma, level_h, level_v) = result["event"]
        told = f"`{kind}` after {after:.0f} s | {size:.2f} ({sigma:.2f}; {level_h:.1f}, {level_v:.1f})"
    else:
        told = "no | -"
    level_h, level_v = result["error_level"]
    return (f"| {name} | {result['error']:.2f} after {result['error_s']:.0f} s ({result['error_sigma']:.2f}; {level_h:.1f}, "
            f"{level_v:.1f}) | {result['sigmas']:.1f} | {result['share']:.2f} | {result['misleading']} of {result['epochs']} "
            f"| {told} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--smoother", action="store_true")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--rows", default="")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    estimator = [word for key in options.set for word in ("--set", key)]
    if options.smoother:
        estimator += ["--set", "estimator=smoother"]
    for scene, (scenario, keys) in SCENES.items():
        print(f"\n{scene}, {'smoother' if options.smoother else 'filter'}, seed {options.seed}\n")
        print("| fault | largest 3D error, m (its sigma; level horizontal, vertical) | largest error / sigma | "
              "largest error / level | misleading epochs | told | 3D error when told, m (sigma; levels) |")
        print("|---|---|---|---|---|---|---|", flush=True)
        begin = None
        chosen = {}
        def simulate(name, faults):
            folder = options.out / f"{scene.replace(' ', '_')}_{options.seed}" / name.replace(" ", "_").replace(",", "")
            folder.mkdir(parents=True, exist_ok=True)
            if not (folder / "truth.csv").exists():
                words = [word for key in keys for word in ("--set", key)]
                run(options.bin / "leonav-sim", scenario, "--seed", options.seed, *words, "--set", f"duration_s={DURATION_S}",
                    "--set", f"faults={faults}", "-o", folder / "run.lcmlog", "--truth", folder / "truth.csv")
            return folder
        def replay(folder, systems, *more):
            at = folder / ("smoother" if options.smoother else "filter") / systems
            at.mkdir(parents=True, exist_ok=True)
            run(options.bin / "leonav-replay", "--preset", "urban", "--set", "vehicle.kind=car", "--set",
                f"gnss.systems={SYSTEMS[systems]}", *estimator, *more, folder / "run.lcmlog", "--out", at)
            return at
        plain = simulate("none", "[]")
        at = replay(plain, "all")
        start = min(seconds(row) for row in rows(at / "solution.csv"))
        begin, end = start + BEGIN_S, start + END_S
        chosen["gps"] = steadiest(at / "satellites.csv", begin, end, "G", 1)
        chosen["leo"] = steadiest(at / "satellites.csv", begin, begin + 100, "LMNO", 1)
        span = f"from_s: {BEGIN_S}, to_s: {END_S}"
        one, leo = f"satellites: [{chosen['gps']}]", f"satellites: [{chosen['leo']}]"
        faults = [
            ("none", "[]", ("all", "GPS"), ()),
            ("satellite clock 1 cm/s", f"[{{kind: satellite_clock, {span}, {one}, drift_m_s: 0.01}}]", ("all", "GPS"), ()),
            ("spoofed range 0.2 m/s", f"[{{kind: spoofing, {span}, {one}, pull_m_s: 0.2}}]", ("all", "GPS"), ()),
            ("BeiDou 30 m off", f"[{{kind: satellite_clock, {span}, systems: [beidou], jump_m: 30}}]", ("all",), ()),
            ("LEO orbit 5 m off", f"[{{kind: bad_orbit, {span}, {leo}, radial_m: 5}}]", ("all",), ()),
            ("LEO orbits 5 m off, all", f"[{{kind: bad_orbit, {span}, systems: [leo], radial_m: 5}}]", ("all",), ()),
            ("antenna 2 m too high", "[]", ("all", "GPS"), ("--set", "vehicle.lever_arm_b_m=[0, 0, -3.2]")),
        ]
        for name, script, systems, more in faults:
            if options.rows and options.rows not in name:
                continue
            folder = plain if script == "[]" else simulate(name, script)
            for choice in systems:
                at = replay(folder, choice, *more)
                print(text(f"{name}, {choice}", judge(at, folder / "truth.csv", begin, end)), flush=True)


main()
