"""What a wheeled vehicle cannot do: drives through a city with two tunnels and five minutes of few satellites."""
import numpy as np

import plots
import spread
from scenes import Row, Scene, mode

# From and to, s from the start; no satellite at all, but of the last those that stand high: at most four.
SHORT_TUNNEL, LONG_TUNNEL, FEW = (1500, 1530), (2000, 2060), (2500, 2800)
HIGH = 50
# Least share of a stretch's epochs that must have an answer: without the worst ones an error is no one's.
ENOUGH = 0.99
# Of GPS with everything on and the papers' IMU, m: horizontal RMSE, and at the end of the longer tunnel.
LIMIT, TUNNEL_LIMIT = 1.0, 2.0
ALL = "systems: [gps, galileo, beidou, leo]"
LOW = f"systems: [gps], below_elevation_deg: {HIGH}"
FAULTS = "faults=[" + ", ".join(f"{{kind: outage, from_s: {a}, to_s: {b}, {whom}}}" for (a, b), whom in
                               ((SHORT_TUNNEL, ALL), (LONG_TUNNEL, ALL), (FEW, LOW))) + "]"

# The daemon's default IMU, to the simulator and to the estimator (the preset urban has the tactical one).
MEMS = {"angle_random_walk_deg_per_sqrt_h": 0.3, "velocity_random_walk_m_s_per_sqrt_h": 0.1, "gyro_bias_deg_per_h": 1000,
        "gyro_bias_time_s": 1000, "accel_bias_mgal": 20000, "accel_bias_time_s": 1000, "gyro_scale_ppm": 5000,
        "gyro_scale_time_s": 10000, "accel_scale_ppm": 5000, "accel_scale_time_s": 10000}
MEMS_SETTINGS = [f"imu.{key}={value}" for key, value in MEMS.items()]
GRADES = {"tactical": ([], []), "mems": (["imu.grade=mems", *MEMS_SETTINGS], MEMS_SETTINGS)}

# Ten times a second, in pulses of 5 cm; 1.5 % too long, and 0.2 % more per m/s^2.
ODOMETER = ["odometer.rate_hz=10", "odometer.scale_error_percent=1.5", "odometer.resolution_m=0.05",
            "odometer.slip_percent_per_m_s2=0.2"]
ODOMETER_SCALE_PERCENT = 1.5
CONSTRAINTS = {
    "free": ("none", ["vehicle.kind=handheld"]),
    "slide": ("non-holonomic", ["vehicle.kind=car", "vehicle.zero_velocity=false"]),
    "still": ("zero velocity", ["vehicle.kind=car", "vehicle.non_holonomic=false"]),
    "car": ("both", ["vehicle.kind=car"]),
    "odometer": ("both and an odometer", ["vehicle.kind=car", "vehicle.odometer_resolution_m=0.05"]),
}
TITLES = {f"motion-{grade}": f"Constraints on the motion, GPS alone, {words}" for grade, words in
          (("tactical", "the papers' IMU"), ("mems", "a MEMS IMU"))}


def rows():
    result = []
    for grade, (simulated, told) in GRADES.items():
        drive = ["places=city", FAULTS, *simulated]
        scenes = {False: Scene(f"tunnels-{grade}", 3002.0, drive),
                  True: Scene(f"tunnels-{grade}-odometer", 3002.0, drive + ODOMETER)}
        for short, (words, settings) in CONSTRAINTS.items():
            for estimator, name in (("ekf", "filter"), ("smoother", "smoother")):
                result.append(Row(f"motion-{grade}-{short}-{estimator}", f"motion-{grade}", f"{name}, {words}",
                                  scenes[short == "odometer"], mode(["gps"], True, True) + settings + told + [f"estimator={estimator}"], settle_epochs=600))
    return result


def numbers_of(row, series):
    """RMSE north, east, up, horizontal; 95 % and, in the tunnels and with few satellites, the worst and last, m.

    NaN where epochs of the stretch have no answer.
    """
    t, t_epoch, (north, east, up) = series["t"], series["t_epoch"], series["error"]
    horizontal = np.hypot(north, east)
    interval = float(np.median(np.diff(t_epoch)))
    whole = row.settle_epochs, float(t_epoch[-1]) + interval

    def inside(span):
        return (t > span[0]) & (t <= span[1])

    def number(function, values, span):
        expected = np.count_nonzero((t_epoch > span[0]) & (t_epoch <= span[1]))
        there = values[inside(span)]
        return float(function(there)) if len(there) and len(there) >= ENOUGH * expected else np.nan

    def rms(values):
        return np.sqrt(np.mean(values ** 2))

    at_end = LONG_TUNNEL[1] - 1.5 * interval, LONG_TUNNEL[1]
    return [number(rms, north, whole), number(rms, east, whole), number(rms, up, whole), number(rms, horizontal, whole),
            number(lambda h: np.percentile(h, 95), horizontal, whole), number(np.max, horizontal, SHORT_TUNNEL),
            number(np.max, horizontal, LONG_TUNNEL), number(lambda h: h[-1], horizontal, at_end),
            number(rms, horizontal, FEW), number(np.max, horizontal, FEW)]


