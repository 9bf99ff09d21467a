"""Runs the targets of leonav-fuzz and says how much of each was executed, and what was found.

  fuzz.py PROGRAM OUT [--seconds S | --minutes M] [--runs N] [--jobs N] [TARGET...]

OUT/TARGET/corpus is the corpus that grows, OUT/TARGET/log what libFuzzer said last, OUT/TARGET/executions the number of executions of
all runs and the seconds of a processor that they took, OUT/TARGET/*-HASH the inputs that were findings. Ctrl-C and SIGTERM end the run
with exit code 130; what was executed until then counts.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

SEEDS = pathlib.Path(__file__).resolve().parents[3] / "test/fuzz/corpus"
# An input that takes longer, or more memory, is a finding as well.
LIMITS = ["-timeout=20", "-rss_limit_mb=2048"]
SHORTEST = 1024  # bytes: an input may be as long as the longest seed, and at least so long
# No other process adds to the corpus; new functions are not looked up by name; fast inputs are changed more often than slow ones.
HABITS = ["-reload=0", "-print_funcs=0", "-entropic_scale_per_exec_time=1", "-print_final_stats=1"]
# Freed memory is kept back for little longer than an input runs, so that it fits a processor's cache, and stays mapped; where it was
# taken is told when a finding is repeated without these.
SANITIZER = "quarantine_size_mb=0:thread_local_quarantine_size_kb=256:allocator_release_to_os_interval_ms=-1:malloc_context_size=1"
FIRST_S = 5  # how long a target runs to find its rate
RUNS = 10_000_000
FINDINGS = ("crash-*", "timeout-*", "oom-*", "leak-*")
INTERRUPTED = 72  # libFuzzer's exit code after a signal that asks it to end
HEADER = ("| target | executions | executions/s | coverage (edges) | inputs in the corpus | findings | the rest takes |\n"
          "|---|---|---|---|---|---|---|")


def last_number(pattern, text):
    found = re.findall(pattern, text, re.M)
    return int(found[-1]) if found else 0


def duration(seconds):
    for unit, length in (("d", 86400), ("h", 3600), ("min", 60)):
        if seconds >= length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.0f} s" if seconds > 0 else ""


class Target:
    running = set()
    is_ending = False

    @staticmethod
    def end_all(*_):
        Target.is_ending = True
        for process in list(Target.running):
            Target.end(process)

    @staticmethod
    def end(process):
        try:
            os.kill(process.pid, signal.SIGTERM)  # Popen.terminate() would take its exit code from os.wait4()
        except ProcessLookupError:
            pass

    def __init__(self, program, out, name, runs):
        self.program, self.name, self.folder, self.runs = program, name, out / name, runs
        self.corpus, self.seeds, self.log = self.folder / "corpus", SEEDS / name, self.folder / "log"
        self.counts, self.code = self.folder / "executions", 0
        self.corpus.mkdir(parents=True, exist_ok=True)

    def executed(self):
        """Executions of all runs, and the seconds of a processor that they took, which do not depend on what else runs."""
        count, seconds = self.counts.read_text().split() if self.counts.exists() else (0, 0)
        return int(count), float(seconds)

    def missing_s(self):
        """How long the executions that are missing take one processor at the rate so far; None: no rate is known."""
        count, seconds = self.executed()
        return max(self.runs - count, 0) * seconds / count if count > 0 else None

    def findings(self):
        return sorted(path for pattern in FINDINGS for path in self.folder.glob(pattern))

    def max_length(self):
        lengths = [path.stat().st_size for path in self.seeds.iterdir()] if self.seeds.is_dir() else [0]
        return max([*lengths, SHORTEST])

    def run(self, seconds=None, is_counted=True):
        """Runs until all executions are done (`is_counted`), or for so many seconds."""
        missing = self.runs - self.executed()[0]
        if Target.is_ending or self.code != 0 or (is_counted and missing <= 0):
            return
        command = [self.program, *LIMITS, *HABITS, f"-max_len={self.max_length()}", f"-artifact_prefix={self.folder}/", self.corpus]
        if is_counted:
            command.insert(1, f"-runs={missing}")
        if seconds is not None:
            command.insert(1, f"-max_total_time={max(int(seconds), 1)}")
        if self.seeds.is_dir():
            command.append(self.seeds)
        options = ":".join(filter(None, [SANITIZER, os.environ.get("ASAN_OPTIONS")]))
        environment = {**os.environ, "LEONAV_FUZZ_TARGET": self.name, "ASAN_OPTIONS": options}
        with open(self.log, "w", encoding="utf-8", errors="replace") as log:
            process = subprocess.Popen(command, env=environment, stdout=log, stderr=log, start_new_session=True)
            Target.running.add(process)
            if Target.is_ending:
                Target.end(process)
            _, status, usage = os.wait4(process.pid, 0)
        Target.running.discard(process)
        self.code = process.returncode = os.waitstatus_to_exitcode(status)
        if Target.is_ending and self.code == INTERRUPTED:
            self.code = 0
        count, seconds = self.executed()
        count += last_number(r"^stat::number_of_executed_units: (\d+)", self.text())
        self.counts.write_text(f"{count} {seconds + usage.ru_utime + usage.ru_stime:.1f}\n")

    def text(self):
        return self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""

    def row(self):
        count, seconds = self.executed()
        rate = round(count / seconds) if seconds > 0 else 0
        return [self.name, count, rate, last_number(r"cov: (\d+)", self.text()), sum(1 for _ in self.corpus.iterdir()),
                len(self.findings()) or ("" if self.code == 0 else "see log"), duration(self.missing_s() or 0)]


def run_until(end, targets):
    """Runs targets one after the other until `end`: each until it is done, but for no longer than an equal share of what is left."""
    for target in targets:
        if target.missing_s() is None:
            target.run(FIRST_S)
    targets = sorted(targets, key=lambda target: target.missing_s() or 0)
    for i, target in enumerate(targets):
        share = (end - time.monotonic()) / (len(targets) - i)
        if share >= 1:
            target.run(share)
    return targets


def main():
    parser = argparse.ArgumentParser(prog="tools/validate fuzz", add_help=False)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    amount = parser.add_mutually_exclusive_group()
    amount.add_argument("--seconds", type=int)
    amount.add_argument("--minutes", type=float)
    parser.add_argument("--runs", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    options = parser.parse_intermixed_args()
    environment = {key: value for key, value in os.environ.items() if key != "LEONAV_FUZZ_TARGET"}
    known = subprocess.run([options.program], env=environment, capture_output=True, text=True, check=True).stdout.split()
    unknown = [name for name in options.targets if name not in known]
    if unknown:
        sys.exit(f"fuzz: no target is called {', '.join(unknown)}; there are: {' '.join(known)}")

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, Target.end_all)
    targets = [Target(options.program, options.out, name, options.runs or RUNS) for name in options.targets or known]
    with open(options.out / "fuzz.md", "w", encoding="utf-8") as table, concurrent.futures.ThreadPoolExecutor(options.jobs) as workers:
        def tell(line):
            print(line, flush=True)
            print(line, file=table, flush=True)

        def tell_row(target):
            tell("| " + " | ".join(str(field) for field in target.row()) + " |")
        tell(HEADER)
        if options.minutes is not None:
            end = time.monotonic() + 60 * options.minutes
            list(workers.map(lambda job: run_until(end, targets[job::options.jobs]), range(options.jobs)))
            for target in targets:
                tell_row(target)
        else:
            seconds = options.seconds or (20 if options.runs is None else None)

            def run(target):
                target.run(seconds, is_counted=options.runs is not None)
                return target
            for target in workers.map(run, targets):
                tell_row(target)
    failed = [target for target in targets if target.code != 0 or target.findings()]
    if failed:
        print("\nFindings; LEONAV_FUZZ_TARGET=TARGET leonav-fuzz FILE repeats one:", file=sys.stderr)
        for target in failed:
            for path in target.findings() or [target.log]:
                print(f"{target.name}: {path}", file=sys.stderr)
    sys.exit(1 if failed else 130 if Target.is_ending else 0)


if __name__ == "__main__":
    main()
