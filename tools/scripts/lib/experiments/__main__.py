"""The papers' matrix on the EKF and the smoother: simulate, replay, judge, report. Called by tools/scripts/experiments."""
import argparse
import fnmatch
import os
import sys

# The median of five convergence times scatters by half of itself.
CONVERGENCE_FACTOR = 3


def fail(message, code=1):
    print(f"experiments: {message}", file=sys.stderr)
    sys.exit(code)


ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", "..", ".."))
sys.path.insert(1, os.path.join(ROOT, "tools", "fleet"))

try:
    import matrix
    import report
    import runner as running
    from fleet import engine
except ImportError as missing:
    fail(f"{missing}; install python3-numpy and python3-matplotlib")

QUICK_ROWS = ["code-gps-leo", "carrier-gps-ins", "carrier-gps-leo-ins", "sets-gps-leo-ins",
              "convergence-static-gps-leo320"]


def at_least(least):
    def number(text):
        value = int(text)
        if value < least:
            raise ValueError(text)
        return value
    number.__name__ = f"whole number of {least} or more"
    return number


def arguments():
    parser = argparse.ArgumentParser(prog="experiments", description="Runs the papers' experiments on the EKF and the smoother and writes "
                                     "OUT/report.md. A second call does only what is not there yet: runs whose commands, "
                                     "programs or files changed are done again.")
    parser.add_argument("out", nargs="?", default="experiments-output", help="output folder [experiments-output]")
    parser.add_argument("--bin", help="folder of leonav-sim, leonav-replay, leonav-smooth and leonav-eval; without it they are built first")
    parser.add_argument("--rows", action="append", metavar="PATTERN", help="only rows whose name matches, as in 'code-*'; may be "
                        "repeated (--list tells the names)")
    parser.add_argument("--seeds", type=at_least(1), default=5,
                        help=f"so many seeds of every row, {CONVERGENCE_FACTOR} times as many for convergence [5]")
    parser.add_argument("--first-seed", type=at_least(1), default=1, help="the first of them; the sets are always 1 to 4 [1]")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of every estimator, after the row's own; "
                        "may be repeated")
    parser.add_argument("--jobs", type=at_least(1), help="runs at a time [processors]")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="use the workers of this Dask scheduler instead; they must see the same files "
                        "under the same names")
    parser.add_argument("--epochs", type=at_least(1100), default=3600, help="of each drive but those of the motion rows, 1 s each; the first 1000 do not "
                        "count [3600]")
    parser.add_argument("--quick", action="store_true", help="a smoke run: few rows, two seeds, short")
    parser.add_argument("--keep", action="store_true", help="keep the logs and tables of every run (some 250 MB an hour)")
    parser.add_argument("--list", action="store_true", help="print the rows and leave")
    return parser.parse_args()


def chosen_rows(options):
    if options.quick:
        options.epochs, options.seeds = 1100, min(options.seeds, 2)
        rows = matrix.all_rows(options.epochs, 120, 150)
        patterns = options.rows or QUICK_ROWS
    else:
        rows = matrix.all_rows(options.epochs, 2000, 3600)
        patterns = options.rows or ["*"]
    for pattern in patterns:
        if not any(fnmatch.fnmatchcase(row.name, pattern) for row in rows):
            fail(f"--rows {pattern}: no row has such a name; --list tells the names", 2)
    chosen = [row for row in rows if any(fnmatch.fnmatchcase(row.name, p) for p in patterns)]
    for row in chosen:
        row.settings += options.set
    return chosen


def main():
    options = arguments()
    rows = chosen_rows(options)
    if options.list:
        for row in rows:
            print(f"{row.name:40} {report.title_of(row)}: {row.title}")
        return 0
    seeds = list(range(options.first_seed, options.first_seed + options.seeds))
    four = [1, 2, 3, 4] if not options.quick else seeds

    def seeds_of(row):
        if row.is_set():
            return four
        if row.by_time and not options.quick:
            return list(range(options.first_seed, options.first_seed + CONVERGENCE_FACTOR * options.seeds))
        return seeds

    out = os.path.abspath(options.out)
    try:
        os.makedirs(out, exist_ok=True)
        site = running.Site(ROOT, os.path.abspath(options.bin), out, options.keep)
        results, failures = running.run(site, rows, seeds_of, options.jobs, options.scheduler)
        path = report.write(out, rows, results, site, seeds_of)
    except (running.RunError, engine.EngineError) as error:
        fail(str(error))
    except KeyboardInterrupt:
        fail("stopped; the same call goes on from here", 130)
    except OSError as error:
        fail(f"{error.filename}: {error.strerror}")
    print(path)
    failed = [r for by_seed in results.values() for r in by_seed.values() if r is None or "failure" in r]
    if failed:
        for text in failures[:5]:
            print(f"experiments: {text}", file=sys.stderr)
        fail(f"{len(failed)} runs failed; {path} names them")
    return 0


if __name__ == "__main__":
    sys.exit(main())
