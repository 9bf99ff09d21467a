#!/usr/bin/env python3
"""Plays a station's recording with SSR as a live stream through leonav-connect, and keeps what it publishes.

  ssr_live.py BIN_DIR FOLDER OBSERVATIONS NAVIGATION SSR.rtcm3 DATE ANTENNA_MODELS RECEIVER_ANTENNA

The observations leave as MSM7, with the broadcast messages when they were sent and the SSR messages at their time, as one file of
RTCM 3 that leonav-connect plays a thousand times faster. FOLDER/live.lcmlog is what lcm-logger got with the antenna models in the
configuration, FOLDER/live_without.lcmlog without them. Runs in a network namespace of its own; exit 77: none can be made here, or
lcm-logger is missing.
"""
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path += [str(ROOT / folder) for folder in ("test/tools", "test/tools/connect", "test/support/python")]
sys.dont_write_bytecode = True
from live_program import enter_namespace  # noqa: E402
import lcm_log  # noqa: E402
import rtcm3_bytes  # noqa: E402
from navigation_file import records  # noqa: E402
from ubx_bytes import epochs  # noqa: E402

WEEK = 604800
LISTEN = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=33554432"


def broadcasts(path):
    """[(time of transmission, message)] of GPS and of Galileo's I/NAV, in order."""
    found = []
    for satellite, toc, clock, orbit in records(path):
        if satellite[0] not in "GE" or (satellite[0] == "E" and not int(orbit[17]) & 5):
            continue
        sent = toc + (orbit[24] - toc + WEEK / 2) % WEEK - WEEK / 2
        found.append((sent, toc, rtcm3_bytes.ephemeris(satellite, toc, clock, orbit)))
    return sorted(found)


def corrections(path, near):
    """[(time, message)] of a stream of SSR messages; times of the week are those nearest to `near`."""
    data, at, found = pathlib.Path(path).read_bytes(), 0, []
    while at < len(data):
        length = struct.unpack_from(">H", data, at + 1)[0] + 6
        tow = int.from_bytes(data[at + 3:at + 7], "big") & 0xFFFFF
        found.append((near + (tow - near + WEEK / 2) % WEEK - WEEK / 2, data[at:at + length]))
        at += length
    return found


def stream(observations, navigation, ssr):
    receiver, out, waiting, sent = rtcm3_bytes.Receiver(), [], None, 0
    for instant, satellites in epochs(observations):
        now = instant[0] + instant[1]
        if waiting is None:
            old = [one for one in broadcasts(navigation) if abs(one[1] - now) < 6 * 3600]
            waiting = [(time_s, message) for time_s, _, message in old] + corrections(ssr, now)
            waiting.sort(key=lambda one: one[0])
        first = sent
        while sent < len(waiting) and waiting[sent][0] <= now:
            sent += 1
        out += [message for _, message in waiting[first:sent]]
        out.append(receiver.epoch(instant, satellites))
    return b"".join(out)


def tell(folder, name, epochs_sent):
    """Prints how many epochs the log has, of how many in the file, and which corrections were not used."""
    logged = sum(channel.endswith("GNSS_EPOCH") for _, channel, _ in lcm_log.messages(folder / f"{name}.lcmlog"))
    last = [line for line in (folder / f"{name}.txt").read_text(encoding="utf-8").splitlines() if "corrections of" in line][-1:]
    unused = last[0].partition("not used since the start: ")[2] if last else ""
    print(f"{name}: {logged} epochs of {epochs_sent}; corrections not used: {unused or 'none'}")


def capture(bin_dir, folder, name, date, products, epochs_sent):
    (folder / f"{name}.yaml").write_text(
        f"playback_speed: 1000\ncorrections:\n  point: mass_centre\n{products}"
        f"streams:\n  - {{name: station, source: file, path: station.rtcm3, format: rtcm3, date: {date}}}\n", encoding="utf-8")
    log = folder / f"{name}.lcmlog"
    log.unlink(missing_ok=True)
    logger = subprocess.Popen(["lcm-logger", f"--lcm-url={LISTEN}", str(log)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(1)
    with open(folder / f"{name}.txt", "w", encoding="utf-8") as text:
        status = subprocess.run([bin_dir / "leonav-connect", folder / f"{name}.yaml"], stderr=text, check=False).returncode
    time.sleep(1)
    logger.send_signal(signal.SIGTERM)
    logger.wait(timeout=30)
    if status == 0:
        tell(folder, name, epochs_sent)
    if status != 0:
        print((folder / f"{name}.txt").read_text(encoding="utf-8"), file=sys.stderr)
        sys.exit(f"ssr_live.py: leonav-connect ended with {status}")


def main():
    if len(sys.argv) != 9:
        sys.exit(__doc__)
    if shutil.which("lcm-logger") is None:
        print("ssr_live.py: no lcm-logger (package liblcm-bin)", file=sys.stderr)
        sys.exit(77)
    enter_namespace()
    bin_dir, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    observations, navigation, ssr, date, models, antenna = sys.argv[3:]
    epochs_sent = sum(1 for _ in epochs(observations))
    (folder / "station.rtcm3").write_bytes(stream(observations, navigation, ssr))
    capture(bin_dir, folder, "live", date, f'  antenna_models: "{models}"\n  receiver_antenna: "{antenna}"\n', epochs_sent)
    capture(bin_dir, folder, "live_without", date, "", epochs_sent)


if __name__ == "__main__":
    main()
