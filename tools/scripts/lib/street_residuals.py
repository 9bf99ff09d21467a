#!/usr/bin/env python3
"""Residuals of one recording at its true positions, as rows of a residual library.

street_residuals.py RECORDING REPLAY_FOLDER TRUTH OUT [--offset]

REPLAY_FOLDER: of leonav-replay --out. TRUTH: truth.csv, or RTKLIB's .pos, of which fixed rows count. --offset: the truth is
off by a constant, which is the mean difference from the solution.

A residual of the replay belongs to the estimate x. At the truth it is, to the first order in the estimate's error,
    r_true = r + u (p_true - p) + clock,   u: from the antenna to the satellite,
with the clock of the satellite's system put back. Subtracted is what all satellites share: the median over the satellites of
the epoch, and before it a constant per system and signal, the median over the recording. Dopplers (range rates, so that the
sign is the same) are treated alike, with the true velocity by differences. The carrier's error is known by its change from
epoch to epoch alone: the change of the carrier less that of the predicted range, which is the code less its residual. Along
an arc these steps add up; of the sum the median over half a minute is subtracted, which is atmosphere and clocks.
What stays for minutes (atmosphere, orbits, delays of a satellite's signals) is no street's: of each satellite and signal the
median of its codes over ten minutes is subtracted.
"""
import argparse
import bisect
import collections
import csv
import math
import statistics
import sys

HEADER = ("recording,satellite,piece,time_s,elevation_deg,cn0_loss_db,code_1_m,code_2_m,doppler_m_s,carrier,carrier_m")
WEEK_S = 604800.0
LONGEST_GAP_S = 60.0  # of a satellite that comes again; a longer one ends the piece
SILENT = {"geometry_free", "melbourne_wuebbena", "doppler", "range_change", "filter"}  # arcs ended without a flag
HALF_SLOW_MS, HALF_CARRIER_MS = 300_000, 15_000
CLASS_DEG = 15.0
# Larger ones are mistakes of the recording or the truth, not of a street.
MAX_CODE_M, MAX_DOPPLER_M_S, MAX_STEP_M = 300.0, 20.0, 1.0
NO_CARRIER, BEGINS, GOES_ON, SLIPS = 0, 1, 2, 3


def stamp(week, tow):
    return round((float(week) * WEEK_S + float(tow)) * 1e3)  # ms


def ecef(latitude, longitude, height):
    a, e2 = 6378137.0, 0.00669437999014
    n = a / math.sqrt(1.0 - e2 * math.sin(latitude) ** 2)
    return ((n + height) * math.cos(latitude) * math.cos(longitude), (n + height) * math.cos(latitude) * math.sin(longitude),
            (n * (1.0 - e2) + height) * math.sin(latitude))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def less(a, b):
    return tuple(x - y for x, y in zip(a, b))


def axes(latitude, longitude):
    """North, east, up in ECEF."""
    s, c, sl, cl = math.sin(latitude), math.cos(latitude), math.sin(longitude), math.cos(longitude)
    return (-s * cl, -s * sl, c), (-sl, cl, 0.0), (c * cl, c * sl, s)


def in_ecef(north_east_up, v_ned):
    north, east, up = north_east_up
    v = list(v_ned)
    return tuple(n * v[0] + e * v[1] - u * v[2] for n, e, u in zip(north, east, up))


def read_truth(path):
    """Times in ms, positions and velocities (None where the file has none) in ECEF, in order."""
    points = []
    with open(path) as file:
        if path.endswith(".pos"):
            for line in file:
                words = line.split()
                if words and not words[0].startswith("%") and words[5] == "1":
                    place = [math.radians(float(x)) for x in words[2:4]]
                    points.append((stamp(words[0], words[1]), ecef(*place, float(words[4])), None))
            return sorted(points)
        for row in csv.DictReader(file):
            if row.get("fixed", "1") == "1":
                place = [math.radians(float(row[x])) for x in ("latitude_deg", "longitude_deg")]
                v = [row[x] for x in ("v_north_m_s", "v_east_m_s", "v_down_m_s")]
                points.append((stamp(row["gps_week"], row["gps_tow_s"]), ecef(*place, float(row["height_m"])),
                               in_ecef(axes(*place), map(float, v)) if all(v) else None))
    return sorted(points)


