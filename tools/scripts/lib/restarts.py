"""Restarts and wrong headings by COMMAND messages: errors before, meanwhile and after; Markdown tables to standard output.

  restarts.py BIN OUT [SCENES [SEEDS [CASES]]]     OUT/types holds lcm-gen's Python of command_t; exits with 1 if a bound does not hold

Times are seconds since the truth's first epoch.
"""
import csv
import dataclasses
import math
import pathlib
import re
import struct
import sys

import numpy as np

import lcm_log
from smooth import CAR, FAMILIES, SEEDS, SYSTEMS, choose, estimate, geometric_mean, print_table, rms, run, simulate, verdict, with_settings
from fleet import measure

DURATION_S = 600.0
LEVER_ARM_B = np.array([0.0, 0.0, -1.2])  # m, of the scenarios and of preset urban
RESTART, SET_HEADING = 0, 1  # kinds of command_t
GOOD_SIGMA, HONEST_SIGMA = math.radians(2.0), math.radians(30.0)  # of wrong headings: the former claims to be good
LEVELS = ("protection_horizontal_m", "protection_vertical_m")
BESIDE = "filter beside the smoother"  # it answers where the smoother is late
ESTIMATORS = ("filter", "smoother", "whole log", BESIDE)
BEFORE, FIRST, SECOND = (-30.0, 0.0), (0.0, 30.0), (30.0, 120.0)
SETTLED_S, JUDGED_S = 120.0, (0.0, 120.0)
RATE_HZ = 10.0  # at which the time without an answer is counted
SETTLED_FACTOR, BEGUN_FACTOR = 1.1, 1.1
HEADING_CAUSE, COMMAND_CAUSE = "6", "0"  # codes of filter_reset


@dataclasses.dataclass(frozen=True)
class Command:
    at: float
    kind: int
    off: float = 0.0  # rad, from the truth's heading
    sigma: float = 0.0  # rad, as stated


@dataclasses.dataclass(frozen=True)
class Case:
    commands: tuple
    from_departure: bool = False  # the event is that the vehicle sets off, not the command


# Half a second after an epoch, so that the answer has to wait for the next one.
CASES = {
    "restart": Case((Command(240.5, RESTART), Command(420.5, RESTART))),
    # The drives are not fast enough then for these to be refused as contradicting the motion.
    "heading set 30 deg wrong": Case((Command(240.5, SET_HEADING, math.radians(30.0), GOOD_SIGMA),)),
    "heading set 15 deg wrong": Case((Command(240.5, SET_HEADING, math.radians(15.0), GOOD_SIGMA),)),
    "30 deg wrong, sigma 30 deg": Case((Command(240.5, SET_HEADING, math.radians(30.0), HONEST_SIGMA),)),
    "start 20 deg wrong": Case((Command(4.5, SET_HEADING, math.radians(20.0), GOOD_SIGMA),), True),
}


# Input.
def command_type(out):
    sys.path.insert(0, str(out / "types"))
    from leonav.command_t import command_t
    return command_t


def write_commanded(source, target, commands, truth, command_t):
    """The log `source` with commands, each before the first sample of the IMU that is later."""
    def encoded(number, command):
        message = command_t()
        message.time_ns = round((truth.origin + command.at) * 1e9)
        message.sequence, message.schema, message.kind = number, 1, command.kind
        if command.kind == SET_HEADING:
            message.value = math.remainder(truth.yaw_at(command.at) + command.off, math.tau)
            message.sigma = command.sigma
        return message.time_ns, message.encode()

    def with_commands():
        waiting = [encoded(number, command) for number, command in enumerate(commands, 1)]
        for wall, channel, data in lcm_log.messages(source):
            while channel == "LEONAV_IMU" and waiting and struct.unpack_from(">q", data, 8)[0] > waiting[0][0]:
                yield wall, "LEONAV_COMMAND", waiting.pop(0)[1]
            yield wall, channel, data
        if waiting:
            sys.exit(f"{source}: ends before the command at {commands[-1].at:g} s")

    lcm_log.write(target, with_commands())


def write_begun(source, target, begin, truth):
    """The log `source` without measurements before `begin`."""
    def later():
        for wall, channel, data in lcm_log.messages(source):
            measured = channel in ("LEONAV_IMU", "LEONAV_GNSS_EPOCH")
            if not measured or struct.unpack_from(">q", data, 8)[0] > (truth.origin + begin) * 1e9:
                yield wall, channel, data

    lcm_log.write(target, later())


