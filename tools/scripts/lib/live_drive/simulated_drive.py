"""A simulated drive as the bytes that a receiver, an inertial sensor and a correction service would send."""
import pathlib
import subprocess
import sys

import corrections

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.append(str(ROOT / "test/tools/connect"))
import inav_bytes  # noqa: E402
import ubx_bytes  # noqa: E402
import vectornav_bytes  # noqa: E402

CLOCK_INTERVAL_S = 5  # of the corrections
NAVIGATION_INTERVAL_S = 30  # a frame of GPS, a sub-frame of Galileo
SCENARIO = {"route.standing_s": 10, "satellites.beidou.enabled": "false", "satellites.leo.enabled": "false",
            "satellites.gps.clock_interval_s": CLOCK_INTERVAL_S, "satellites.galileo.clock_interval_s": CLOCK_INTERVAL_S}


def simulate(bin_folder, out, start, duration_s):
    """Exports the drive that begins at `start`, seconds since the GPS epoch."""
    settings = {"start_gps_week": start // 604800, "start_gps_tow_s": start % 604800, "duration_s": duration_s, **SCENARIO}
    options = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    with open(out / "simulation.txt", "w", encoding="utf-8") as text:
        subprocess.run([bin_folder / "leonav-sim", ROOT / "config/scenario/open_sky.yaml", *options, "--export", out / "export",
                        "-o", out / "run.lcmlog"], check=True, stdout=text, stderr=text)


def newest_messages(records, start):
    """{satellite number: (toc, clock terms, numbers)}: the newest message of each satellite that is in force at `start`."""
    newest = {}
    for number, toc, clock, orbit in records:
        if toc <= start + 7200 and (number not in newest or toc > newest[number][0]):
            newest[number] = toc, clock, orbit
    return newest


def navigation(export, start, duration_s):
    """(time of reception, UBX message) of all broadcast messages, in order, and what they tell: {"G": {...}, "E": {...}}."""
    gps = newest_messages(ubx_bytes.records(export / "run.nav"), start)
    galileo = newest_messages(inav_bytes.records(export / "run.nav"), start)
    sent = []
    for frame in range(start, start + duration_s, NAVIGATION_INTERVAL_S):
        sent += ubx_bytes.broadcasts(export / "run.nav", frame)
        sent += inav_bytes.broadcasts(galileo, frame)
    sent.sort(key=lambda item: item[0])
    return sent, {"G": gps, "E": galileo}


def receiver(export, waiting):
    """[(GPS time in ns, bytes)]: each epoch, and behind it the navigation messages that have come since the one before."""
    locks, messages, waiting = {}, [], list(reversed(waiting))
    for instant, satellites in ubx_bytes.epochs(export / "run.obs"):
        data = ubx_bytes.rawx(instant, satellites, locks)
        while waiting and waiting[-1][0] <= instant[0]:
            data += waiting.pop()[1]
        messages.append((round((instant[0] + instant[1]) * 1e9), data))
    return messages


def drive(bin_folder, out, start, duration_s):
    """The three streams: {"receiver", "imu", "corrections": [(GPS time in ns, bytes)]}; the truth is export/truth.csv."""
    simulate(bin_folder, out, start, duration_s)
    export = out / "export"
    sent, told = navigation(export, start, duration_s)
    return {"receiver": receiver(export, sent), "imu": list(vectornav_bytes.messages(export / "imu.csv", "gps")),
            "corrections": corrections.messages(export, told, start, duration_s, CLOCK_INTERVAL_S)}
