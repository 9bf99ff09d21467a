"""Runs leonavd on a simulated drive at real speed while stress-ng keeps every processor busy.

  load.py BIN OUT [--minutes M] [--rows ROW...]

Once with the real-time priorities of the preset and locked memory, once with ordinary scheduling, and once with real-time priorities and
nothing beside. Prints how long after its IMU message each SOLUTION came (each one is in OUT/*/delays.csv), which are missing or out of
order, the memory, and the heap allocations of all threads. The sender's and the recorder's own delays do not count where they may have
real-time priority: both get a higher one than leonavd. What is left of a large delay is told apart by probes, one on each processor
with the highest priority of all (OUT/*/stalls.csv): while such a probe does not run, the machine itself stands still. Exit code 1: a
bound of a run with real-time priorities does not hold.
"""
import argparse
import multiprocessing
import os
import pathlib
import subprocess
import sys
import time

LIB = pathlib.Path(__file__).resolve().parents[1]
ROOT = LIB.parents[2]
sys.path[:0] = [str(LIB), str(ROOT / "tools/python"), str(ROOT / "test/tools")]
from live_program import enter_namespace  # noqa: E402
import numpy as np  # noqa: E402

import leonav  # noqa: E402
import lcm_log  # noqa: E402
from leonav.lcm_types import TYPES  # noqa: E402
from service_faults.allocations import Allocations  # noqa: E402
from service_faults.daemon import Daemon, Recorder  # noqa: E402
from service_faults.datagrams import Sender  # noqa: E402
from service_faults.drive import IMU, PREFIX, STANDING_S, Drive, stamp_ns  # noqa: E402
from service_faults.process_status import status_kb  # noqa: E402
from service_faults.stalls import StallProbes, stood_still_ns  # noqa: E402

OUR_PRIORITY = 80
WARM_UP_S = STANDING_S + 50  # the window is full, and every buffer has been used
REAL_TIME = ["--set", "realtime.lock_memory=true"]
ORDINARY = [word for thread in ("io", "ins", "gnss", "smoother", "out") for word in ("--set", f"realtime.{thread}.priority=0")]
# Of the runs with real-time priorities.
MOST_99_MS, MOST_999_MS = 1.0, 5.0
MOST_GROWTH_KB = 1024  # of memory that the system does not lock: its pages come as they are touched
LARGEST = 20  # delays that are looked at one by one
ROWS = {"real-time": ("real-time priorities, memory locked", REAL_TIME, True),
        "ordinary": ("ordinary", ORDINARY, True),
        "alone": ("real-time priorities, memory locked, nothing beside", REAL_TIME, False)}


def first_in_line(process_id=0):
    """The scheduler takes this process before leonavd; False where that is not allowed."""
    try:
        os.sched_setscheduler(process_id, os.SCHED_FIFO, os.sched_param(OUR_PRIORITY))
    except PermissionError:
        return False
    return True


def watch(process_id, path):
    """A line a second: resident and locked memory in kB, open files."""
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    with open(path, "w", encoding="ascii") as file:
        while True:
            try:
                files = len(os.listdir(f"/proc/{process_id}/fd"))
                print(time.time(), status_kb(process_id, "VmRSS"), status_kb(process_id, "VmLck"), files, file=file, flush=True)
            except OSError:
                return
            time.sleep(1.0)


def play(messages):
    """Sends each message when it is due; returns (stamp, ns of the wall clock just before it was sent) of each IMU sample."""
    sender, sent = Sender(), []
    begin = time.monotonic() + 0.05
    for t, channel, data in messages:
        wait = begin + t - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        if channel == IMU:
            sent.append((stamp_ns(data), time.time_ns()))
        sender.send(channel, data)
    return np.array(sent, dtype=np.int64)


def outputs(log):
    """(stamps, arrivals in ns) of SOLUTION, and the last HEALTH."""
    stamps, arrivals, health = [], [], None
    for wall, channel, data in lcm_log.messages(log):
        if channel == PREFIX + "SOLUTION":
            stamps.append(stamp_ns(data))
            arrivals.append(round(wall * 1e9))
        elif channel == PREFIX + "HEALTH":
            health = data
    return np.array(stamps, dtype=np.int64), np.array(arrivals, dtype=np.int64), leonav.decode(health)[1] if health else None


def run(words, name):
    _, options, is_loaded = ROWS[name]
    folder = words.out / name
    folder.mkdir(parents=True, exist_ok=True)
    for old in [*folder.glob("journal/*"), *folder.glob("leonavd*.txt")]:
        old.unlink()
    drive = Drive(words.bin, words.out / "drives", WARM_UP_S + round(60 * words.minutes))
    allocations = Allocations(words.bin, folder / "allocations")
    daemon = Daemon(words.bin, folder, options, heading_deg=drive.heading_deg(), environment=allocations.environment())
    messages = drive.messages()
    load = subprocess.Popen(["stress-ng", "--quiet", "--cpu", "0", "--vm", "1", "--vm-bytes", "256M"]) if is_loaded else None
    probes = StallProbes(folder / "stalls.csv")
    try:
        daemon.start()
        watcher = multiprocessing.Process(target=watch, args=(daemon.process.pid, folder / "memory.txt"))
        watcher.start()
        recorder = Recorder(folder)
        privileged = first_in_line() and all(first_in_line(int(thread))
                                             for thread in os.listdir(f"/proc/{recorder.process.pid}/task"))
        probes.start()
        begin = time.time()
        allocations.count_from(begin + WARM_UP_S)
        sent = play(messages)
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
        time.sleep(0.5)
        allocated = allocations.counted()
        stalls = probes.stop()
        _, code = daemon.stop()
        recorder.stop()
        watcher.join()
    finally:
        if load:
            load.terminate()
            load.wait()
        probes.kill()
        daemon.kill()
    return {**judged(folder, recorder.log, sent, begin, stalls), "code": code, "privileged": privileged, "allocated": allocated}