class Truth:
    def __init__(self, path):
        self.path = path
        table = measure.columns(path, (*measure.POSITION, *measure.VELOCITY, "roll_deg", "pitch_deg", "yaw_deg"))
        self.week = table[0][0]
        first = table[1][0]
        self.origin = self.week * measure.WEEK_S + first
        self.t = measure.seconds(table, self.week) - first
        latitude, longitude = np.radians(table[2]), np.radians(table[3])
        self.place, self.turn = measure.ecef(latitude, longitude, table[4]), measure.north_east_down(latitude, longitude)
        self.attitude = np.radians(table[8:11])
        self.departure = float(self.t[np.argmax(np.linalg.norm(table[5:8], axis=0) > 0.5)])

    def yaw_at(self, t):
        return float(np.interp(t, self.t, np.unwrap(self.attitude[2])))

    def arm_n(self):
        """From the IMU to the antenna, north, east, down, [epoch, 3]."""
        (sr, sp, sy), (cr, cp, cy) = np.sin(self.attitude), np.cos(self.attitude)
        rows = ((cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy),
                (cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy), (-sp, sr * cp, cr * cp))
        return np.einsum("ijk,j->ki", np.array(rows), LEVER_ARM_B)


# Judging.
@dataclasses.dataclass
class Track:
    """Epochs of a solution that the truth has; errors north, east, down in m, of the heading in rad, NaN without attitude."""
    t: np.ndarray
    error: np.ndarray
    sigma: np.ndarray
    heading: np.ndarray
    heading_sigma: np.ndarray
    level: np.ndarray  # protection levels, horizontal and vertical, m; NaN: none is known

    def within(self, spans):
        inside = np.any([(self.t >= begin) & (self.t < end) for begin, end in spans], axis=0)
        return Track(*(getattr(self, field.name)[..., inside] for field in dataclasses.fields(Track)))

    def beyond_level(self):
        """How many epochs have an error above its level, and the largest share of a level."""
        north, east, down = self.error
        share = np.array([np.hypot(north, east), np.abs(down)]) / self.level
        return int(np.count_nonzero(np.any(share > 1.0, axis=0))), float(np.nanmax(share))

    def sizes(self):
        return np.linalg.norm(self.error, axis=0)


def track_of(solution, truth):
    """A position without an attitude is the antenna's, and is judged by the antenna's true one."""
    table = measure.columns(solution, (*measure.POSITION, *measure.SIGMA, "yaw_deg", "std_yaw_deg", *LEVELS))
    t = table[0] * measure.WEEK_S + table[1] - truth.origin
    _, own, true = np.intersect1d(np.round(t, 3), np.round(truth.t, 3), return_indices=True)
    table, yaw = table[:, own], np.radians(table[8, own])
    place = measure.ecef(np.radians(table[2]), np.radians(table[3]), table[4])
    error = np.einsum("kij,kj->ki", truth.turn[true], place - truth.place[true])
    error[np.isnan(yaw)] -= truth.arm_n()[true][np.isnan(yaw)]
    heading = (yaw - truth.attitude[2][true] + math.pi) % math.tau - math.pi
    return Track(truth.t[true], error.T, table[5:8], heading, np.radians(table[9]), table[10:12])


def joined(tracks):
    return Track(*(np.concatenate([getattr(track, field.name) for track in tracks], axis=-1) for field in dataclasses.fields(Track)))


def silence(solution, truth, spans):
    """Seconds without a row and without an attitude, the mean of the spans, by rows at RATE_HZ (an epoch's: by epochs)."""
    table = measure.columns(solution, (*measure.POSITION, "yaw_deg"))
    t = table[0] * measure.WEEK_S + table[1] - truth.origin
    step = float(np.round(np.median(np.diff(t)), 3))
    tolerance = 0.5 * step
    without = [0.0, 0.0]
    for begin, end in spans:
        grid = np.arange(math.ceil(begin / step) * step, min(end, t[-1] + tolerance), step)
        for place, there in enumerate((t, t[np.isfinite(table[5])])):
            at = np.clip(np.searchsorted(there, grid - tolerance), 0, len(there) - 1)
            without[place] += step * np.count_nonzero(np.abs(there[at] - grid) > tolerance)
    return [value / len(spans) for value in without]


def events(folder, truth):
    """(seconds, event, code, value) of those with a time."""
    with open(folder / "events.csv", newline="") as file:
        return [(int(row["gps_week"]) * measure.WEEK_S + float(row["gps_tow_s"]) - truth.origin, row["event"], row["code"], float(row["value"]))
                for row in csv.DictReader(file) if row["gps_week"]]


