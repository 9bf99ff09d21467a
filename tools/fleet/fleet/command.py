"""The command line of leonav-fleet."""
import argparse
import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

from . import engine, logs, matrix, matrix_report, programs, progress, replays, report, simulations

PROGRAM = "leonav-fleet"
ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
DESCRIPTION = """Replays many logs, several at a time, and judges each: OUT/report.md and OUT/report.json have a row a run (errors
north, east, up, stated sigmas against them, availability, misses, resets, warnings), totals, what failed, and how often
errors exceed their protection levels: of the configured risk and of larger ones, with the confidence of each number, and
Stanford diagrams OUT/stanford_horizontal.png and OUT/stanford_vertical.png (with python3-matplotlib).

A log's truth is NAME.truth.csv or truth.csv beside it; one without is replayed and not judged. With --matrix the logs
are simulated: every scene of the file with every seed, each replayed by every estimator and then deleted; a row of the
report is a scene and an estimator over the seeds, with the verdict against the file's limits.

The runs are spread over worker processes, one a core; a worker that is lost is replaced, and what it had in hand is
done again. Results do not depend on the number of workers."""
EPILOG = """exit codes: 0 all went well; 1 a run failed, or a row misses a limit of its matrix; 2 command line, or a file that it
names; 130 stopped with Ctrl-C

  leonav-fleet --preset car logs/                        every log below logs/, by the preset car
  leonav-fleet --preset car --resume logs/               goes on after a stop: what is done and unchanged is taken as it is
  leonav-fleet --config vehicle.yaml --set ekf.carrier=true a.lcmlog b.lcmlog --out carrier
  leonav-fleet --matrix config/matrix/streets.yaml --seeds 20 --rows 'correlated/*'
"""


class CommandError(Exception):
    """The command line, or a file that it names, is wrong."""


def at_least(least, kind=int):
    def number(text):
        value = kind(text)
        if not value >= least:
            raise ValueError(text)
        return value
    number.__name__ = f"{'whole ' if kind is int else ''}number of {least} or more"
    return number


def parser_of_words():
    parser = argparse.ArgumentParser(prog=PROGRAM, description=DESCRIPTION, epilog=EPILOG, usage="%(prog)s [options] LOG_OR_FOLDER...\n"
                                     "       %(prog)s [options] --matrix FILE", formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="*", metavar="LOG_OR_FOLDER", help="LCM logs, and folders that are searched for *.lcmlog")
    parser.add_argument("--matrix", metavar="FILE", help="simulated logs instead: scenes, estimators, limits (docs/operations/fleet.md)")
    parser.add_argument("--out", "-o", default="fleet-output", metavar="DIR", help="folder for the report and the runs [fleet-output]")
    parser.add_argument("--preset", metavar="NAME", help="of leonav-replay: a preset alone; with --matrix instead of the file's")
    parser.add_argument("--config", metavar="FILE", help="of leonav-replay: configuration; with --matrix instead of the file's")
    parser.add_argument("--set", action="append", default=[], dest="settings", metavar="KEY=VALUE",
                        help="of leonav-replay: one key of the configuration; may be repeated; with --matrix after the file's")
    parser.add_argument("--settle", type=at_least(0, float), metavar="S",
                        help="epochs of the first S seconds do not count [0, or the matrix's]")
    parser.add_argument("--resume", action="store_true", help="take what an earlier call finished, if programs, configuration and log are "
                        "the same (by their digests), and run the rest")
    parser.add_argument("--keep", action="store_true", help="keep every run's tables in OUT/runs/NAME, and simulated logs in OUT/logs "
                        "(some 50 and 110 MB an hour of log)")
    parser.add_argument("--bin", metavar="DIR", help="folder of leonav-replay, leonav-eval and leonav-sim [where leonav-fleet is, else "
                        "build/release/bin]")
    with open(os.path.join(ROOT, "VERSION"), encoding="utf-8") as file:
        parser.add_argument("--version", action="version", version=f"%(prog)s {file.read().strip()}")
    only_logs = parser.add_argument_group("logs")
    only_logs.add_argument("--truth", metavar="FILE", help="truth.csv of every log, instead of the one beside it")
    only_logs.add_argument("--remove-offset", action="store_true", help="remove each run's mean error first (truths of unknown datum)")
    only_matrix = parser.add_argument_group("matrix")
    only_matrix.add_argument("--seeds", type=at_least(1), metavar="N", help="seeds 1 to N [the matrix's]")
    only_matrix.add_argument("--duration", type=at_least(1, float), metavar="S", help="of every simulated run [the matrix's]")
    only_matrix.add_argument("--rows", action="append", metavar="PATTERN",
                             help="only rows whose name matches, as in 'correlated/*'; may be repeated")
    only_matrix.add_argument("--list", action="store_true", help="print the names of the rows and leave")
    workers = parser.add_argument_group("workers")
    workers.add_argument("--workers", type=at_least(1), metavar="N", help="worker processes on this machine [processors]")
    workers.add_argument("--scheduler", metavar="ADDRESS", help="use the workers of this Dask scheduler, as in tcp://10.0.0.1:8786; they must "
                         "see the same files under the same names")
    workers.add_argument("--dashboard", type=at_least(1), metavar="PORT",
                         help="serve Dask's pages on 127.0.0.1:PORT while it runs [no port]")
    return parser


