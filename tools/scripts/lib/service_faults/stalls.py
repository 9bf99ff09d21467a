"""When the machine itself stood still: a probe on each processor that has the highest priority of all and yet came late."""
import multiprocessing
import os
import time

PERIOD_S = 0.001
LEAST_NS = 200_000  # shorter ones are not kept
PRIORITY = 99


def probe(processor, path, end):
    os.sched_setaffinity(0, {processor})
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    stalls = []
    while not end.is_set():
        due = time.monotonic_ns() + round(PERIOD_S * 1e9)
        time.sleep(PERIOD_S)
        late = time.monotonic_ns() - due
        if late > LEAST_NS:
            now = time.time_ns()
            stalls.append((now - late, now))
    with open(path, "w", encoding="ascii") as file:
        for begin, finish in stalls:
            print(begin, finish, sep=",", file=file)


class StallProbes:
    """Probes of all processors; where their priority is not allowed they find nothing."""

    def __init__(self, path):
        self.path, self.processes, self.end = path, [], multiprocessing.Event()

    def start(self):
        self.processes = [(multiprocessing.Process(target=probe, args=(processor, f"{self.path}.{processor}", self.end)),
                           f"{self.path}.{processor}") for processor in sorted(os.sched_getaffinity(0))]
        for process, path in self.processes:
            open(path, "w", encoding="ascii").close()
            process.start()

    def stop(self):
        """Ends the probes; returns (begin, end) of all stalls, ns of the wall clock, in order of time, and writes them."""
        self.end.set()
        stalls = []
        for process, path in self.processes:
            process.join()
            with open(path, encoding="ascii") as file:
                stalls += [tuple(map(int, line.split(","))) for line in file]
            os.unlink(path)
        stalls.sort()
        with open(self.path, "w", encoding="ascii") as file:
            print("begin_unix_ns,end_unix_ns", *(f"{begin},{end}" for begin, end in stalls), sep="\n", file=file)
        return stalls

    def kill(self):
        for process, _ in self.processes:
            if process.is_alive():
                process.kill()
                process.join()


def overlap_ns(stalls, begin, end):
    """How much of a time span one processor or several stood still; the union of their stalls."""
    total, covered = 0, begin
    for first, last in stalls:
        first, last = max(first, covered), min(last, end)
        if last > first:
            total += last - first
            covered = last
    return total
