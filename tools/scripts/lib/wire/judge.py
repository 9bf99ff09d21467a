"""What the programs said in a run, and how far their solution was from the truth."""
import bisect
import csv
import math
import re

WEEK_S = 604800
EARTH_M = 6378137.0


def columns(path, names):
    """Rows of numbers; an empty field is NaN."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        header = next(rows)
        places = [header.index(name) for name in names]
        return [[float(row[place]) if row[place] else math.nan for place in places] for row in rows if len(row) == len(header)]


def satellites(path):
    """(week, s of the week, source of the orbit, whether used, system) of each satellite of each epoch."""
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            yield int(row["gps_week"]), float(row["gps_tow_s"]), row["orbit"], row["used"] == "1", row["satellite"][0]


class Track:
    """The errors of a solution: rows of (s since the first epoch, 3D error in m, its 1 sigma in m)."""

    def __init__(self, solution, truth, first_gps_s):
        truth = columns(truth, ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m"))
        times = [row[0] * WEEK_S + row[1] - first_gps_s for row in truth]
        self.rows, self.outside = [], 0
        for week, tow, latitude, longitude, height, *sigma in columns(
                solution, ("gps_week", "gps_tow_s", "latitude_deg", "longitude_deg", "height_m", "std_north_m", "std_east_m", "std_down_m")):
            t = week * WEEK_S + tow - first_gps_s
            after = bisect.bisect_left(times, t - 1e-6)
            if not 0 < after < len(times):
                self.outside += 1
                continue
            share = (t - times[after - 1]) / (times[after] - times[after - 1])
            at = [a + share * (b - a) for a, b in zip(truth[after - 1][2:], truth[after][2:])]
            # A sphere does for differences of some metres.
            north = math.radians(latitude - at[0]) * EARTH_M
            east = math.radians(longitude - at[1]) * EARTH_M * math.cos(math.radians(at[0]))
            self.rows.append((t, math.hypot(north, east, height - at[2]), math.hypot(*sigma)))

    def during(self, begin, end):
        return [row for row in self.rows if begin <= row[0] < end]

    def worst(self, begin, end):
        """(error, its sigma, s) where the error is largest."""
        rows = self.during(begin, end)
        if not rows:
            return math.nan, math.nan, math.nan
        t, error, sigma = max(rows, key=lambda row: row[1])
        return error, sigma, t

    def worst_sigmas(self, begin, end):
        return max((error / sigma for _, error, sigma in self.during(begin, end)), default=math.nan)

    def longest_gap(self, begin, end):
        times = [begin, *(row[0] for row in self.during(begin, end)), end]
        return max(b - a for a, b in zip(times, times[1:]))

    def settled_after(self, end, limit_m):
        """s from `end` on, from which the error stays below `limit_m`; inf: it never does."""
        rows = self.during(end, math.inf)
        if not rows or rows[-1][1] >= limit_m:
            return math.inf
        late = [t for t, error, _ in rows if error >= limit_m]
        return max(late, default=end) - end


class Said:
    """The lines of a program's log, with the s since the run began, at `begin_day_s` of the day."""

    LINE = re.compile(r"\S+ (\d\d):(\d\d):(\d\d\.\d+) (\w+): (.*)")

    def __init__(self, text, begin_day_s):
        self.lines = []
        for line in text.splitlines():
            if not (found := self.LINE.match(line)):
                continue
            t = int(found[1]) * 3600 + int(found[2]) * 60 + float(found[3]) - begin_day_s
            self.lines.append(((t + 43200) % 86400 - 43200, found[5]))

    def first(self, pattern, since=-math.inf):
        """(s, line) of the first line that matches."""
        return next(((t, line) for t, line in self.lines if t >= since and re.search(pattern, line)), None)