def arguments(words):
    parser = parser_of_words()
    options = parser.parse_args(words)
    if bool(options.logs) == bool(options.matrix):
        parser.error("give either logs or --matrix (--help)")
    for name in ("truth", "remove-offset") if options.matrix else ("seeds", "duration", "rows", "list"):
        if getattr(options, name.replace("-", "_")):
            parser.error(f"--{name}: not with {'--matrix' if options.matrix else 'logs'}")
    if options.preset and options.config:
        parser.error("--preset and --config: only one of them")
    if options.scheduler and (options.workers or options.dashboard):
        parser.error("--scheduler: its workers and its pages are not this program's; leave --workers and --dashboard out")
    return options


def programs_folder(given):
    """Where the programs are: named, beside this one as it was called, or of the release build."""
    beside = os.path.dirname(os.path.abspath(shutil.which(sys.argv[0]) or sys.argv[0]))
    for folder in ([given] if given else [beside, os.path.join(ROOT, "build", "release", "bin")]):
        if os.path.exists(os.path.join(folder, "leonav-replay")):
            return os.path.abspath(folder)
    raise CommandError(f"{given or 'build/release/bin'}: has no leonav-replay; build it, or name the folder with --bin")


def digest_of_programs(folder, *names):
    try:
        return replays.digest_of_programs(folder, names)
    except OSError as error:
        raise CommandError(f"{error.filename}: {error.strerror}; build it, or name the folder with --bin") from None


def estimator_of(options):
    config = os.path.abspath(options.config) if options.config else None
    if config and not os.path.isfile(config):
        raise CommandError(f"{options.config}: no such file")
    return replays.Estimator(options.preset, config, tuple(options.settings))


def engine_of(options):
    return engine.Engine(options.out, options.workers, options.scheduler, options.dashboard)


def bench_of(options, fleet, folder, digest, settle_s):
    return replays.Bench(folder, os.path.abspath(options.out), fleet.work, digest, counts_integrity(folder), settle_s, options.remove_offset,
                         options.keep, options.resume, fleet.caller)


