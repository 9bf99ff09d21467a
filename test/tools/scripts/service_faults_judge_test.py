#!/usr/bin/python3
"""service_faults_judge_test.py: the judgement of tools/faults tells what is not as expected, and nothing where all is; what it
sends is what LCM receives. So do the bounds of tools/validate service-load."""
import os
import pathlib
import sys
import tempfile
import types

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / folder) for folder in ("tools/scripts/lib", "tools/python", "test/tools")]
try:
    import numpy as np
    from leonav.live import Assembler
    from service_faults import judge, load, rows_host, rows_satellites, stream
    from service_faults.allocations import Counted
    from service_faults.datagrams import begun, datagrams, gone_on
    from service_faults.drive import GPS, IMU, LEO, START_S, WEEK, stamp_ns
    from service_faults.recorded import Epoch, Health, IN_USE, Outputs
    from service_faults.row import Expected, Row, fault
    from service_faults.stalls import StallProbes, stood_still_ns
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

TOLD = "no usable IMU (nothing comes): look at its sender"


def check(what, holds):
    if not holds:
        sys.exit(f"FAILED: {what}")


def outputs(bad=(), gaps=(), error=0.5, sigma=0.4, ends=200):
    """A run of 200 s: HEALTH is not OK in the spans `bad` (begin, end, status, why), SOLUTION is missing in the spans `gaps`."""
    made = Outputs.__new__(Outputs)
    made.health = []
    for t in range(ends):
        now = next(((status, why) for begin, end, status, why in bad if begin <= t < end), ("OK", ""))
        made.health.append(Health(t, *now, "smoother"))
    t = np.arange(0, ends, 0.1)
    made.t = t[[not any(begin <= one < end for begin, end in gaps) for one in t]]
    made.time, made.events, made.epochs = made.t.copy(), [], []
    made.error, made.sigma = np.full(len(made.t), error), np.full(len(made.t), sigma)
    return made


def failures(row, made):
    result = judge.Judgement()
    judge.judge_health(row, made, result)
    judge.judge_solution(row, made, result, 200)
    return result.failures


def health_is_judged():
    row = Row("row", "text", begin_s=60, end_s=70, expected=fault("DEGRADED", reason="no usable IMU", gap_s=12, ok_s=20))
    check("all as expected", not failures(row, outputs([(62, 80, "DEGRADED", TOLD)], [(60, 71)])))
    for what, bad in {"not told": [], "told late": [(66, 80, "DEGRADED", TOLD)], "another reason": [(62, 80, "DEGRADED", "aligning")],
                      "another status": [(62, 80, "FAULT", TOLD)], "told for too long": [(62, 95, "DEGRADED", TOLD)],
                      "told for ever": [(62, 200, "DEGRADED", TOLD)],
                      "not OK before": [(20, 80, "DEGRADED", TOLD)],
                      "flaps": [(62, 80, "DEGRADED", TOLD), (100, 101, "DEGRADED", TOLD)]}.items():
        check(f"{what} is found", failures(row, outputs(bad, [(60, 71)])))
    quiet = Row("row", "text", begin_s=60, end_s=70, expected=Expected())
    check("OK is OK", not failures(quiet, outputs()))
    check("a reason where none is expected is found", failures(quiet, outputs([(62, 64, "DEGRADED", TOLD)])))
    check("the reason is shown without its remedy", judge.first_reason(TOLD) == "no usable IMU (nothing comes)")
    check("a disk that does not answer keeps its words", "does not answer" in judge.first_reason("journal: the disk does not answer: look at the disk"))


def solution_is_judged():
    row = Row("row", "text", begin_s=60, end_s=70, expected=Expected(gap_s=3, worst_m=2, sigmas=5, back_s=2))
    check("no fault", not failures(row, outputs(gaps=[(60, 62)])))
    check("a gap is found", failures(row, outputs(gaps=[(60, 64)])))
    check("an end is found", failures(row, outputs(gaps=[(71, 300)])))
    check("a late return is found", failures(row, outputs(gaps=[(69, 73)])))
    check("an error is found", failures(row, outputs(error=2.5, sigma=1)))
    check("a sigma that is too small is found", failures(row, outputs(error=1, sigma=0.1)))
    other_time = outputs()
    other_time.time[-10:] += 3600
    other_time.time[800:820] += 3600
    check("stamps of another time are found", failures(row, other_time))


def health_goes_on():
    def found(made, **keys):
        result = judge.Judgement()
        judge.judge_continuity(Row("row", "text", begin_s=60, end_s=70, expected=Expected(**keys)), made, result, 200)
        return result
    check("HEALTH each second goes on", not found(outputs([(62, 80, "DEGRADED", TOLD)])).failures)
    check("two changes are counted", found(outputs([(62, 80, "DEGRADED", TOLD)])).numbers["health_changes"] == 2)
    silent = outputs()
    silent.health = [one for one in silent.health if not 100 <= one.t < 104]
    check("four silent seconds are found", found(silent).failures)
    silent.health = silent.health[:150]
    check("an end of HEALTH is found", found(silent).failures)
    check("a text that changes each second is found",
          found(outputs([(t, t + 1, "DEGRADED", f"for {t} s") for t in range(62, 80)])).failures)
    flaps = [(t, t + 2, "DEGRADED", TOLD) for t in (60, 66, 72)]
    check("six changes within twenty seconds are found", found(outputs(flaps)).failures)
    check("where so many are expected they are none", not found(outputs(flaps), health_changes=6).failures)
    check("four are none", not found(outputs(flaps[:2])).failures)
    check("six within a minute are none", not found(outputs([(t, t + 2, "DEGRADED", TOLD) for t in (60, 90, 120)])).failures)


