"""Makes one fault a row for a running leonavd, and says how it behaved.

  main.py BIN OUT [--jobs N] [--quick] [--list] [ROW...]

Each row runs at real speed in a network and mount namespace of its own, N (4) at a time. A table goes to standard output and to
OUT/faults.md, what was recorded to OUT/ROW. Exit code 1: an expectation does not hold; 77: no namespace can be made here.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import traceback

LIB = pathlib.Path(__file__).resolve().parents[1]
ROOT = LIB.parents[2]
sys.path[:0] = [str(LIB), str(ROOT / "tools/python"), str(ROOT / "test/tools")]
from live_program import namespace_command  # noqa: E402
try:
    import numpy  # noqa: F401
except ImportError:
    print("SKIPPED: the Debian package python3-numpy is missing")
    sys.exit(77)
from service_faults import judge, rows_host, rows_inputs, rows_satellites  # noqa: E402
from service_faults.drive import Drive  # noqa: E402
from service_faults.row import Row  # noqa: E402
from service_faults.run import Run, make_network  # noqa: E402

NONE = Row("none", "none", after_s=60)
ROWS = [NONE, *rows_inputs.ROWS, *rows_satellites.ROWS, *rows_host.ROWS]
HEADER = """| fault | HEALTH said | after, s | OK again after, s | its longest gap, s | its changes | longest gap of SOLUTION, s | worst error, m (1 sigma) | largest error / sigma | replay | as expected |
|---|---|---|---|---|---|---|---|---|---|---|"""
NO_NUMBERS = "- | " * (HEADER.splitlines()[0].count("|") - 3)


def run_row(row, bin_dir, out):
    """Inside the namespaces."""
    if row.has_route:
        make_network()
    else:
        subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    run = Run(row, bin_dir, out)
    run.clear()
    if row.check:
        result = judge.Judgement()
        row.check(run, result)
    else:
        run.whole()
        result = judge.judged(row, run)
    return {"numbers": result.numbers, "failures": result.failures, "notes": run.notes, "late_s": run.late_s}


def number(value, digits=1):
    if value is None:
        return "-"
    return f"{value:.{digits}f}" if math.isfinite(value) else "never"


def table_row(row, result):
    begin = f"| {row.text} | "
    if "skipped" in result:
        return begin + f"{NO_NUMBERS}skipped: {result['skipped']} |"
    n, notes = result["numbers"], "; ".join(result["notes"])
    verdict = ("yes" if not result["failures"] else "NO: " + "; ".join(result["failures"])).replace("|", "/")
    verdict += f" ({notes})" if notes else ""
    if not n:
        return begin + f"{NO_NUMBERS}{verdict} |"
    worst = f"{n['worst_m']:.2f} ({n['sigma_m']:.2f})" if math.isfinite(n["worst_m"]) else "-"
    return begin + (f"`{n['told'].replace('|', '/')}` | {number(n['told_s'])} | {number(n['ok_s'])} "
                    f"| {number(n['health_gap_s'])} | {n['health_changes']} | {number(n['gap_s'])} | {worst} | {number(n['sigmas'])} "
                    f"| {n['replay']} | {verdict} |")


def run_alone(row, words, namespace):
    """One row in a process of its own."""
    if row.skipped and (reason := row.skipped()):
        return {"skipped": reason, "failures": []}
    folder = words.out / row.name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "result.json").unlink(missing_ok=True)
    with open(folder / "run.txt", "w", encoding="utf-8") as text:
        subprocess.run([*namespace, "-m", sys.executable, "-B", __file__, words.bin, words.out, "--one", row.name],
                       stdout=text, stderr=text, check=False)
    try:
        return json.loads((folder / "result.json").read_text())
    except OSError:
        last = ((folder / "run.txt").read_text().strip().splitlines() or ["nothing"])[-1]
        return {"numbers": {}, "failures": [f"no result: {last}; see {row.name}/run.txt"], "notes": []}


def run_one(words):
    row = next(row for row in ROWS if row.name == words.one)
    try:
        result = run_row(row, words.bin, words.out)
    except Exception:
        traceback.print_exc()
        sys.exit(1)
    (words.out / row.name / "result.json").write_text(json.dumps(result, indent=1))


def simulate(rows, words):
    """Before the first row, so that no simulation takes the processor from a running one."""
    drives = {(row.duration_s, row.scenario) for row in rows if not row.check}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        for done in [pool.submit(Drive, words.bin, words.out / "drives", *drive) for drive in sorted(drives)]:
            done.result()


def print_list():
    for row in ROWS:
        print(f"{row.name:24}{'quick  ' if row.quick else '       '}{row.text}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("rows", nargs="*", metavar="ROW")
    parser.add_argument("--jobs", type=int, default=4)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    words = parser.parse_intermixed_args()
    if words.list:
        return print_list()
    if words.one:
        return run_one(words)
    unknown = [name for name in words.rows if name not in {row.name for row in ROWS}]
    if unknown:
        parser.error(f"no row is called {unknown[0]}; --list prints all")
    rows = [row for row in ROWS if row.name in words.rows] if words.rows else [row for row in ROWS if row.quick or not words.quick]
    namespace = namespace_command()
    words.out.mkdir(parents=True, exist_ok=True)
    simulate(rows, words)
    order = sorted(rows, key=lambda row: -row.duration_s)  # the longest begin first
    with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
        running = {row.name: pool.submit(run_alone, row, words, namespace) for row in order}
        lines, failed, skipped = [HEADER], 0, 0
        print(HEADER, flush=True)
        for row in rows:
            result = running[row.name].result()
            if result["failures"] and result.get("late_s", 0) >= judge.LATE_S:
                concurrent.futures.wait(running.values())
                result = run_alone(row, words, namespace)  # the machine was too slow: once more, with nothing beside it
            if "skipped" in result:
                print(f"SKIPPED (optional): {row.name}: {result['skipped']}")
            skipped += "skipped" in result
            failed += bool(result.get("failures"))
            lines.append(table_row(row, result).replace(f"{words.out}/", ""))
            print(lines[-1], flush=True)
    (words.out / "faults.md").write_text("\n".join(lines) + "\n")
    print(f"\n{len(rows) - failed - skipped} of {len(rows)} rows as expected, {skipped} skipped; {words.out / 'faults.md'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