def judged(folder, log, sent, begin, stalls):
    stamps, arrivals, health = outputs(log)
    counted = sent[sent[:, 1] >= (begin + WARM_UP_S) * 1e9]
    sent_at = dict(counted)
    answered = [(stamp, arrival - sent_at[stamp]) for stamp, arrival in zip(stamps.tolist(), arrivals.tolist()) if stamp in sent_at]
    delays = np.array([delay for _, delay in answered]) * 1e-6
    largest = sorted(answered, key=lambda one: -one[1])[:LARGEST]
    np.savetxt(folder / "delays.csv", np.array([(stamp * 1e-9, delay * 1e-6) for stamp, delay in answered]).reshape(-1, 2),
               fmt=["%.3f", "%.4f"], delimiter=",", header="gps_s,delay_ms", comments="")
    memory = np.loadtxt(folder / "memory.txt", ndmin=2)
    memory = memory[(memory[:, 0] >= begin + WARM_UP_S) & (memory[:, 1] > 0)]
    return {"samples": len(counted), "missing": int(len(np.setdiff1d(counted[:, 0], stamps))),
            "out_of_order": int(np.count_nonzero(np.diff(stamps) <= 0)), "delays_ms": delays,
            "still": still_while(stalls, [(sent_at[stamp], sent_at[stamp] + delay) for stamp, delay in largest]),
            "resident_kb": memory[:, 1], "locked_kb": memory[-1, 2], "files": memory[:, 3],
            "misses": (int(health["ekf_misses"]), int(health["smoother_misses"])) if health else None}


def still_while(stalls, spans):
    """Of how many time spans more than half some processor stood still, and all of them at once; None where nobody knows."""
    if stalls is None:
        return None
    return [(sum(stood_still_ns(stalls, begin, end, least) > (end - begin) / 2 for begin, end in spans), len(spans))
            for least in (1, len(stalls))]


def still_text(still):
    return " | ".join(f"{count} of {of}" for count, of in still) if still else "- | -"


def row(name, r):
    q = np.quantile(r["delays_ms"], [0.5, 0.99, 0.999, 1.0]) if len(r["delays_ms"]) else [np.nan] * 4
    ekf, smoother = r["misses"] or ("-", "-")
    return (f"| {name} | {r['samples']} | {r['missing']} | {r['out_of_order']} | " + " | ".join(f"{v:.2f}" for v in q) +
            f" | {ekf} / {smoother} | {r['resident_kb'][0] / 1024:.2f} | {r['resident_kb'].max() - r['resident_kb'].min():.0f} "
            f"| {r['locked_kb'] / 1024:.1f} | {still_text(r['still'])} | {r['allocated'].text()} |")


def failures(r):
    if not len(r["delays_ms"]):
        return ["no solution came"]
    q99, q999 = np.quantile(r["delays_ms"], [0.99, 0.999])
    grown_kb = r["resident_kb"].max() - r["resident_kb"].min()
    bounds = {f"{r['missing']} solutions are missing": r["missing"] > 0, f"{r['out_of_order']} are out of order": r["out_of_order"] > 0,
              f"99 % of delays are below {q99:.2f} ms only": r["privileged"] and q99 > MOST_99_MS,
              f"99.9 % of delays are below {q999:.2f} ms only": r["privileged"] and q999 > MOST_999_MS,
              f"heap allocations: {r['allocated'].text()}": not r["allocated"].is_none(),
              f"resident memory changes by {grown_kb:.0f} kB": grown_kb > (0 if r["locked_kb"] else MOST_GROWTH_KB),
              f"exit code {r['code']}": r["code"] != 0}
    return [text for text, broken in bounds.items() if broken]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--rows", nargs="+", choices=list(ROWS), default=list(ROWS))
    words = parser.parse_args()
    enter_namespace()
    words.out.mkdir(parents=True, exist_ok=True)
    print("| scheduling | IMU samples | without SOLUTION | out of order | delay, ms: median | 99 % | 99.9 % | largest "
          "| misses of filter / smoother | resident, MB | its change, kB | locked, MB | largest delays while some processor stood still "
          "| while all did | heap allocations |\n" + "|---" * 15 + "|", flush=True)
    broken, privileged = [], True
    for name in words.rows:
        result = run(words, name)
        print(row(ROWS[name][0], result), flush=True)
        privileged = privileged and result["privileged"]
        if name != "ordinary":
            broken += [f"{name}: {text}" for text in failures(result)]
    if not privileged:
        print("\nReal-time priorities are not allowed here: the delays are also those of the sender and of the recorder, and have no bound.")
    for text in broken:
        print(f"bound: {text}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
