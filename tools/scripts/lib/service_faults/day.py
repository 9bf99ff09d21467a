"""Runs leonavd for simulated hours, faster than real time, with a journal in pieces and a limit for all of them.

  day.py BIN OUT [--hours H] [--speed S]

Prints an hour a line: resident memory, open files, disk of the journal. Every piece gets a second name (hard link) before leonavd
deletes it, so that the whole run can be replayed. Exit code 1: a bound does not hold.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import time

LIB = pathlib.Path(__file__).resolve().parents[1]
ROOT = LIB.parents[2]
sys.path[:0] = [str(LIB), str(ROOT / "tools/python"), str(ROOT / "test/tools")]
from live_program import enter_namespace  # noqa: E402
from service_faults.daemon import Daemon  # noqa: E402
from service_faults.datagrams import URL  # noqa: E402
from service_faults.process_status import status_kb  # noqa: E402

PIECE_MB, TOTAL_MB, KEPT_MB = 50, 500, 100
SETTINGS = ["gnss.systems=[gps, galileo, leo]", f"journal.piece_mb={PIECE_MB}", f"journal.total_mb={TOTAL_MB}",
            f"journal.kept_mb={KEPT_MB}", "realtime.lock_memory=true"]
SCENARIO = ["places=city", "imu.rate_hz=100", "imu.vibration.high_hz=45", "satellites.beidou.enabled=false"]
WARM_UP_S = 600  # of the drive


def settings(values):
    return [word for value in values for word in ("--set", value)]


def simulated(bin_dir, out, hours):
    log, done = out / "run.lcmlog", out / f"{hours:g}-hours"
    if not done.exists():
        for old in out.glob("*-hours"):
            old.unlink()
        subprocess.run([bin_dir / "leonav-sim", ROOT / "config/scenario/urban.yaml", "-o", log, "--truth", out / "truth.csv",
                        *settings([f"duration_s={round(hours * 3600)}", *SCENARIO])], check=True)
        done.touch()
    return log


class Pieces:
    """The journal's folder, and a second name of each piece."""

    def __init__(self, folder, links):
        self.folder, self.links, self.most_bytes = folder, links, 0
        links.mkdir()

    def look(self):
        total = 0
        for piece in self.folder.iterdir():
            try:
                total += piece.stat().st_size
                link = self.links / piece.name.removesuffix(".kept")
                if not link.exists():
                    os.link(piece, link)
            except FileNotFoundError:  # deleted or renamed meanwhile
                continue
        self.most_bytes = max(self.most_bytes, total)
        return total


def run(words, log, folder):
    """Lines of (drive's s, resident kB, open files, bytes of the journal's folder), the most bytes, and the exit code."""
    daemon = Daemon(words.bin, folder, settings(SETTINGS))
    pieces = Pieces(daemon.journal.parent, folder / "all")
    daemon.start()
    player = subprocess.Popen(["lcm-logplayer", f"--speed={words.speed:g}", f"--lcm-url={URL}", log], stdout=subprocess.DEVNULL)
    begin, looks, hour = time.monotonic(), [], 0
    try:
        while player.poll() is None and daemon.process.poll() is None:
            t = (time.monotonic() - begin) * words.speed
            looks.append((t, status_kb(daemon.process.pid, "VmRSS"), len(os.listdir(f"/proc/{daemon.process.pid}/fd")), pieces.look()))
            if t >= 3600 * hour:
                print(f"| {t / 3600:.1f} | {looks[-1][1] / 1024:.2f} | {looks[-1][2]} | {looks[-1][3] / 1e6:.0f} |", flush=True)
                hour += 1
            time.sleep(0.5)
        time.sleep(1.0)
        _, code = daemon.stop()
        pieces.look()
    finally:
        player.kill()
        player.wait()
        daemon.kill()
    return looks, pieces.most_bytes, code


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--speed", type=float, default=20.0)
    words = parser.parse_args()
    enter_namespace()
    words.out.mkdir(parents=True, exist_ok=True)
    print("simulating", flush=True)
    log = simulated(words.bin, words.out, words.hours)
    folder = words.out / "run"
    subprocess.run(["rm", "-rf", folder], check=True)
    (folder / "journal").mkdir(parents=True)
    print("\n| hours | resident, MB | open files | journal, MB |\n|---|---|---|---|", flush=True)
    looks, most_bytes, code = run(words, log, folder)
    replay = subprocess.run([words.bin / "leonav-replay", folder / "all", "--out", folder / "replay", "--verify"], capture_output=True, text=True, check=False)
    (folder / "replay.txt").write_text(replay.stdout + replay.stderr)
    counts = [subprocess.run([LIB / "input-counts", *paths], capture_output=True, text=True, check=False).stdout
              for paths in ([log], (folder / "all").iterdir())]
    settled = [look for look in looks if look[0] >= WARM_UP_S]
    growth_kb = max(look[1] for look in settled) - settled[0][1]
    files = max(look[2] for look in settled) - settled[0][2]
    names = len(list((folder / "all").iterdir()))
    print(f"\nresident memory grew by {growth_kb} kB and open files by {files} after ten minutes; {names} pieces, at most "
          f"{most_bytes / 1e6:.0f} MB at a time (limit {TOTAL_MB} and {KEPT_MB}); exit code {code}; replay of all pieces: "
          f"{(replay.stdout.strip().splitlines() or ['nothing'])[-1]}")
    bounds = {"memory grew": growth_kb > 0, "open files grew": files > 2, "the journal is larger than its limits":
              most_bytes > (TOTAL_MB + KEPT_MB) * 1e6, "leonavd ended by itself or badly": code != 0,
              "the replay differs": replay.returncode != 0, "inputs were lost on their way": counts[0] != counts[1]}
    broken = [text for text, is_broken in bounds.items() if is_broken]
    for text in broken:
        print(f"bound: {text}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