def counts_integrity(folder):
    """Whether this leonav-eval can count how often errors exceed their protection levels."""
    told = subprocess.run([os.path.join(folder, "leonav-eval"), "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return re.search(r"^  --integrity(  .*)?$", told.stdout, re.MULTILINE) is not None


def results_of(fleet, groups):
    """(group, job, result) of every run; of one that came to no end the failure. Tells how far it is."""
    shown = progress.Progress(sum(len(group.jobs) for group in groups))
    for group, job, result in fleet.run(groups):
        if isinstance(result, engine.Failed):
            result = {"name": job.name, "failure": result.text, "definition": None}
        shown.tell(report.one_line(result), result["failure"] is not None)
        yield group, job, result
    shown.end()


def draw(diagrams, options):
    """Stanford diagrams of all runs together; where they cannot be drawn the call goes on and says why."""
    for name in ("stanford_horizontal.png", "stanford_vertical.png"):
        with contextlib.suppress(FileNotFoundError):
            os.remove(os.path.join(options.out, name))  # of an earlier call
    if diagrams is None:
        return
    words = [sys.executable, os.path.join(ROOT, "tools", "report", "leonav-integrity-plots"), "--out", options.out, diagrams]
    drawn = subprocess.run(words, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if drawn.returncode != 0:
        print(f"{PROGRAM}: no Stanford diagrams: {(drawn.stderr.strip() or 'no words').splitlines()[-1]}", file=sys.stderr)


def run_logs(options):
    """Returns the report's path and what went wrong."""
    found = logs.named(options.logs)
    if options.truth and not os.path.isfile(options.truth):
        raise CommandError(f"{options.truth}: no such file")
    truths = {name: os.path.abspath(options.truth) if options.truth else logs.truth_of(log) for name, log in found.items()}
    folder, estimator = programs_folder(options.bin), estimator_of(options)
    digest = digest_of_programs(folder, "leonav-replay", "leonav-eval")
    with engine_of(options) as fleet:
        bench = bench_of(options, fleet, folder, digest, options.settle or 0.0)
        # The largest first: no worker begins the longest run when the others are through.
        by_size = sorted(found, key=lambda name: (-os.path.getsize(found[name]), name))
        jobs = [engine.Job(name, replays.replay, bench, estimator, name, found[name], truths[name]) for name in by_size]
        groups = [engine.Group(job.name, [job]) for job in jobs]
        results = [result for _, _, result in results_of(fleet, groups)]
    path, diagrams = report.write(options.out, programs.shell_line(["leonav-replay", *estimator.words()]), results)
    draw(diagrams, options)
    failed = sum(r["failure"] is not None for r in results)
    return path, [f"{failed} of {len(results)} runs failed; {path} names them"] if failed else []


def matrix_groups(bench, table, options):
    """One group for each scene and seed, of what is not there yet; and what is, by (row, seed)."""
    there, groups = {}, []
    for scene in table.scenes:
        variants = [v for s, v in table.rows() if s is scene]
        for seed in table.seeds if variants else ():
            name = f"{matrix.slug(scene.name)}-seed{seed}"
            folder = os.path.join(bench.out if bench.keep else bench.work, "logs", name)
            jobs = []
            for variant in variants:
                row = matrix.row_name(scene, variant)
                run, digest = f"{row}/seed{seed}", simulations.definition(bench, variant.estimator, scene, seed, table.per_seed)
                done = replays.earlier(bench, run, digest) if bench.resume else None
                if done is not None:
                    there[row, seed] = done
                    continue
                jobs.append(engine.Job(run, simulations.replay, bench, variant.estimator, run, folder, digest))
                jobs[-1].row = row, seed
            if jobs and bench.keep:
                shutil.rmtree(folder, ignore_errors=True)  # of an earlier call, perhaps of other programs
            finish = None if bench.keep else lambda folder=folder: shutil.rmtree(folder, ignore_errors=True)
            groups.append(engine.Group(name, jobs, (simulations.simulate, bench, scene, seed, table.per_seed, folder), finish))
    return [group for group in groups if group.jobs], there


def run_matrix(options):
    """Returns the report's path and what went wrong."""
    given = estimator_of(options)
    table = matrix.read(options.matrix, given, options.seeds, options.duration, options.settle, options.rows)
    for name, why in table.skipped:
        print(f"{PROGRAM}: {name} is skipped: {why}", file=sys.stderr)
    if options.list:
        return "\n".join(matrix.row_name(*row) for row in table.rows()), []
    folder = programs_folder(options.bin)
    digest = digest_of_programs(folder, "leonav-replay", "leonav-eval", "leonav-sim")
    with engine_of(options) as fleet:
        bench = bench_of(options, fleet, folder, digest, table.settle_s)
        groups, results = matrix_groups(bench, table, options)
        print(f"{sum(len(group.jobs) for group in groups)} runs to do, {len(results)} already there", file=sys.stderr)
        for _, job, result in results_of(fleet, groups):
            results[job.row] = result
    path, diagrams, rows = matrix_report.write(options.out, table, results)
    draw(diagrams, options)
    failed = sum(r["failure"] is not None for r in results.values())
    missed = sum(bool(row.missed()) for row in rows)
    wrong = [f"{failed} of {len(results)} runs failed; {path} names them"] if failed else []
    wrong += [f"{missed} of {len(rows)} rows miss a limit"] if missed else []
    compared = matrix_report.compared(table, rows)
    lost = sum(not found.holds() for found in compared)
    return path, wrong + ([f"{lost} of {len(compared)} rows are worse than the best other value"] if lost else [])


def main(words):
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    begun = time.time()
    try:
        options = arguments(words)
        path, wrong = run_matrix(options) if options.matrix else run_logs(options)
    except (CommandError, logs.LogError, matrix.MatrixError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"\n{PROGRAM}: stopped; the same call with --resume goes on from here", file=sys.stderr)
        return 130
    except engine.EngineError as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"{PROGRAM}: {f'{error.filename}: {error.strerror}' if error.filename else error}", file=sys.stderr)
        return 1
    if not options.list:
        times = json.dumps({"wall_s": round(time.time() - begun, 1)}) + "\n"
        programs.write_atomically(os.path.join(options.out, "times.json"), times)
    print(path)
    for text in wrong:
        print(f"{PROGRAM}: {text}", file=sys.stderr)
    return 1 if wrong else 0
