"""When the machine itself stood still: a probe on each processor that has the highest priority of all and yet came late."""
import multiprocessing
import os
import time

PERIOD_S = 0.001
LEAST_NS = 200_000  # shorter ones are not kept
PRIORITY = 99


def probe(processor, path, end):
    """Writes its stalls to a file when it is told to end; none where the priority is not allowed."""
    os.sched_setaffinity(0, {processor})
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except PermissionError:
        return
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
    """Probes of all processors."""

    def __init__(self, path):
        self.path, self.processes, self.end = path, [], multiprocessing.Event()

    def start(self):
        self.processes = [(processor, multiprocessing.Process(target=probe, args=(processor, self.path_of(processor), self.end)))
                          for processor in sorted(os.sched_getaffinity(0))]
        for processor, process in self.processes:
            self.path_of(processor).unlink(missing_ok=True)
            process.start()

    def path_of(self, processor):
        return self.path.with_name(f"{self.path.name}.{processor}")

    def stop(self):
        """Ends the probes, and writes what they found; returns for each processor the (begin, end) of its stalls, ns of the wall clock,
        in order of time. None: their priority is not allowed here, so that nothing is known."""
        self.end.set()
        stalls = {}
        for processor, process in self.processes:
            process.join()
            if self.path_of(processor).exists():
                lines = self.path_of(processor).read_text().splitlines()
                stalls[processor] = [tuple(map(int, line.split(","))) for line in lines]
                self.path_of(processor).unlink()
        rows = sorted((begin, end, processor) for processor, spans in stalls.items() for begin, end in spans)
        with open(self.path, "w", encoding="ascii") as file:
            print("begin_unix_ns,end_unix_ns,processor", *(",".join(map(str, row)) for row in rows), sep="\n", file=file)
        return list(stalls.values()) if len(stalls) == len(self.processes) else None

    def kill(self):
        for _, process in self.processes:
            if process.is_alive():
                process.kill()
                process.join()


def stood_still_ns(stalls, begin, end, least=1):
    """How much of a time span so many processors, or more, stood still at once. `stalls`: of each processor."""
    steps = []
    for spans in stalls:
        for first, last in spans:
            first, last = max(first, begin), min(last, end)
            if first < last:
                steps += [(first, 1), (last, -1)]
    total, standing, since = 0, 0, begin
    for at, step in sorted(steps):
        if standing >= least:
            total += at - since
        standing, since = standing + step, at
    return total