class Truth:
    WIDEST_MS = 1100  # between two points that are interpolated
    MOST_M_S2 = 6.0   # a wrong fix leaps

    def __init__(self, path):
        points = read_truth(path)
        kept = [p for i, p in enumerate(points) if not self.leaps(points, i)]
        self.times, self.points, self.velocities = ([p[i] for p in kept] for i in range(3))

    def leaps(self, points, i):
        if i in (0, len(points) - 1):
            return False
        (t0, a, _), (t1, b, _), (t2, c, _) = points[i - 1:i + 2]
        if t2 - t0 > 2 * self.WIDEST_MS or t1 - t0 < 200:
            return False
        share = (t1 - t0) / (t2 - t0)
        bend = [y - x - share * (z - x) for x, y, z in zip(a, b, c)]
        return math.sqrt(dot(bend, bend)) > 0.5 * self.MOST_M_S2 * (1e-3 * (t2 - t0) / 2) ** 2 + 0.5

    def between(self, values, t):
        i = bisect.bisect_left(self.times, t)
        if i < len(self.times) and self.times[i] == t:
            return values[i]
        if i == 0 or i == len(self.times) or self.times[i] - self.times[i - 1] > self.WIDEST_MS:
            return None
        share = (t - self.times[i - 1]) / (self.times[i] - self.times[i - 1])
        a, b = values[i - 1:i + 1]
        return tuple(x + share * (y - x) for x, y in zip(a, b)) if a and b else None

    def at(self, t):
        return self.between(self.points, t)

    def velocity(self, t):
        if self.velocities[0]:
            return self.between(self.velocities, t)
        half = max(200, self.times[1] - self.times[0])
        a, b = self.at(t - half), self.at(t + half)
        return tuple((y - x) / (2e-3 * half) for x, y in zip(a, b)) if a and b else None


def rows_of(folder, name):
    with open(f"{folder}/{name}.csv") as file:
        for row in csv.DictReader(file):
            yield stamp(row["gps_week"], row["gps_tow_s"]), row


class Estimate:
    """The solution of one epoch: position and velocity in ECEF, axes, clocks by the system's letter."""

    def __init__(self, row):
        latitude, longitude = math.radians(float(row["latitude_deg"])), math.radians(float(row["longitude_deg"]))
        self.p = ecef(latitude, longitude, float(row["height_m"]))
        self.axes = axes(latitude, longitude)
        self.v = in_ecef(self.axes, (float(row[x]) for x in ("v_north_m_s", "v_east_m_s", "v_down_m_s")))
        self.clock, self.drift = {}, {}


def estimates(folder):
    found = {t: Estimate(row) for t, row in rows_of(folder, "solution")}
    letters = {"G": "gps", "E": "galileo", "C": "beidou"}
    for t, row in rows_of(folder, "epochs"):
        if t not in found:
            continue
        for letter, system in letters.items():
            if row[f"clock_{system}_m"]:
                found[t].clock[letter] = float(row[f"clock_{system}_m"])
                found[t].drift[letter] = float(row[f"drift_{system}_m_s"])
    return found


