"""Faults of the messages that come in: stamps, gaps, values, junk."""
from service_faults import stream
from service_faults.drive import EPOCH, IMU, IMU_INTERVAL_S, STANDING_S
from service_faults.row import ALIGNING_CHANGES, Row, fault

HOUR_S = 3600
FILTER_RESET, HEADING = 2, 6  # kind of event, its code
NO_IMU = "no usable IMU"
# A gap of the IMU costs the heading: half a minute until it is found again, and HEALTH keeps events for a minute.
ALIGNS_S, KEPT_S = 30, 60
APART_KEPT_S = 120  # after stamps of IMU and GNSS were last found to be apart
GNSS_ALONE_S = 7  # after the last sample the answer goes on from GNSS alone
BEFORE_S = 20  # what is usual is measured over so long before a fault
# Of HEALTH, where inputs are rejected or missing before or while it aligns: each set of causes is another text.
REJECTS_AND_ALIGNS = 12
AFTER_GAP = {"ok_s": ALIGNS_S + KEPT_S, "back_s": 3, "worst_m": 8, "health_changes": REJECTS_AND_ALIGNS}


def imu_gap(seconds, **keys):
    return Row(f"imu-gap-{seconds:g}s", f"IMU silent for {seconds:g} s", end_s=60 + seconds,
               change=lambda row, messages: stream.without(IMU, row.begin_s, row.end_s)(messages), **keys)


def begins_anew(run, outputs, result):
    """The heading monitor restarts the filter."""
    result.at_most("event `filter_reset` of the heading", run.note_event(outputs, FILTER_RESET, (HEADING,), "filter_reset"), 30)


def measure_journal(run):
    run.journal_bytes.append(sum(piece.stat().st_size for piece in run.daemon.journal.parent.iterdir()))


MOST_MISSING, MOST_JOURNAL_MB_S = 0.001, 1.0


def junk_costs_little(run, outputs, result):
    """SOLUTION that did not come while junk came, and what the junk took of the journal's disk."""
    row = run.row
    missing, steps = outputs.missing_stamps(row.begin_s, row.end_s, IMU_INTERVAL_S)
    before, first, last = run.journal_bytes
    usual, rate = ((b - a) / seconds / 1e6 for a, b, seconds in ((before, first, BEFORE_S), (first, last, row.end_s - row.begin_s)))
    result.at_most("SOLUTION missing", missing / steps, MOST_MISSING, "of all")
    result.at_most("journal", rate, MOST_JOURNAL_MB_S, "MB/s")
    run.notes.append(f"{missing} of {steps} SOLUTION missing; journal {rate:.2f} MB/s, {usual:.2f} before")


def gnss_ahead(row, messages):
    return stream.in_turn(stream.without(IMU, row.begin_s, row.end_s), stream.shifted(EPOCH, HOUR_S, row.begin_s, row.end_s))(messages)


