#!/usr/bin/python3
"""service_faults_judge_test.py: the judgement of tools/faults tells what is not as expected, and nothing where all is; what it
sends is what LCM receives."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / folder) for folder in ("tools/scripts/lib", "tools/python")]
try:
    import numpy as np
    from leonav.live import Assembler
    from service_faults import judge, stream
    from service_faults.datagrams import datagrams
    from service_faults.drive import IMU, stamp_ns
    from service_faults.recorded import Health, Outputs
    from service_faults.row import Expected, Row, fault
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
    made.time, made.events = made.t.copy(), []
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
    check("junk comes at its rate", 2200 < len(stream.junk(2, 3, 10)(drive)) < 2400)


health_is_judged()
solution_is_judged()
messages_arrive()
messages_change_within_their_span()
print("the judgement tells what it must")