def direction(estimate, elevation_deg, azimuth_deg):
    e, a = math.radians(elevation_deg), math.radians(azimuth_deg)
    parts = (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
    return tuple(sum(p * axis[i] for p, axis in zip(parts, estimate.axes)) for i in range(3))


class Sight:
    """One satellite at one epoch, with what was measured of it."""

    def __init__(self, row):
        self.elevation_deg, self.azimuth_deg = float(row["elevation_deg"]), float(row["azimuth_deg"])
        self.cn0 = float(row["cn0_dbhz"])
        self.arc_started, self.causes = row["arc_started"] == "1", set(filter(None, row["arc_causes"].split("|")))
        self.codes = {}  # signal -> residual at the truth, with clock
        self.doppler = self.carrier = self.predicted = None
        self.carrier_signals = ""


def sights(folder, truth, shift, solutions):
    """Time -> satellite -> Sight, at epochs whose truth is known."""
    found = collections.defaultdict(dict)
    for t, row in rows_of(folder, "satellites"):
        if t in solutions and truth.at(t) and row["used"] == "1":
            found[t][row["satellite"]] = Sight(row)
    for t, row in rows_of(folder, "measurements"):
        sight = found.get(t, {}).get(row["satellite"])
        if sight is None:
            continue
        estimate, letter = solutions[t], row["satellite"][0]
        u = direction(estimate, sight.elevation_deg, sight.azimuth_deg)
        residual, observation = float(row["residual"]), float(row["observation"])
        if row["observable"] == "code":
            there = tuple(a + b for a, b in zip(truth.at(t), shift))
            at_truth = residual + dot(u, less(there, estimate.p))
            if sight.predicted is None:
                sight.predicted = observation - at_truth - estimate.clock[letter]
            sight.codes[row["signals"]] = at_truth + estimate.clock[letter]
        elif row["observable"] == "doppler" and truth.velocity(t):
            sight.doppler = residual + dot(u, less(truth.velocity(t), estimate.v)) + estimate.drift[letter]
        elif row["observable"] == "carrier":
            sight.carrier, sight.carrier_signals = observation, row["signals"]
    return found


def without_common(values):
    """values: time -> group -> list of (key, value). Returns time -> {key: value without what all share}."""
    bias = collections.defaultdict(float)
    for _ in range(3):
        left = collections.defaultdict(list)
        middle = {}
        for t, groups in values.items():
            middle[t] = statistics.median(v - bias[g] for g, items in groups.items() for _, v in items)
            for g, items in groups.items():
                left[g] += [v - middle[t] for _, v in items]
        for g, v in left.items():
            bias[g] = statistics.median(v)
    return {t: {key: v - bias[g] - middle[t] for g, items in groups.items() for key, v in items}
            for t, groups in values.items()}


def quick_part(items, half_ms):
    """[(time, value)] less the median over half_ms before and after, which is told anew every twentieth of that."""
    times = [t for t, _ in items]
    until, quick = None, []
    for t, value in items:
        if until is None or t >= until:
            around = items[bisect.bisect_left(times, t - half_ms):bisect.bisect_right(times, t + half_ms)]
            slow, until = statistics.median(v for _, v in around), t + half_ms // 20
        quick.append((t, value - slow))
    return quick


def without_slow(codes):
    """Time -> {(satellite, signal): value}."""
    series = collections.defaultdict(list)
    for t in sorted(codes):
        for key, value in codes[t].items():
            series[key].append((t, value))
    for key, items in series.items():
        for t, value in quick_part(items, HALF_SLOW_MS):
            codes[t][key] = value
    return codes


def grouped(found, items_of):
    """items_of(satellite, sight) gives (group, key, value)."""
    values = {}
    for t, satellites in found.items():
        groups = collections.defaultdict(list)
        for satellite, sight in satellites.items():
            for group, key, value in items_of(satellite, sight):
                groups[group].append((key, value))
        if sum(map(len, groups.values())) >= 5:
            values[t] = groups
    return values


def carrier_steps(found):
    """Time -> satellite -> change of the carrier's error since the epoch before."""
    times = sorted(found)
    changes = {}
    for before, t in zip(times, times[1:]):
        for satellite, now in found[t].items():
            then = found[before].get(satellite)
            if then is None or None in (now.carrier, then.carrier, now.predicted, then.predicted):
                continue
            if now.arc_started or now.carrier_signals != then.carrier_signals:
                continue
            change = (now.carrier - then.carrier) - (now.predicted - then.predicted)
            changes.setdefault(t, collections.defaultdict(list))[satellite[0]].append((satellite, change))
    common = {t: groups for t, groups in changes.items() if sum(map(len, groups.values())) >= 4}
    # The systems' clocks run alike: no constant per system, the median of the epoch alone.
    return {t: {s: v - statistics.median(x for items in groups.values() for _, x in items)
                for items in groups.values() for s, v in items} for t, groups in common.items()}


def carrier_errors(steps):
    """Time -> satellite -> error of the carrier within its arc; an arc is a run of steps."""
    times = sorted(steps)
    arcs, open_arcs = [], {}
    for before, t in zip([None] + times, times):
        for satellite, step in steps[t].items():
            if abs(step) > MAX_STEP_M:
                continue
            arc = open_arcs.get(satellite)
            if arc is None or arc[-1][0] != before:
                arc = open_arcs[satellite] = []
                arcs.append((satellite, arc))
            arc.append((t, (arc[-1][1] if arc else 0.0) + step))
    errors = {t: {} for t in times}
    for satellite, arc in arcs:
        for t, value in quick_part(arc, HALF_CARRIER_MS):
            errors[t][satellite] = value
    return errors


def open_sky_cn0(found):
    """System and class of elevation -> the C/N0 that a tenth of the satellites exceed."""
    values = collections.defaultdict(list)
    for satellites in found.values():
        for satellite, sight in satellites.items():
            values[satellite[0], int(sight.elevation_deg / CLASS_DEG)].append(sight.cn0)
    return {key: sorted(v)[int(0.9 * (len(v) - 1))] for key, v in values.items()}


def carrier_word(sight, error):
    if sight.carrier is None:
        return NO_CARRIER
    if not sight.arc_started:
        return GOES_ON if error is not None else BEGINS
    return SLIPS if sight.causes and sight.causes <= SILENT else BEGINS


def runs(times, interval_ms):
    """Epochs without a hole."""
    run = []
    for t in times:
        if run and t - run[-1] > 1.5 * interval_ms:
            yield run
            run = []
        run.append(t)
    if run:
        yield run


def pieces(times, seen, interval_ms):
    """Runs of epochs from the first to the last at which a satellite was seen; absent for LONGEST_GAP_S, it ends one."""
    for run in runs(times, interval_ms):
        last = None
        for t in run:
            if t not in seen:
                continue
            if last is None or t - last > 1e3 * LONGEST_GAP_S:
                if last is not None:
                    yield [x for x in run if first <= x <= last]
                first = t
            last = t
        if last is not None:
            yield [x for x in run if first <= x <= last]


def number(value, digits, most):
    return "" if value is None or abs(value) > most else f"{value:.{digits}f}"


class Library:
    def __init__(self, found):
        self.found, self.strongest, self.carriers = found, open_sky_cn0(found), carrier_errors(carrier_steps(found))
        self.codes = without_slow(without_common(grouped(found, lambda satellite, sight: [
            ((satellite[0], signal), (satellite, signal), value) for signal, value in sight.codes.items()])))
        self.dopplers = without_common(grouped(found, lambda satellite, sight: [] if sight.doppler is None else
                                               [(satellite[0], satellite, sight.doppler)]))

    def received(self, t, name):
        """The row's fields from elevation on; None where nothing was received."""
        sight = self.found[t].get(name)
        own = [self.codes[t][name, signal] for signal in sight.codes][:2] if sight else []
        if not own or max(map(abs, own)) > MAX_CODE_M:
            return None
        carrier = self.carriers.get(t, {}).get(name)
        word = carrier_word(sight, carrier)
        loss = self.strongest[name[0], int(sight.elevation_deg / CLASS_DEG)] - sight.cn0
        return ",".join((f"{sight.elevation_deg:.2f}", f"{loss:.1f}", number(own[0], 3, MAX_CODE_M),
                         number(own[1], 3, MAX_CODE_M) if len(own) > 1 else "",
                         number(self.dopplers.get(t, {}).get(name), 4, MAX_DOPPLER_M_S), str(word),
                         number(carrier if word == GOES_ON else None, 4, MAX_STEP_M)))

    def rows(self, recording):
        times = sorted(self.codes)
        interval_ms = statistics.median(b - a for a, b in zip(times, times[1:]))
        piece = 0
        for name in sorted({satellite for t in times for satellite in self.found[t]}):
            seen = {t for t in times if self.received(t, name)}
            for run in pieces(times, seen, interval_ms):
                piece += 1
                elevation = ""
                for i, t in enumerate(run):
                    fields = self.received(t, name)
                    elevation = fields.split(",")[0] if fields else elevation
                    yield f"{recording},{name},{piece},{1e-3 * i * interval_ms:.3f},{fields or f'{elevation},,,,,0,'}"


def mean_offset(truth, solutions):
    differences = [less(estimate.p, truth.at(t)) for t, estimate in solutions.items() if truth.at(t)]
    return tuple(statistics.fmean(d[i] for d in differences) for i in range(3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording")
    parser.add_argument("replay")
    parser.add_argument("truth")
    parser.add_argument("out")
    parser.add_argument("--offset", action="store_true")
    words = parser.parse_args()
    truth, solutions = Truth(words.truth), estimates(words.replay)
    shift = mean_offset(truth, solutions) if words.offset else (0.0, 0.0, 0.0)
    found = sights(words.replay, truth, shift, solutions)
    if len(found) < 10:
        sys.exit(f"street_residuals: {words.truth}: fewer than ten epochs of the replay lie in the truth")
    with open(words.out, "w") as file:
        file.write(HEADER + "\n")
        for row in Library(found).rows(words.recording):
            file.write(row + "\n")


if __name__ == "__main__":
    main()