ROWS = [
    Row("future-epochs", "five GNSS epochs an hour ahead, no IMU sample between them",
        change=lambda row, messages: stream.epochs_from_the_future(row.begin_s, HOUR_S, 5)(messages),
        expected=fault("DEGRADED", reason="a tenth or more of an input is rejected .*GNSS", ok_s=25), after_s=80),
    Row("imu-silent-gnss-ahead", "IMU silent for 10 s while GNSS is an hour ahead", end_s=70, change=gnss_ahead, after_s=100,
        expected=fault("DEGRADED", "FAULT", reason=NO_IMU, gap_s=13, **AFTER_GAP)),
    Row("imu-hour-ahead", "IMU stamps step by an hour and stay", end_s=120, after_s=0,
        change=lambda row, messages: stream.shifted(IMU, HOUR_S, row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", "FAULT", reason="(IMU|GNSS).*(time_backwards|too_far_ahead)", stays=True,
                       gap_s=13, worst_m=8, ok_s=None, back_s=None, health_changes=REJECTS_AND_ALIGNS)),
    Row("imu-hour-ahead-30s", "IMU stamps step by an hour, and back after 30 s", end_s=90, after_s=160,
        change=lambda row, messages: stream.shifted(IMU, HOUR_S, row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", "FAULT", reason="(IMU|GNSS).*(time_backwards|too_far_ahead)", gap_s=13, worst_m=10, back_s=15,
                       ok_s=APART_KEPT_S + 10, health_changes=REJECTS_AND_ALIGNS)),
    Row("imu-clock-behind", "IMU clock steps back by 6 s, and to the right time after 30 s", end_s=90, after_s=160,
        change=lambda row, messages: stream.shifted(IMU, -6, row.begin_s, row.end_s)(messages),
        expected=fault("FAULT", reason="the time of the inputs has stepped", gap_s=13, worst_m=10, back_s=15,
                       ok_s=APART_KEPT_S + 10, health_changes=REJECTS_AND_ALIGNS)),
    Row("imu-clock-steps", "IMU clock steps by 0.5 s, and back after 30 s", end_s=90, after_s=100,
        change=lambda row, messages: stream.shifted(IMU, 0.5, row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", reason="IMU|time stamps", told_s=10, gap_s=3, worst_m=10, ok_s=ALIGNS_S + KEPT_S,
                       health_changes=REJECTS_AND_ALIGNS)),
    imu_gap(0.1, after_s=40, expected=fault("DEGRADED", reason="gaps|lost", ok_s=15), quick=True),
    imu_gap(1, expected=fault("DEGRADED", reason="gaps|lost", gap_s=1.5, worst_m=4, ok_s=KEPT_S + 10, back_s=1)),
    imu_gap(10, after_s=100, expected=fault("DEGRADED", "FAULT", reason=NO_IMU + r" \(nothing comes", gap_s=GNSS_ALONE_S, **AFTER_GAP)),
    imu_gap(60, after_s=100, expected=fault("DEGRADED", reason=NO_IMU + r" \(nothing comes", gap_s=GNSS_ALONE_S, **AFTER_GAP)),
    Row("imu-zeros", "IMU sends zeros for 20 s", end_s=80, after_s=100,
        change=lambda row, messages: stream.imu_zeros(row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", "FAULT", reason=NO_IMU + ".*not_sane", gap_s=GNSS_ALONE_S, **AFTER_GAP)),
    Row("imu-repeats", "IMU sends the same message for 10 s", end_s=70, after_s=100,
        change=lambda row, messages: stream.imu_repeated(row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", "FAULT", reason=NO_IMU, gap_s=GNSS_ALONE_S, **AFTER_GAP)),
    Row("imu-frozen", "IMU sends the same values for 10 s, its stamps go on", end_s=70, after_s=100,
        change=lambda row, messages: stream.imu_frozen(row.begin_s, row.end_s)(messages),
        expected=fault("DEGRADED", "FAULT", reason=NO_IMU + ".*not_sane", gap_s=GNSS_ALONE_S, **AFTER_GAP)),
    Row("heading-off", "a heading that is taken for known to a degree is 150 degrees off", begin_s=STANDING_S, end_s=STANDING_S, after_s=130,
        heading_off_deg=150, settled_s=STANDING_S, judge=begins_anew,
        expected=fault("DEGRADED", reason="the heading contradicts the motion", worst_m=12, sigmas=6, ok_s=KEPT_S + 10,
                       health_changes=ALIGNING_CHANGES)),
    Row("junk", "junk at ten times the nominal rate on all input channels for 20 s", end_s=80, after_s=40,
        change=lambda row, messages: stream.junk(row.begin_s, row.end_s, 10)(messages), judge=junk_costs_little,
        actions=((60 - BEFORE_S, measure_journal), (60, measure_journal), (80, measure_journal)),
        expected=fault("DEGRADED", reason="a tenth or more of an input is rejected", ok_s=25, health_changes=8), quick=True),
]
