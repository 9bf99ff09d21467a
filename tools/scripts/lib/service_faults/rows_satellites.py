"""Faults of satellites, their orbits, and the antenna."""
from service_faults import stream
from service_faults.row import Expected, Row, fault

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


def one_satellite(run, outputs, result):
    strongest = stream.strongest(run.drive.messages(), 0, run.row.begin_s, run.row.end_s)
    result.must(strongest == NUMBER, f"not {SATELLITE} but G{strongest:02d} arrives best: set it in rows_satellites.py")
    # No condition: an outlier that is left out needs no event.
    run.note_event(outputs, SATELLITE_FAULT, range(4), "satellite_fault")


def whole_system(run, outputs, result):
    """The same error of all its ranges is that of a clock: the position does not suffer, and the event says so."""
    result.at_most("event `clock_step` of Galileo", run.note_event(outputs, CLOCK_STEP, (GALILEO_CLOCK,), "clock_step"), 30)


CONTRADICTS = "contradict|off by a metre|drift away"
ROWS = [
    Row("gnss-lost-60s", "no satellite for 60 s", end_s=120, after_s=100, scenario=all_measured(60, 120),
        expected=fault("DEGRADED", reason=NO_GNSS, worst_m=10, ok_s=90)),
    Row("gnss-lost-5min", "no satellite for 5 min", begin_s=120, end_s=420, after_s=100, scenario=all_measured(120, 420),
        expected=fault("DEGRADED", reason=NO_GNSS, worst_m=60, ok_s=90)),
    Row("leo-lost", "no LEO satellite for 60 s", end_s=120, after_s=40, scenario=script("outage", 60, 120, systems="[leo]"),
        expected=Expected()),
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
                        pull_time_s=1),
        expected=Expected(allowed=CONTRADICTS, ok_s=None)),
    Row("spoofed-system", "all ranges of Galileo spoofed by 0.5 m/s for 60 s", end_s=120, after_s=40,
        scenario=script("spoofing", 60, 120, systems="[galileo]", pull_m_s=0.5, pull_time_s=1), judge=whole_system,
        expected=Expected(allowed=CONTRADICTS, ok_s=None)),
    Row("lever-arm", "antenna 2 m behind the configured place", begin_s=0, end_s=240, after_s=0,
        options=("--set", "vehicle.lever_arm_b_m=[2, 0, -1.2]"),
        # The sigma does not cover it: an arm that is wrong from the start looks like a position until the vehicle has turned.
        expected=fault("DEGRADED", reason="innovations are twice as large|the antenna moves as if", told_s=200, stays=True, worst_m=4, sigmas=None,
                       ok_s=None, back_s=None)),
]