HORIZONTAL, TUNNEL_END = 3, 7  # of these


def few_satellites(series):
    """Satellites used at the epochs of those minutes; the epoch at their end has all again."""
    return series["satellites"][(series["t_epoch"] > FEW[0]) & (series["t_epoch"] < FEW[1])]


def cell(values):
    """Mean and spread of the seeds that have the number, and how many these are where some lack it."""
    there = sum(np.isfinite(values))
    return spread.text(spread.mean_spread(values)) + (f" ({there} of {len(values)})" if there < len(values) else "")


def few_lines(rows_, series_of):
    """Whether there were one to four, as the table says."""
    lines = []
    for row in rows_:
        used = np.concatenate([few_satellites(s) for s in series_of[row.name]] or [[]])
        if len(used):
            mark = "" if np.max(used) <= 4 else ": MORE THAN FOUR"
            lines.append(f"{row.title}: {np.min(used):.0f} to {np.max(used):.0f} satellites used at an epoch of these minutes, "
                         f"{np.mean(used):.1f} on the mean, none at {100.0 * np.mean(used == 0):.1f} % of the epochs{mark}.")
    return lines


def table(rows_, results, site, lines):
    lines += ["North, east, up and horizontal RMSE after ten minutes, the horizontal 95 %; the worst horizontal error in a tunnel of "
              f"{SHORT_TUNNEL[1] - SHORT_TUNNEL[0]} s and in one of {LONG_TUNNEL[1] - LONG_TUNNEL[0]} s, and at its end; RMSE and worst in "
              f"{(FEW[1] - FEW[0]) // 60} minutes with those satellites alone that stand higher than {HIGH} degrees (how many: below). Mean ± standard deviation over the seeds, m; "
              "in brackets the seeds that answer there throughout, where not all do.", "",
              "| | seeds | N | E | U | horizontal | 95 % | 30 s, worst | 60 s, worst | 60 s, end | few, RMSE | few, worst |",
              "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    series_of = {row.name: plots.all_series(row, results, site) for row in rows_}
    for row in rows_:
        every = [numbers_of(row, s) for s in series_of[row.name]]
        cells = [cell([one[i] for one in every]) for i in range(10)] if every else ["-"] * 10
        lines.append(f"| {row.title} | {len(every)} of {len(results[row.name])} | " + " | ".join(cells) + " |")
    few = few_lines(rows_, series_of)
    lines += [""] + [f"- {line}" for line in few] if few else []
    for row in rows_:
        scales = [r["odometer_scale_percent"] for r in spread.good(results[row.name]).values() if r.get("odometer_scale_percent")]
        if scales:
            lines += ["", f"{row.title}: by how much the odometer shows more than it should, {ODOMETER_SCALE_PERCENT:g} %, as the filter has found "
                      "it with its sigma at the end of each drive: " + ", ".join(f"{v:.3f} ± {sigma:.3f}" for v, sigma in scales) + " %."]


def verdict(values, limit, seeds):
    """Whether every one of `seeds` keeps to the limit; one without a number does not."""
    kept = sum(v <= limit for v in values)  # NaN is not
    there = [v for v in values if np.isfinite(v)]
    worst = f"{max(there):.2f} m" if there else "-"
    return f"{spread.text(spread.mean_spread(values))} | {worst} | {limit:g} m: " + ("met" if kept == seeds else f"MISSED in {seeds - kept} of {seeds}")


def verdict_lines(rows_, results, site):
    """Of the rows with everything on: whether they keep to the limits, seed by seed."""
    chosen = [row for row in rows_ if row.name.startswith(("motion-tactical-car-", "motion-tactical-odometer-")) and results[row.name]]
    if not chosen:
        return []
    lines = ["## What the constraints bring: verdicts", "",
             "GPS alone, the papers' IMU, every constraint: mean ± standard deviation over the seeds, the worst of them, and whether every seed keeps to the limit "
             f"(horizontal RMSE after ten minutes; horizontal error at the end of the tunnel of {LONG_TUNNEL[1] - LONG_TUNNEL[0]} s).", "",
             "| | seeds | horizontal, m | worst | limit | 60 s, end, m | worst | limit |", "|---|---|---|---|---|---|---|---|"]
    for row in chosen:
        seeds = len(results[row.name])
        every = [numbers_of(row, s) for s in plots.all_series(row, results, site)]
        cells = [verdict([one[i] for one in every], limit, seeds) for i, limit in ((HORIZONTAL, LIMIT), (TUNNEL_END, TUNNEL_LIMIT))]
        lines.append(f"| `{row.name}` | {len(every)} of {seeds} | " + " | ".join(cells) + " |")
    return lines + [""]
