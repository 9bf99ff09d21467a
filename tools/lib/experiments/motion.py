"""What a wheeled vehicle cannot do: drives through a city with two tunnels and five minutes of few satellites."""
import numpy as np

import plots
import spread
from scenes import Row, Scene, mode

# From and to, s from the start; no satellite at all, but of the last those that stand high: one to four.
SHORT_TUNNEL, LONG_TUNNEL, FEW = (1500, 1530), (2000, 2060), (2500, 2800)
HIGH = 50
ALL = "systems: [gps, galileo, beidou, leo]"
LOW = f"systems: [gps], below_elevation_deg: {HIGH}"
FAULTS = "faults=[" + ", ".join(f"{{kind: outage, from_s: {a}, to_s: {b}, {whom}}}" for (a, b), whom in
                               ((SHORT_TUNNEL, ALL), (LONG_TUNNEL, ALL), (FEW, LOW))) + "]"

# The daemon's default IMU, to the simulator and to the estimator (config/urban.yaml has the tactical one).
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
    """RMSE north, east, up, horizontal; 95 % and, in the tunnels and with few satellites, the worst and last, m."""
    t, (north, east, up) = series["t"], series["error"]
    horizontal = np.hypot(north, east)
    judged = t >= row.settle_epochs

    def rms(values):
        return float(np.sqrt(np.mean(values ** 2))) if len(values) else np.nan

    def within(span):
        return horizontal[(t > span[0]) & (t <= span[1])]

    few = within(FEW)
    last = within(LONG_TUNNEL)[-1:]
    return [rms(north[judged]), rms(east[judged]), rms(up[judged]), rms(horizontal[judged]),
            float(np.percentile(horizontal[judged], 95)), float(np.max(within(SHORT_TUNNEL), initial=0.0)),
            float(np.max(within(LONG_TUNNEL), initial=0.0)), float(last[0]) if len(last) else np.nan, rms(few),
            float(np.max(few, initial=0.0))]


def table(rows_, results, runner, lines):
    lines += ["North, east, up and horizontal RMSE after ten minutes, the horizontal 95 %; the worst horizontal error in a tunnel of "
              f"{SHORT_TUNNEL[1] - SHORT_TUNNEL[0]} s and in one of {LONG_TUNNEL[1] - LONG_TUNNEL[0]} s, and at its end; RMSE and worst in "
              f"{(FEW[1] - FEW[0]) // 60} minutes with those satellites alone that stand higher than {HIGH} degrees (one to four). Mean ± standard deviation over the seeds, m.", "",
              "| | seeds | N | E | U | horizontal | 95 % | 30 s, worst | 60 s, worst | 60 s, end | few, RMSE | few, worst |",
              "|---|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in rows_:
        every = [numbers_of(row, s) for s in plots.all_series(row, results, runner)]
        cells = [spread.text(spread.mean_spread([one[i] for one in every])) for i in range(10)] if every else ["-"] * 10
        lines.append(f"| {row.title} | {len(every)} | " + " | ".join(cells) + " |")
    for row in rows_:
        scales = [r["odometer_scale_percent"] for r in spread.good(results[row.name]).values() if r.get("odometer_scale_percent")]
        if scales:
            lines += ["", f"{row.title}: by how much the odometer shows more than it should, {ODOMETER_SCALE_PERCENT:g} %, as the filter has found "
                      "it with its sigma at the end of each drive: " + ", ".join(f"{v:.3f} ± {sigma:.3f}" for v, sigma in scales) + " %."]
