"""Faults of satellites, their orbits, and the antenna."""
import math
import statistics

from service_faults import judge, stream
from service_faults.drive import GPS, LEO
from service_faults.replayed import innovations_of
from service_faults.row import ALIGNING_CHANGES, Expected, Row, fault

MEDIUM = ("gps", "galileo", "beidou")
FREQUENT_NODES = tuple(f"satellites.{system}.node_interval_s=30" for system in MEDIUM)
NO_GNSS = "no usable GNSS|INS only"
# The GPS satellite that arrives best in these drives.
NUMBER = 20
SATELLITE = f"G{NUMBER:02d}"


def script(kind, begin, end, **keys):
    words = ", ".join(f"{key}: {value}" for key, value in {"kind": kind, "from_s": begin, "to_s": end, **keys}.items())
    return (f"faults=[{{{words}}}]",)


def all_measured(begin, end):
    return script("outage", begin, end)


CLOCK_STEP, SATELLITE_FAULT = 12, 23  # kinds of events
GALILEO_CLOCK = 17


BEFORE_S = 20
REACTS_S = 10  # of a range that is pulled away as many metres, five sigmas, until the code is an outlier


def one_satellite(run, outputs, result):
    strongest = stream.strongest(run.drive.messages(), GPS, run.row.begin_s, run.row.end_s)
    result.must(strongest == NUMBER, f"not {SATELLITE} but G{strongest:02d} arrives best: set it in rows_satellites.py")
    code_is_left_out(run, result)
    # No condition: an outlier that is left out needs no event.
    run.note_event(outputs, SATELLITE_FAULT, range(4), "satellite_fault")


def code_is_left_out(run, result):
    """Else the row would show nothing: the satellite's code is used before the fault, and is left out or down-weighted while it lasts.

    Its Dopplers stay in use, and its carriers with ambiguities of their own, so that the satellite as such counts as used.
    """
    row = run.row
    codes = list(innovations_of(run, SATELLITE, "code"))
    before = [one.reason == "used" for one in codes if row.begin_s - BEFORE_S <= one.t < row.begin_s]
    during = [one.reason in ("outlier", "downweighted") for one in codes if row.begin_s + REACTS_S <= one.t < row.end_s]
    result.must(len(before) >= BEFORE_S - 1 and share(before) >= 0.9, f"used in {share(before):.0%} of the epochs before")
    result.must(share(during) >= 0.9, f"left out or down-weighted in {share(during):.0%} of the epochs of the fault")
    most_m = max((abs(one.innovation_m) for one in codes if row.begin_s <= one.t < row.end_s), default=0.0)
    run.notes.append(f"{SATELLITE}'s code: used in {share(before):.0%} of the epochs before, left out or down-weighted in "
                     f"{share(during):.0%} of those from {REACTS_S} s of the fault on, up to {most_m:.0f} m off")


def share(found):
    return sum(found) / len(found) if found else 0.0


def every_second(run, outputs, result):
    """Else the row would show nothing: the codes of those satellites leave the others'."""
    row = run.row

    def apart_m(begin, end):
        codes = [one for number in range(1, 33) for one in innovations_of(run, f"G{number:02d}", "code") if begin <= one.t < end]
        even, odd = ([one.innovation_m for one in codes if int(one.satellite[1:]) % 2 == rest] for rest in (0, 1))
        return statistics.median(even) - statistics.median(odd)
    before, during = apart_m(row.begin_s - BEFORE_S, row.begin_s), apart_m(row.end_s - 10, row.end_s)
    run.notes.append(f"their codes are {before:.1f} m off the others' before, {during:.1f} m at the end of the fault")
    result.must(abs(before) < 1, f"codes are {before:.1f} m apart before")
    result.must(abs(during) > 3, f"codes are {during:.1f} m apart at the end of the fault")


def leo_is_gone(run, outputs, result):
    row = run.row
    before = outputs.epochs_within(row.begin_s - BEFORE_S, row.begin_s)
    least = min((epoch.in_use(LEO) for epoch in before), default=0)
    most = max((epoch.in_use(LEO) for epoch in outputs.epochs_within(row.begin_s + 2, row.end_s)), default=0)
    behind = next((epoch.t - row.end_s for epoch in outputs.epochs if epoch.t >= row.end_s and epoch.in_use(LEO)), math.inf)
    result.must(least >= 1, "no LEO satellite is in use before")
    result.must(most == 0, f"{most} LEO satellites are in use during the outage")
    result.at_most("LEO in use again", behind, 15)
    run.notes.append(f"LEO satellites in use: {least} or more before, {most} during, again {behind:.0f} s after")


def whole_system(run, outputs, result):
    """The same error of all its ranges is that of a clock: the position does not suffer, and the event says so."""
    result.at_most("event `clock_step` of Galileo", run.note_event(outputs, CLOCK_STEP, (GALILEO_CLOCK,), "clock_step"), 30)


