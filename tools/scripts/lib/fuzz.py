"""Runs the targets of leonav-fuzz and says how much of each was executed, and what was found.

  fuzz.py PROGRAM OUT [--seconds S | --runs N] [--jobs N] [TARGET...]

OUT/TARGET/corpus is the corpus that grows, OUT/TARGET/log what libFuzzer said, OUT/TARGET/*-HASH the inputs that were findings.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

SEEDS = pathlib.Path(__file__).resolve().parents[3] / "test/fuzz/corpus"
# An input that takes longer, or more memory, is a finding as well.
LIMITS = ["-timeout=20", "-rss_limit_mb=2048", "-max_len=16384"]
FINDINGS = ("crash-*", "timeout-*", "oom-*", "leak-*")
HEADER = "| target | executions | executions/s | coverage (edges) | inputs in the corpus | findings |\n|---|---|---|---|---|---|"


def last_number(pattern, text):
    found = re.findall(pattern, text, re.M)
    return int(found[-1]) if found else 0


def run(program, out, target, amount):
    folder = out / target
    corpus = folder / "corpus"
    corpus.mkdir(parents=True, exist_ok=True)
    command = [program, *LIMITS, amount, "-print_final_stats=1", f"-artifact_prefix={folder}/", corpus]
    if (SEEDS / target).is_dir():
        command.append(SEEDS / target)
    with open(folder / "log", "w", encoding="utf-8", errors="replace") as log:
        code = subprocess.run(command, env={**os.environ, "LEONAV_FUZZ_TARGET": target}, stdout=log, stderr=log, check=False).returncode
    text = (folder / "log").read_text(encoding="utf-8", errors="replace")
    findings = sorted(path for pattern in FINDINGS for path in folder.glob(pattern))
    row = [target, last_number(r"^stat::number_of_executed_units: (\d+)", text), last_number(r"^stat::average_exec_per_sec: +(\d+)", text),
           last_number(r"cov: (\d+)", text), sum(1 for _ in corpus.iterdir()), len(findings) or ("" if code == 0 else "see log")]
    return row, findings, code


def main():
    parser = argparse.ArgumentParser(prog="tools/validate fuzz", add_help=False)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    amount = parser.add_mutually_exclusive_group()
    amount.add_argument("--seconds", type=int, default=20)
    amount.add_argument("--runs", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("targets", nargs="*", metavar="TARGET")
    options = parser.parse_intermixed_args()
    environment = {key: value for key, value in os.environ.items() if key != "LEONAV_FUZZ_TARGET"}
    known = subprocess.run([options.program], env=environment, capture_output=True, text=True, check=True).stdout.split()
    unknown = [name for name in options.targets if name not in known]
    if unknown:
        sys.exit(f"fuzz: no target is called {', '.join(unknown)}; there are: {' '.join(known)}")

    amount = f"-runs={options.runs}" if options.runs is not None else f"-max_total_time={options.seconds}"
    failed, lines = False, []
    with open(options.out / "fuzz.md", "w", encoding="utf-8") as table, concurrent.futures.ThreadPoolExecutor(options.jobs) as workers:
        def tell(line):
            print(line, flush=True)
            print(line, file=table, flush=True)
        tell(HEADER)
        for row, findings, code in workers.map(lambda target: run(options.program, options.out, target, amount), options.targets or known):
            tell("| " + " | ".join(str(field) for field in row) + " |")
            failed = failed or code != 0 or bool(findings)
            lines += [f"{row[0]}: {path}" for path in findings] or ([f"{row[0]}: {options.out / row[0] / 'log'}"] if code else [])
    if lines:
        print("\nFindings; LEONAV_FUZZ_TARGET=TARGET leonav-fuzz FILE repeats one:", *lines, sep="\n", file=sys.stderr)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