def require_effect(folder, truth, commands):
    """Ends all if the events do not tell of a command: of a restart at its time, of a heading as soon as it served."""
    told = events(folder, truth)
    for command in commands:
        if command.kind == RESTART:
            found = any(event == "filter_reset" and code == COMMAND_CAUSE and abs(t - command.at) < 1.5 for t, event, code, _ in told)
        else:
            # At once, or, before there is an attitude, with the alignment.
            found = any(event == "aligned" and -1.5 < t - command.at < 30.0 and abs(value - command.sigma) < 1e-4
                        for t, event, _, value in told)
        if not found:
            sys.exit(f"{folder}/events.csv: nothing of the command of kind {command.kind} at {command.at:g} s")


def require_restarts(folder, least):
    text = (folder / "summary.txt").read_text()
    found = re.search(r"^restarts of the filter: (\d+)$", text, re.MULTILINE)
    if not found or int(found[1]) < least:
        sys.exit(f"{folder}/summary.txt: tells of {found[1] if found else 'no'} restarts, not of {least}")


# One drive.
@dataclasses.dataclass
class Result:
    """Of one drive, case, systems and estimator."""
    seed: int
    plain: Track  # without the event
    track: Track
    begins: tuple  # of the events
    silent: list  # s without a position, without an attitude after an event
    plain_silent: list
    found: list  # s after the event until a reset by the heading monitor
    failures: int  # windows that were given up in the JUDGED_S after
    begun: Track = None  # of a log that begins where the filter is restarted

    def spans(self, span):
        return [(begin + span[0], begin + span[1]) for begin in self.begins]

    def settled(self):
        return [(begin + SETTLED_S, end) for begin, end in zip(self.begins, (*self.begins[1:], DURATION_S))]

    def size(self, span):
        return rms(self.track.within(self.spans(span)).sizes())

    def settled_ratio(self):
        return rms(self.track.within(self.settled()).sizes()) / rms(self.plain.within(self.settled()).sizes())

    def begun_ratio(self):
        everything = [(begin, DURATION_S) for begin in self.begins[:1]]
        return rms(self.track.within(everything).sizes()) / rms(self.begun.within(everything).sizes())


def replay_rate(bin_folder, log, out, settings):
    """{estimator: folder} of answers at RATE_HZ, as a user gets them."""
    words = ["--preset", "urban", *with_settings(settings), "--rate", f"{RATE_HZ:g}", log, "--out"]
    run(bin_folder / "leonav-replay", *words, out / "filter-rate")
    run(bin_folder / "leonav-replay", *with_settings(["estimator=smoother"]), *words, out / "smoother-rate")
    return {name: out / f"{name}-rate/solution.csv" for name in ESTIMATORS[:2]}


def begun_tracks(bin_folder, log, out, settings, begins, truth):
    """{estimator: Track} of logs that begin at each of these times, up to the next one."""
    parts = {name: [] for name in ESTIMATORS[:2]}
    for begin, end in zip(begins, (*begins[1:], DURATION_S)):
        cut = out / "begun.lcmlog"
        write_begun(log, cut, begin, truth)
        for name, more in zip(ESTIMATORS[:2], ([], ["estimator=smoother"])):
            run(bin_folder / "leonav-replay", "--preset", "urban", *with_settings([*settings, *more]), cut, "--out", out / f"begun-{name}")
            parts[name].append(track_of(out / f"begun-{name}/solution.csv", truth).within([(begin, end)]))
        cut.unlink()
    return {name: joined(tracks) for name, tracks in parts.items()}


def estimates(bin_folder, log, at, settings):
    """{estimator: solution}, and that of the filter in the smoother's service."""
    return {**estimate(bin_folder, log, at, "urban", settings), BESIDE: at / "smoother/filter.csv"}