def arm_is_told(run, outputs, result):
    """How HEALTH, error and sigma go on until the mistake has its name, and to the end."""
    ok_s = next((one.t for one in outputs.health if one.status == "OK"), math.inf)
    first = next((one for one in outputs.health if one.t > ok_s and one.status != "OK"), None)
    named_s = next((one.t for one in outputs.health if "the antenna moves as if" in one.why), None)
    result.must(first, "HEALTH is OK to the end")
    if not first:
        return
    known = [(t, error, sigma) for t, error, sigma in zip(outputs.t, outputs.error, outputs.sigma) if t >= first.t and math.isfinite(error)]
    _, error, sigma = known[0]
    errors, sigmas = [one[1] for one in known], [one[2] for one in known]
    run.notes.append(f"HEALTH is OK until {first.t:.0f} s, then `{judge.first_reason(first.why)}`: error {error:.1f} m, sigma {sigma:.1f} m; "
                     f"{f'it names the arm after {named_s:.0f} s' if named_s else 'it does not name the arm'}; from the first on errors "
                     f"{min(errors):.1f} to {max(errors):.1f} m, sigma down to {min(sigmas):.2f} m")


CONTRADICTS = "contradict|off by a metre|drift away"
ROWS = [
    Row("gnss-lost-60s", "no satellite for 60 s", end_s=120, after_s=100, scenario=all_measured(60, 120),
        expected=fault("DEGRADED", reason=NO_GNSS, worst_m=10, ok_s=90)),
    Row("gnss-lost-5min", "no satellite for 5 min", begin_s=120, end_s=420, after_s=100, scenario=all_measured(120, 420),
        expected=fault("DEGRADED", reason=NO_GNSS, worst_m=60, ok_s=90)),
    Row("leo-lost", "no LEO satellite for 60 s", end_s=120, after_s=40, scenario=script("outage", 60, 120, systems="[leo]"),
        judge=leo_is_gone, expected=Expected()),
    Row("no-ephemerides", "no ephemerides, orbits and models in the first 60 s", begin_s=0, after_s=100, knows_heading=False, settled_s=90,
        change=lambda row, messages: stream.products_late(row.end_s)(messages),
        expected=fault("FAULT", reason="most satellites have no ephemeris", told_s=20, stays=True, ok_s=90, worst_m=6,
                       health_changes=ALIGNING_CHANGES)),
    Row("orbits-stale", "no precise orbits and clocks for 2 min", end_s=180, after_s=60, scenario=FREQUENT_NODES,
        change=lambda row, messages: stream.orbits_stop(row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", reason="no precise orbit or correction", told_s=60, worst_m=4, ok_s=30)),
    # The nodes are off from 80 s on: orbits between two nodes feel those that follow.
    Row("orbits-off", "precise orbits of all systems 15 m off along for 40 s", end_s=120, after_s=100,
        scenario=(*FREQUENT_NODES, *script("bad_orbit", 80, 120, along_m=15)),
        expected=fault("DEGRADED", reason="precise orbits contradict", told_s=60, worst_m=4, ok_s=90)),
    Row("clock-jump", "one satellite's clock jumps by 100 m", end_s=120, after_s=40,
        scenario=script("satellite_clock", 60, 120, satellites=f"[{SATELLITE}]", jump_m=100), judge=one_satellite, expected=Expected()),
    Row("spoofed-satellite", "one satellite spoofed by 1 m/s for 60 s", end_s=120, after_s=40,
        scenario=script("spoofing", 60, 120, satellites=f"[{SATELLITE}]", pull_m_s=1, pull_time_s=1), judge=one_satellite,
        expected=Expected()),
    Row("ranges-ramped", "ranges of every second GPS satellite grow by 0.2 m/s for 60 s", end_s=120, after_s=60,
        scenario=script("spoofing", 60, 120, satellites=f"[{', '.join(f'G{number:02d}' for number in range(2, 33, 2))}]", pull_m_s=0.2,
                        pull_time_s=1), judge=every_second,
        expected=Expected(allowed=CONTRADICTS, ok_s=None)),
    Row("spoofed-system", "all ranges of Galileo spoofed by 0.5 m/s for 60 s", end_s=120, after_s=40,
        scenario=script("spoofing", 60, 120, systems="[galileo]", pull_m_s=0.5, pull_time_s=1), judge=whole_system,
        expected=Expected(allowed=CONTRADICTS, ok_s=None)),
    Row("lever-arm", "antenna 2 m behind the configured place", begin_s=0, end_s=240, after_s=0,
        options=("--set", "vehicle.lever_arm_b_m=[2, 0, -1.2]"),
        # The sigma does not cover it: an arm that is wrong from the start looks like a position until the vehicle has turned.
        expected=fault("DEGRADED", reason="innovations are twice as large|the antenna moves as if", told_s=120, stays=True, worst_m=4, sigmas=20,
                       health_changes=8, ok_s=None, back_s=None), judge=arm_is_told),
]
