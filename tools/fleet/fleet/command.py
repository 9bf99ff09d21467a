"""The command line of leonav-fleet."""
import argparse
import json
import os
import shutil
import signal
import sys
import time

from . import engine, logs, programs, progress, replays, report

PROGRAM = "leonav-fleet"
ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
DESCRIPTION = """Replays many logs, several at a time, and judges each: OUT/report.md and OUT/report.json have a row a run (errors
north, east, up, stated sigmas against them, availability, misses, resets, warnings), totals, and what failed.

A log's truth is NAME.truth.csv or truth.csv beside it; one without is replayed and not judged. The runs are spread over
worker processes, one a core; a worker that is lost is replaced, and what it had in hand is done again. Results do not
depend on the number of workers."""
EPILOG = """exit codes: 0 all went well; 1 a run failed; 2 command line; 130 stopped with Ctrl-C

  leonav-fleet --preset car logs/                        every log below logs/, by the preset car
  leonav-fleet --preset car --resume logs/               goes on after a stop: what is done and unchanged is taken as it is
  leonav-fleet --config vehicle.yaml --set ekf.carrier=true a.lcmlog b.lcmlog --out carrier
"""


class CommandError(Exception):
    """The command line, or a file that it names, is wrong."""


def at_least(least):
    def whole(text):
        value = int(text)
        if value < least:
            raise ValueError(text)
        return value
    whole.__name__ = f"whole number of {least} or more"
    return whole


def arguments(words):
    parser = argparse.ArgumentParser(prog=PROGRAM, description=DESCRIPTION, epilog=EPILOG,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+", metavar="LOG_OR_FOLDER", help="LCM logs, and folders that are searched for *.lcmlog")
    parser.add_argument("--out", "-o", default="fleet-output", metavar="DIR", help="folder for the report and the runs [fleet-output]")
    parser.add_argument("--preset", metavar="NAME", help="of leonav-replay: a preset alone")
    parser.add_argument("--config", metavar="FILE", help="of leonav-replay: configuration")
    parser.add_argument("--set", action="append", default=[], dest="settings", metavar="KEY=VALUE",
                        help="of leonav-replay: one key of the configuration; may be repeated")
    parser.add_argument("--truth", metavar="FILE", help="truth.csv of every log, instead of the one beside it")
    parser.add_argument("--settle", type=float, default=0.0, metavar="S", help="epochs of the first S seconds do not count [0]")
    parser.add_argument("--resume", action="store_true", help="take what an earlier call finished, if programs, configuration and log are "
                        "the same (by their digests), and run the rest")
    parser.add_argument("--keep", action="store_true", help="keep every run's tables in OUT/runs/NAME (some 50 MB an hour of log)")
    parser.add_argument("--workers", type=at_least(1), metavar="N", help="worker processes on this machine [processors]")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="use the workers of this Dask scheduler, as in tcp://10.0.0.1:8786; they must see "
                        "the same files under the same names")
    parser.add_argument("--dashboard", type=at_least(1), metavar="PORT", help="serve Dask's pages on 127.0.0.1:PORT while it runs [no port]")
    parser.add_argument("--bin", metavar="DIR", help="folder of leonav-replay and leonav-eval [where leonav-fleet is, else build/release/bin]")
    options = parser.parse_args(words)
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


def estimator_of(options):
    config = os.path.abspath(options.config) if options.config else None
    if config and not os.path.isfile(config):
        raise CommandError(f"{options.config}: no such file")
    return replays.Estimator(options.preset, config, tuple(options.settings))


def failed_result(name, text):
    return {"name": name, "failure": text, "definition": None}


def run_logs(options):
    found = logs.named(options.logs)
    if options.truth and not os.path.isfile(options.truth):
        raise CommandError(f"{options.truth}: no such file")
    truths = {name: os.path.abspath(options.truth) if options.truth else logs.truth_of(log) for name, log in found.items()}
    folder, estimator, out = programs_folder(options.bin), estimator_of(options), os.path.abspath(options.out)
    digest = replays.digest_of_programs(folder, ("leonav-replay", "leonav-eval"))
    with engine.Engine(out, options.workers, options.scheduler, options.dashboard) as fleet:
        bench = replays.Bench(folder, out, fleet.work, digest, settle_s=options.settle, keep=options.keep, resume=options.resume, caller=fleet.caller)
        # The largest first: no worker begins the longest run when the others are through.
        by_size = sorted(found, key=lambda name: (-os.path.getsize(found[name]), name))
        groups = [engine.Group(name, [engine.Job(name, replays.replay, bench, estimator, name, found[name], truths[name])]) for name in by_size]
        results, shown = [], progress.Progress(len(groups))
        for _, job, result in fleet.run(groups):
            if isinstance(result, engine.Failed):
                result = failed_result(job.name, result.text)
            results.append(result)
            shown.tell(report.one_line(result), result["failure"] is not None)
        shown.end()
    words = programs.shell_line(["leonav-replay", *estimator.words()])
    return report.write(out, words, results), results


def main(words):
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    begun = time.time()
    try:
        options = arguments(words)
        path, results = run_logs(options)
    except (CommandError, logs.LogError) as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(f"\n{PROGRAM}: stopped; the same call with --resume goes on from here", file=sys.stderr)
        return 130
    except OSError as error:
        print(f"{PROGRAM}: {error.filename or ''}: {error.strerror or error}", file=sys.stderr)
        return 1
    programs.write_atomically(os.path.join(options.out, "times.json"), json.dumps({"wall_s": round(time.time() - begun, 1)}) + "\n")
    print(path)
    failed = sum(r["failure"] is not None for r in results)
    if failed:
        print(f"{PROGRAM}: {failed} of {len(results)} runs failed; {path} names them", file=sys.stderr)
    return 1 if failed else 0
