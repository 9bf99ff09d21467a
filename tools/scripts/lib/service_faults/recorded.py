"""What a run's outputs were, with the s since the drive's start at which they arrived."""
import csv
import math
from typing import NamedTuple

import numpy as np

import lcm_log
import leonav
from leonav.lcm_types import TYPES
from service_faults.drive import PREFIX, START_NS

EQUATOR_M, FLATTENING = 6378137.0, 1 / 298.257223563  # WGS84
NONE, FILTER, SMOOTHER = (TYPES["solution_t"].constants["SOURCE_" + name] for name in ("NONE", "EKF", "SMOOTHER"))


class Health(NamedTuple):
    t: float
    status: str
    why: str
    source: str


class Event(NamedTuple):
    t: float
    kind: int
    code: int
    value: float


IN_USE = tuple(TYPES["satellite_report_t"].constants["REASON_" + name] for name in ("USED", "DOWNWEIGHTED"))


class Epoch(NamedTuple):
    """What became of the satellites of an epoch: reasons by (system, number). The error is the filter's, 3D, NaN outside the truth."""
    t: float
    reasons: dict
    error: float

    def in_use(self, system):
        return sum(of == system and reason in IN_USE for (of, _), reason in self.reasons.items())


def ecef(latitude, longitude, height):
    squared = FLATTENING * (2 - FLATTENING)
    radius = EQUATOR_M / np.sqrt(1 - squared * np.sin(latitude)**2)
    return np.stack([(radius + height) * np.cos(latitude) * np.cos(longitude), (radius + height) * np.cos(latitude) * np.sin(longitude),
                     (radius * (1 - squared) + height) * np.sin(latitude)], axis=-1)


class Truth:
    def __init__(self, path):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        column = lambda name: np.array([float(row[name]) for row in rows])
        self.t = column("gps_week") * 604800 + column("gps_tow_s") - START_NS * 1e-9
        self.p_e = ecef(np.radians(column("latitude_deg")), np.radians(column("longitude_deg")), column("height_m"))

    def at(self, t):
        return np.stack([np.interp(t, self.t, self.p_e[:, axis]) for axis in range(3)], axis=-1)


def filter_error(solution, truth):
    time = (int(solution["time_ns"]) - START_NS) * 1e-9
    if int(solution["source"]) == NONE or not truth.t[0] <= time <= truth.t[-1]:
        return math.nan
    return float(np.linalg.norm(np.array(solution["p_e"]) - truth.at(time)))


class Outputs:
    """`t`: arrivals of SOLUTION; `time`: what they are stamped with, s since the start; `error`, `sigma`: 3D, m, NaN outside the truth."""

    def __init__(self, log, truth, begin_wall_s):
        self.health, self.events, self.epochs = [], [], []
        arrivals, bodies = [], []
        for wall, channel, data in lcm_log.messages(log):
            t = wall - begin_wall_s
            if channel == PREFIX + "SOLUTION":
                arrivals.append(t)
                bodies.append(data[8:])
            elif channel == PREFIX + "HEALTH":
                _, fields = leonav.decode(data)
                self.health.append(Health(t, fields["status"], fields["why"], fields["source"]))
            elif channel == PREFIX + "EPOCH":
                _, fields = leonav.decode(data)
                reasons = {(int(one["system"]), int(one["number"])): int(one["reason"]) for one in fields["satellites"]}
                self.epochs.append(Epoch(t, reasons, filter_error(fields["solution"], truth)))
            elif channel == PREFIX + "EVENT":
                _, fields = leonav.decode(data)
                self.events.append(Event(t, int(fields["kind"]), int(fields["code"]), float(fields["value"])))
        rows = np.frombuffer(b"".join(bodies), TYPES["solution_t"].dtype)
        self.t, self.source = np.array(arrivals), rows["source"]
        self.time = (rows["time_ns"].astype(np.int64) - START_NS) * 1e-9
        inside = (self.time >= truth.t[0]) & (self.time <= truth.t[-1])
        self.error = np.where(inside, np.linalg.norm(rows["p_e"] - truth.at(self.time), axis=-1), math.nan)
        self.sigma = np.linalg.norm(rows["sigma_p_n"], axis=-1)

    def longest_gap(self, begin, end):
        times = [begin, *self.t[(self.t >= begin) & (self.t < end)], end]
        return float(np.diff(times).max())

    def epochs_within(self, begin, end):
        return [one for one in self.epochs if begin <= one.t < end]

    def missing_stamps(self, begin, end, interval_s):
        """(instants within the span that no SOLUTION is stamped with, how many there are)."""
        first, end = round(begin / interval_s), round(end / interval_s)
        stamped = np.unique(np.round(self.time / interval_s).astype(np.int64))
        return end - first - int(np.count_nonzero((stamped >= first) & (stamped < end))), end - first

    def longest_health_gap(self, begin, end):
        times = [begin, *(one.t for one in self.health if begin <= one.t < end), end]
        return max(b - a for a, b in zip(times, times[1:]))

    def health_changes(self, begin, end):
        """When status or text of HEALTH became another one."""
        said = [one for one in self.health if begin <= one.t < end]
        return [b.t for a, b in zip(said, said[1:]) if (a.status, a.why) != (b.status, b.why)]

    def share_of(self, source, begin, end):
        """Of the SOLUTION of the span, those that the source gave."""
        chosen = self.source[(self.t >= begin) & (self.t < end)]
        return float(np.mean(chosen == source)) if len(chosen) else math.nan

    def worst(self, begin, end):
        """(error, its sigma, s of its arrival) where the error is largest, and the largest error over its sigma."""
        chosen = np.flatnonzero((self.t >= begin) & (self.t < end) & np.isfinite(self.error))
        if not len(chosen):
            return math.nan, math.nan, math.nan, math.nan
        at = chosen[np.argmax(self.error[chosen])]
        return float(self.error[at]), float(self.sigma[at]), float(self.t[at]), float((self.error[chosen] / self.sigma[chosen]).max())

    def off_in_time(self, begin, end, limit_s=2.0):
        """How many solutions are stamped with another time than that of their arrival."""
        chosen = (self.t >= begin) & (self.t < end)
        return int(np.count_nonzero(np.abs(self.time - self.t)[chosen] > limit_s))

    def first_after(self, t):
        """The arrival of the first solution at or after `t`."""
        later = self.t[self.t >= t]
        return float(later[0]) if len(later) else math.inf