def drive(bin_folder, out, seed, family, results, command_t):
    scenario, scene = FAMILIES[family]
    folder = out / f"{family.replace(' ', '_')}-{seed}"
    simulate(bin_folder, folder, scenario, seed, DURATION_S, scene)
    truth, log, commanded = Truth(folder / "truth.csv"), folder / "run.lcmlog", folder / "commanded.lcmlog"
    plain = {}
    for systems, key in SYSTEMS.items():
        at = folder / f"plain-{systems}"
        plain[systems] = estimates(bin_folder, log, at, [*CAR, key]), replay_rate(bin_folder, log, at, [*CAR, key])
    for name, case in CASES.items():
        write_commanded(log, commanded, case.commands, truth, command_t)
        begins = (truth.departure,) if case.from_departure else tuple(command.at for command in case.commands)
        for systems, key in SYSTEMS.items():
            at = folder / f"{re.sub('[^a-z0-9]+', '_', name)}-{systems}"
            solutions = estimates(bin_folder, commanded, at, [*CAR, key])
            rated = replay_rate(bin_folder, commanded, at, [*CAR, key])
            for which in ESTIMATORS[:2]:
                require_effect(at / which, truth, case.commands)
            require_restarts(at / "whole", sum(command.kind == RESTART for command in case.commands))
            found = [t - begin for begin in begins for t, event, code, _ in events(at / "filter", truth)
                     if event == "filter_reset" and code == HEADING_CAUSE and t >= begin][:1]
            failures = sum(event == "smoother_failed" and any(0.0 <= t - begin < JUDGED_S[1] for begin in begins)
                           for t, event, _, _ in events(at / "smoother", truth))
            restarts = all(command.kind == RESTART for command in case.commands)
            begun = begun_tracks(bin_folder, log, at, [*CAR, key], begins, truth) if restarts else {}
            for which in ESTIMATORS:
                own, undisturbed = (track_of(of[which], truth) for of in (solutions, plain[systems][0]))
                result = Result(seed, undisturbed, own, begins, [], [], found, failures, begun.get(which))
                spans = result.spans(JUDGED_S)
                result.silent = silence(rated.get(which, solutions[which]), truth, spans)
                result.plain_silent = silence(plain[systems][1].get(which, plain[systems][0][which]), truth, spans)
                results.setdefault((name, systems, family, which), []).append(result)
    log.unlink()
    commanded.unlink()


# Tables.
def of_all(runs, spans_of, which="track"):
    return joined([getattr(one, which).within(spans_of(one)) for one in runs])


def errors_cell(track):
    headings = np.degrees(track.heading[np.isfinite(track.heading)])
    heading = f"{rms(headings):.2f}" if len(headings) else "-"
    return f"{rms(track.sizes()):.2f} ({np.max(track.sizes()):.2f}; {heading})" if len(track.t) else "-"


def share_cell(track):
    known = np.isfinite(track.heading_sigma) & np.isfinite(track.heading)
    position = 100.0 * np.mean(np.abs(track.error) <= 3.0 * track.sigma)
    heading = 100.0 * np.mean(np.abs(track.heading[known]) <= 3.0 * track.heading_sigma[known]) if known.any() else math.nan
    return f"{position:.1f} / {heading:.1f}"


def row_of(runs, which="track"):
    span = lambda seconds: lambda one: one.spans(seconds)
    errors = [errors_cell(of_all(runs, spans, which)) for spans in (span(BEFORE), span(FIRST), span(SECOND), Result.settled)]
    if which == "begun":
        errors[0] = ""
    silent = {"track": "silent", "plain": "plain_silent"}.get(which)
    times = np.mean([getattr(one, silent) for one in runs], axis=0) if silent else None
    return (*errors, f"{times[0]:.1f} / {times[1]:.1f}" if silent else "",
            *(share_cell(of_all(runs, spans, which)) for spans in (span(JUDGED_S), Result.settled)))


COLUMNS = ("before", "0 to 30 s after", "30 to 120 s after", "from 120 s on", "without position / attitude, s",
           "within 3 sigma up to 120 s, position / heading, %", "from 120 s on, %")


def print_errors(results):
    print(f"Cells: 3D RMSE and in brackets the largest 3D error, m, and the heading's RMSE, deg. Rows pool {len(FAMILIES)} scenes of {len(SEEDS)} "
          f"drives. Times without an answer are means of the {JUDGED_S[1]:g} s after an event.\n")
    rows = []
    for name in CASES:
        for systems in SYSTEMS:
            for which in ESTIMATORS:
                runs = [one for family in FAMILIES for one in results[name, systems, family, which]]
                rows.append((name, systems, which, *row_of(runs)))
                rows.append(("none, same times", systems, which, *row_of(runs, "plain")))
                if runs[0].begun:
                    rows.append(("log begins there", systems, which, *row_of(runs, "begun")))
    print_table(("event", "systems", "estimator", *COLUMNS), rows)
    print("By scene:\n")
    print_table(("event", "systems", "scene", "estimator", *COLUMNS), [(*key, *row_of(runs)) for key, runs in results.items()])


