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
NONE, ALIGNING = TYPES["solution_t"].constants["SOURCE_NONE"], TYPES["solution_t"].constants["SOURCE_ALIGNING"]


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


class Outputs:
    """`t`: arrivals of SOLUTION; `time`: what they are stamped with, s since the start; `error`, `sigma`: 3D, m, NaN outside the truth."""

    def __init__(self, log, truth, begin_wall_s):
        self.health, self.events = [], []
        arrivals, bodies = [], []
        for wall, channel, data in lcm_log.messages(log):
            t = wall - begin_wall_s
            if channel == PREFIX + "SOLUTION":
                arrivals.append(t)
                bodies.append(data[8:])
            elif channel == PREFIX + "HEALTH":
                _, fields = leonav.decode(data)
                self.health.append(Health(t, fields["status"], fields["why"], fields["source"]))
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