def missing_solutions_are_counted():
    check("none is missing", outputs().missing_stamps(60, 80, 0.1) == (0, 200))
    check("two seconds are missing", outputs(gaps=[(69.95, 71.95)]).missing_stamps(60, 80, 0.1) == (20, 200))
    twice = outputs(gaps=[(69.95, 71.95)])
    twice.time[:20] = twice.time[20:40]
    check("what comes twice is no replacement", twice.missing_stamps(60, 80, 0.1) == (20, 200))


def run_with(folder, reason):
    """A run whose replay says of a satellite's code what reason(t) is."""
    (folder / "replay").mkdir(exist_ok=True)
    lines = ["gps_week,gps_tow_s,satellite,observable,innovation,reason"]
    for t in range(1, 160):
        lines += [f"{WEEK},{START_S - WEEK * 604800 + t},{rows_satellites.SATELLITE},{observable},1.5,{why}"
                  for observable, why in (("doppler", "used"), ("code", reason(t)))]
    (folder / "replay" / "measurements.csv").write_text("\n".join(lines) + "\n")
    return types.SimpleNamespace(row=Row("row", "text", begin_s=60, end_s=120), folder=folder, notes=[])


def a_satellite_without_a_fault_is_found():
    def fails(reason):
        result = judge.Judgement()
        with tempfile.TemporaryDirectory() as folder:
            rows_satellites.code_is_left_out(run_with(pathlib.Path(folder), reason), result)
        return result.failures
    check("a code that is left out", not fails(lambda t: "outlier" if 60 <= t < 120 else "used"))
    check("a code that is down-weighted", not fails(lambda t: "downweighted" if 65 <= t < 120 else "used"))
    check("no fault is found", fails(lambda t: "used"))
    check("a fault of all the time is found", fails(lambda t: "outlier"))
    check("a short fault is found", fails(lambda t: "outlier" if 60 <= t < 90 else "used"))


def leo_that_stays_is_found():
    def fails(is_used):
        result, made = judge.Judgement(), outputs()
        made.epochs = [Epoch(t + 0.5, {(GPS, 1): IN_USE[0], (LEO, 100): IN_USE[0] if is_used(t) else 4}, 0.1) for t in range(160)]
        run = types.SimpleNamespace(row=Row("row", "text", begin_s=60, end_s=120), notes=[])
        rows_satellites.leo_is_gone(run, made, result)
        return result.failures
    check("LEO is gone", not fails(lambda t: not 60 <= t < 120))
    check("LEO that stays is found", fails(lambda t: True))
    check("LEO that never was is found", fails(lambda t: False))
    check("LEO that does not come back is found", fails(lambda t: t < 60))