def print_found(results):
    """What the estimators noticed, and what they did not."""
    rows = []
    for name in CASES:
        for systems in SYSTEMS:
            runs = [one for family in FAMILIES for one in results[name, systems, family, "filter"]]
            times = [one.found[0] for one in runs if one.found]
            beyond = []
            for which in ESTIMATORS[:2]:
                own = [one for family in FAMILIES for one in results[name, systems, family, which]]
                counts, shares = zip(*(one.track.within([(one.begins[0], DURATION_S)]).beyond_level() for one in own))
                beyond.append(f"{sum(counts)} in {sum(count > 0 for count in counts)} drives ({max(shares):.2f})")
            rows.append((name, systems, f"{len(times)} of {len(runs)}", f"{np.median(times):.0f}, {max(times):.0f}" if times else "-",
                         f"{np.mean([one.failures for one in runs]):.1f}", *beyond))
    print("Where the heading monitor restarted the filter (`filter_reset`, code 6), windows that were given up (`smoother_failed`) in the "
          f"{JUDGED_S[1]:g} s after, and epochs to the end with an error beyond its protection level, in brackets the largest share of a level:\n")
    print_table(("event", "systems", "drives with a heading reset", "after s: median, last", "windows given up a drive", "beyond a level, filter", "smoother"), rows)


def judge(results):
    rows, verdicts = [], []
    for name in CASES:
        ratios, settled = {which: [] for which in ESTIMATORS}, {which: [] for which in ESTIMATORS}
        for systems in SYSTEMS:
            for family in FAMILIES:
                of_filter = results[name, systems, family, "filter"]
                for which in ESTIMATORS:
                    runs = results[name, systems, family, which]
                    ratios[which] += [[one.size(span) / other.size(span) for span in (FIRST, SECOND)] for one, other in zip(runs, of_filter)]
                    settled[which] += [one.settled_ratio() for one in runs]
        for which in ESTIMATORS:
            first, second = np.array(ratios[which]).T
            own = settled[which]
            begun = [one.begun_ratio() for systems in SYSTEMS for family in FAMILIES for one in results[name, systems, family, which] if one.begun]
            shown = lambda values: f"{geometric_mean(values):.3f} ({min(values):.2f} to {max(values):.2f})"
            rows.append((name, which, shown(first), shown(second), shown(own), shown(begun) if begun else ""))
            if name == "restart" and which == "smoother":
                verdicts.append((geometric_mean(first) <= 1.0, f"{name}, smoother: the first 30 s have {geometric_mean(first):.3f} times the "
                                 "filter's error; bound 1"))
            if begun:
                verdicts.append((geometric_mean(begun) <= BEGUN_FACTOR, f"{name}, {which}: {geometric_mean(begun):.3f} times the error of logs that "
                                 f"begin there; bound {BEGUN_FACTOR:g}"))
            if which != "whole log":
                verdicts.append((geometric_mean(own) <= SETTLED_FACTOR, f"{name}, {which}: from {SETTLED_S:g} s on {geometric_mean(own):.3f} times "
                                 f"the error without the event (the whole log {geometric_mean(settled['whole log']):.3f}); bound {SETTLED_FACTOR:g}"))
    print(f"Ratios of 3D RMSE, geometric means over {len(FAMILIES) * len(SEEDS) * len(SYSTEMS)} drives, in brackets single drives:\n")
    print_table(("event", "estimator", "0 to 30 s, over the filter's", "30 to 120 s, over the filter's", "from 120 s on, over that without the event",
                 "all after the first, over that of logs that begin there"), rows)
    return all([verdict(kept, text) for kept, text in verdicts])


def choose_cases(cases=""):
    """Leaves only the cases whose names begin with one of these words, with commas; empty: all."""
    wanted = tuple(word.strip() for word in cases.split(",") if word.strip())
    for word in wanted:
        if not any(name.startswith(word) for name in CASES):
            sys.exit(f"no case begins with '{word}'; there are: {', '.join(CASES)}")
    for name in list(CASES):
        if wanted and not name.startswith(wanted):
            del CASES[name]


def main():
    if not 3 <= len(sys.argv) <= 6:
        sys.exit(__doc__)
    bin_folder, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    choose(*sys.argv[3:5])
    choose_cases(*sys.argv[5:])
    command_t = command_type(out)
    results = {}
    for family in FAMILIES:
        for seed in SEEDS:
            drive(bin_folder, out, seed, family, results, command_t)
    print_errors(results)
    print_found(results)
    return 0 if judge(results) else 1


if __name__ == "__main__":
    sys.exit(main())
