"""Feeds leonav-connect and leonavd with a simulated drive and one fault of the wire, and says what came of it.

  wire_faults.py BIN OUT [--jobs N] [ROW...]

Each row runs at the pace of its drive, in namespaces of network and mounts of its own, N (6) at a time. A table goes to standard output
and to OUT/wire-faults.md, logs and journals to OUT/ROW. Exit code 1: an expectation of rows.py does not hold.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "wire"), str(HERE.parents[2] / "test/tools")]
import judge  # noqa: E402
import live  # noqa: E402
from drive import Drive  # noqa: E402
from live_program import namespace_command  # noqa: E402
from rows import LIMIT_M, ROWS, SETTLED_S, Scene, all_rows  # noqa: E402

HEADER = """
| fault | leonav-connect said | leonavd said | longest gap, s | worst error, m (1 sigma) | largest error / sigma | below %.1f m after, s | corrected satellites before, meanwhile, at the end | replay | as expected |
|---|---|---|---|---|---|---|---|---|---|""" % LIMIT_M


def by_name(name):
    return next(row for row in all_rows() if row.name == name)


def run(row, bin_dir, folder):
    """The whole of one row; inside a network namespace. Returns what the table shows."""
    new_drive = lambda name="drive", **keys: Drive(bin_dir, folder / name, row.duration_s, **keys)
    made = row.make(Scene(new_drive, row.begin_s, row.end_s))
    drive, sources = made.drive, {}
    for name, (keys, stream) in made.streams.items():
        if made.recorded:
            sources[name] = live.Recording(folder / f"{name}.leoraw", stream, drive.first)
        else:
            sources[name] = live.Caster(made.casters[name]) if name in made.casters else live.Terminal()
    host = {"names": live.NameServer(folder)} if made.has_name_server else {}
    if made.clock:
        host["clock"] = live.HostClock(folder, *made.clock)
    programs = live.Programs(bin_dir, folder, [(name, sources[name], keys) for name, (keys, _) in made.streams.items()],
                             made.connect_keys, made.daemon_options, host["clock"].environment() if made.clock else None)
    actions = [(t, getattr({**sources, **host}[name], what)) for t, what, name in made.actions]
    if made.recorded:
        actions.append((row.duration_s, lambda: None))
    else:
        for name, (_, stream) in made.streams.items():
            actions += [(t, lambda send=sources[name].send, data=data: send(data)) for t, data in stream]
    delay = programs.play(sorted(actions, key=lambda action: action[0]))
    codes = programs.stop()
    return judged(row, bin_dir, folder, drive, programs, codes, delay)


def replay(bin_dir, folder, *words):
    done = subprocess.run([bin_dir / "leonav-replay", folder / "run.journal", *words], capture_output=True, text=True, check=False)
    (folder / "replay.txt").write_text(done.stdout + done.stderr)
    return done.returncode == 0


def share_corrected(folder, first_gps_s, spans):
    """Of the satellites of GPS and Galileo that were used in each span, the share with precise states."""
    used, precise = [0] * len(spans), [0] * len(spans)
    for week, tow, source, is_used, system in judge.satellites(folder / "replay/satellites.csv"):
        t = week * judge.WEEK_S + tow - first_gps_s
        for index, (begin, end) in enumerate(spans):
            if begin <= t < end and is_used and system in "GE":
                used[index] += 1
                precise[index] += source == "precise"
    return [round(a / b, 2) if b else 0.0 for a, b in zip(precise, used)]


def judged(row, bin_dir, folder, drive, programs, codes, delay):
    expected, failures = row.expected, []
    verified = replay(bin_dir, folder, "--verify", "--out", folder / "replay")
    replay_ok = verified and replay(bin_dir, folder, "--rate", "10", "--out", folder / "continuous")
    said = {name: judge.Said(programs.said(name), programs.begin) for name in ("leonav-connect", "leonavd")}
    track = judge.Track(folder / "continuous/solution.csv", drive.truth, drive.first)
    settled, end = row.settled_s or min(SETTLED_S, row.begin_s - 5), row.duration_s - 2
    error, sigma, at = track.worst(settled, end)
    result = {"gap_s": track.longest_gap(settled, end), "worst_m": error, "sigma_m": sigma, "worst_at_s": at,
              "sigmas": track.worst_sigmas(settled, end), "recovered_s": track.settled_after(row.end_s, LIMIT_M), "verified": verified,
              "delay_s": delay, "connect": [], "health": []}

    def must(holds, text):
        if not holds:
            failures.append(text)

    must(codes == [0, 0], f"exit codes {codes}")
    must(replay_ok, "the journal does not replay")
    for kind, name, patterns in (("connect", "leonav-connect", expected.connect), ("health", "leonavd", expected.health)):
        for pattern in patterns:
            found = said[name].first(pattern, row.begin_s)
            must(found, f"{name} did not say '{pattern}'")
            if found:
                result[kind].append([round(found[0] - row.begin_s, 1), found[1]])
                must(found[0] - row.begin_s <= expected.within_s, f"{name} said '{pattern}' after {found[0] - row.begin_s:.0f} s")
    for pattern in expected.never:
        for name, lines in said.items():
            found = lines.first(pattern, row.begin_s)
            must(not found, f"{name} said '{found and found[1]}'")
    for key in ("gap_s", "worst_m", "sigmas", "recovered_s"):
        limit = getattr(expected, key)
        must(result[key] <= limit, f"{key} {result[key]:.2f}, allowed {limit}")
    if expected.corrected:
        # A state holds for a minute, so the last third of the fault shows what it came to.
        spans = [(settled, row.begin_s), (row.end_s - (row.end_s - row.begin_s) / 3, row.end_s), (end - 10, end)]
        result["corrected"] = share_corrected(folder, drive.first, spans)
        for value, (least, most) in zip(result["corrected"], expected.corrected):
            must(least <= value <= most, f"corrected {value}, expected {least} to {most}")
    result["failures"] = failures
    return result


def table_row(row, result):
    quote = lambda lines: "<br>".join(f"after {t:.0f} s: `{line.replace('|', '/')}`" for t, line in lines) or "-"
    recovered = f"{result['recovered_s']:.0f}" if math.isfinite(result["recovered_s"]) else "never"
    corrected = ", ".join(f"{100 * share:.0f} %" for share in result.get("corrected", [])) or "-"
    return (f"| {row.text} | {quote(result['connect'])} | {quote(result['health'])} | {result['gap_s']:.1f} | {result['worst_m']:.2f} ({result['sigma_m']:.2f}) "
            f"| {result['sigmas']:.1f} | {recovered} | {corrected} | {'equal' if result['verified'] else 'differs'} "
            f"| {'yes' if not result['failures'] else 'NO: ' + '; '.join(result['failures'])} |")


def enter_namespace_and_run(words):
    name, bin_dir, out = words.one, words.bin, words.out
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("run.journal*"):
        old.unlink()
    result = run(by_name(name), bin_dir, folder)
    (folder / "result.json").write_text(json.dumps(result, indent=1))


def start(name, words, namespace):
    """Runs one row in a process of its own, in a namespace; returns its result."""
    folder = words.out / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "result.json").unlink(missing_ok=True)
    script = 'ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"'
    with open(folder / "run.txt", "w", encoding="utf-8") as text:
        subprocess.run([*namespace, "-m", "sh", "-c", script, "row", sys.executable, __file__, words.bin, words.out, "--one", name],
                       stdout=text, stderr=text, check=False)
    try:
        return json.loads((folder / "result.json").read_text())
    except OSError:
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("rows", nargs="*", metavar="ROW")
    parser.add_argument("--jobs", type=int, default=6)
    parser.add_argument("--one", help=argparse.SUPPRESS)
    words = parser.parse_intermixed_args()
    if words.one:
        return enter_namespace_and_run(words)
    unknown = [name for name in words.rows if name not in {row.name for row in all_rows()}]
    if unknown:
        parser.error(f"no row is called {unknown[0]}; there are: {', '.join(row.name for row in ROWS)}")
    rows = [row for row in all_rows() if row.name in words.rows] if words.rows else ROWS
    namespace = namespace_command()
    words.out.mkdir(parents=True, exist_ok=True)
    # The longest begin first.
    order = sorted(rows, key=lambda row: -row.duration_s)
    with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
        running = {row.name: pool.submit(start, row.name, words, namespace) for row in order}
        lines, failed = [HEADER], 0
        for row in rows:
            result = running[row.name].result()
            failed += result is None or bool(result["failures"])
            lines.append(table_row(row, result) if result else f"| {row.text} | NO RESULT: see {words.out / row.name / 'run.txt'} |")
            print(lines[-1] if len(lines) > 2 else "\n".join(lines), flush=True)
    (words.out / "wire-faults.md").write_text("\n".join(lines).lstrip() + "\n")
    print(f"{len(rows) - failed} of {len(rows)} rows as expected; {words.out / 'wire-faults.md'}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