def messages_arrive():
    for size in (10, 64990, 65001, 200000):
        data, assembler = bytes(range(256)) * (size // 256 + 1), Assembler()
        whole = [assembler.add(datagram, "me") for datagram in datagrams(7, IMU, data[:size])]
        check(f"{size} bytes arrive", whole[-1] == (IMU, data[:size]) and not any(whole[:-1]) and not assembler.dropped)


def messages_change_within_their_span():
    sample = stream.IMU_FORMAT.pack(b"12345678", 0, 1, 1, 5_000_000, *range(1, 7))
    drive = [(t / 10, IMU, sample) for t in range(100)]
    gone = stream.without(IMU, 2, 3)(drive)
    check("ten are left out", len(gone) == 90 and not any(2 <= t < 3 for t, _, _ in gone))
    late = stream.shifted(IMU, 3600, 2, 3)(drive)
    check("ten are an hour ahead", [t for t, _, data in late if stamp_ns(data)] == [t for t, _, _ in drive[20:30]])
    check("zeros are zeros", stream.IMU_FORMAT.unpack(stream.imu_zeros(2, 3)(drive)[25][2])[5:] == (0,) * 6)
    names = {name for _, name, _ in stream.new_names(2, 3, 500)(drive)}
    check("each name is another one", len(names) == 501)
    check("junk comes at its rate", 2200 < len(stream.junk(2, 3, 10)(drive)) < 2400)


def a_fault_that_does_not_leave_is_found():
    def fails(refused=0, late_s=0.0, **keys):
        result = judge.Judgement()
        judge.judge_sent(Row("row", "text", **keys), types.SimpleNamespace(sender=types.SimpleNamespace(refused=refused), late_s=late_s), result)
        return result.failures
    check("all was sent", not fails())
    check("a refused datagram is found", fails(refused=1))
    check("late messages are found", fails(late_s=0.4))
    check("a lost route refuses", not fails(refused=300, loses_route=True))
    check("a route that stays is found", fails(loses_route=True))


def a_fault_that_does_not_arrive_is_found():
    kinds = {"long": begun(7, IMU, rows_host.LONG_BYTES), "fragment": gone_on(7, rows_host.FRAGMENT_BYTES),
             "name": datagrams(7, list(stream.new_names(2, 3, 1)([]))[0][1], b"nothing")[0]}
    for kind, datagram in kinds.items():
        check(f"{kind} is known", rows_host.kind_of(datagram) == kind)
    check("a begin of a fragment is one", rows_host.kind_of(begun(7, "LEONAV_FRAGMENT_7", rows_host.FRAGMENT_BYTES)) == "fragment")
    check("a sample is none of them", rows_host.kind_of(datagrams(7, IMU, b"sample")[0]) is None)
    check("a long good message is none of them", rows_host.kind_of(datagrams(7, IMU, bytes(100_000))[0]) is None)

    def fails(**arrived):
        result = judge.Judgement()
        rows_host.arrives({"name": 1000, "fragment": 20}, types.SimpleNamespace(arrived=arrived, notes=[]), result)
        return result.failures
    check("all arrive", not fails(name=1000, fragment=20))
    check("a busy machine may lose some", not fails(name=600, fragment=11))
    check("nothing arrives", len(fails()) == 2)
    check("one kind does not arrive", len(fails(name=1000)) == 1)


def stalls_of_one_processor_are_no_stall_of_all():
    one, other = [(10, 20), (30, 40)], [(15, 35)]
    check("no stall", stood_still_ns([[], []], 0, 100) == 0)
    check("some processor stood still", stood_still_ns([one, other], 0, 100) == 30)
    check("both stood still", stood_still_ns([one, other], 0, 100, least=2) == 10)
    check("only within the span", stood_still_ns([one, other], 12, 18) == 6)
    check("only within the span of both", stood_still_ns([one, other], 12, 18, least=2) == 3)
    check("stalls that meet do not count twice", stood_still_ns([[(10, 20)], [(20, 30)]], 0, 100) == 20)
    check("stalls that meet are none of both", stood_still_ns([[(10, 20)], [(20, 30)]], 0, 100, least=2) == 0)
    still = load.still_while([one, other], [(10, 20), (15, 20), (50, 60)])
    check("two delays of one, one of both", load.still_text(still) == "2 of 3 | 1 of 3")
    check("without probes nothing is known", load.still_text(load.still_while(None, [(10, 20)])) == "- | -")
    check("no stall is known to be none", load.still_text(load.still_while([[], []], [(10, 20)])) == "0 of 1 | 0 of 1")


def probes_without_priority_know_nothing():
    def refuse(*_):
        raise PermissionError
    allowed, os.sched_setscheduler = os.sched_setscheduler, refuse
    try:
        with tempfile.TemporaryDirectory() as folder:
            probes = StallProbes(pathlib.Path(folder) / "stalls.csv")
            probes.start()
            check("probes without priority know nothing", probes.stop() is None)
    finally:
        os.sched_setscheduler = allowed


def allocations_are_counted():
    check("none", Counted({"gnss": 0}).is_none() and Counted({"gnss": 0}).text() == "0")
    some = Counted({"out": 0, "main": 5, "gnss": 2})
    check("some", not some.is_none() and some.text() == "gnss 2, main 5")


def bounds_under_load_hold_without_priorities():
    good = {"missing": 0, "out_of_order": 0, "delays_ms": np.full(100, 0.2), "privileged": True, "allocated": Counted({"gnss": 0}),
            "resident_kb": np.array([100.0, 100.0]), "locked_kb": 90, "code": 0}
    check("all bounds hold", not load.failures(good))
    slow = {**good, "delays_ms": np.full(100, 20.0)}
    check("delays are found", len(load.failures(slow)) == 2)
    check("delays of others have no bound", not load.failures({**slow, "privileged": False}))
    for what, value in {"missing": 1, "out_of_order": 1, "allocated": Counted({"gnss": 1}), "resident_kb": np.array([100.0, 104.0]),
                        "code": 1}.items():
        for privileged in (True, False):
            check(f"{what} is found", len(load.failures({**good, what: value, "privileged": privileged})) == 1)
    check("pages that are not locked come", not load.failures({**good, "resident_kb": np.array([100.0, 104.0]), "locked_kb": 0}))
    check("not that many", load.failures({**good, "resident_kb": np.array([100.0, 3000.0]), "locked_kb": 0}))


health_is_judged()
solution_is_judged()
health_goes_on()
missing_solutions_are_counted()
a_satellite_without_a_fault_is_found()
leo_that_stays_is_found()
messages_arrive()
messages_change_within_their_span()
a_fault_that_does_not_leave_is_found()
a_fault_that_does_not_arrive_is_found()
stalls_of_one_processor_are_no_stall_of_all()
probes_without_priority_know_nothing()
allocations_are_counted()
bounds_under_load_hold_without_priorities()
print("the judgement tells what it must")
