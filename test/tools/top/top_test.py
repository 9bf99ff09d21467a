#!/usr/bin/python3
"""top_test.py BIN_DIR: leonav-top shows what is published, in a network namespace of its own.

Messages are encoded by the types that lcm-gen writes for Python and sent as datagrams of LCM, not by leonav's code. Exit 77: no
namespace can be made here.
"""
import math
import os
import pathlib
import pty
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.append(str(HERE.parent))
from generated_types import generated_types  # noqa: E402
from live_program import enter_namespace, fail  # noqa: E402

TIME_NS = ((2200 * 7 + 4) * 86400 + 61) * 10**9 + 500_000_000  # 2022-03-10 00:00:43.5 UTC
DETAIL = "a long text, " * 20 + "its end"  # of a stream; a file gets it whole


def publisher():
    """Sends one message over LCM's multicast."""
    sender, number = socket.socket(socket.AF_INET, socket.SOCK_DGRAM), 0
    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)

    def send(channel, data):
        nonlocal number
        number += 1
        sender.sendto(struct.pack(">II", 0x4C433032, number) + channel.encode() + b"\0" + data, ("239.255.76.67", 7667))
    return send


def messages(types):
    health = types.health_t()
    health.time_ns, health.schema, health.status, health.source = TIME_NS, 2, "DEGRADED", "ekf"
    health.why = "no heading \x1b[2Jyet"  # would clear the terminal
    health.smoother_misses, health.uptime_s, health.memory_mb = 17, 33.0, 81.5
    for name, value in (("rejected not_sane", 4), ("IMU", 100), ("smoother commits", 183)):
        count = types.count_t()
        count.name, count.value = name, value
        health.counts.append(count)
    health.n_counts = len(health.counts)
    health.satellites_by_source, health.age_by_source_s = [3, 9], [1200.4, 14.6]
    solution = types.solution_t()
    solution.time_ns, solution.schema, solution.source, solution.has_attitude = TIME_NS, 2, 3, True
    solution.latitude_rad, solution.longitude_rad, solution.height_m = math.radians(45.5), math.radians(-7.25), 123.456
    solution.v_n, solution.rpy_rad, solution.sigma_p_n = [3.0, 4.0, -1.0], [0.0, 0.0, math.radians(-90)], [0.5, 0.25, 1.5]
    solution.horizontal_protection_m, solution.vertical_protection_m = 6.25, math.nan
    epoch = types.epoch_t()
    epoch.time_ns, epoch.schema, epoch.solution, epoch.satellites_used, epoch.pdop = TIME_NS, 2, solution, 1, 1.75
    for number, reason in ((5, 0), (9, 7)):
        one = types.satellite_report_t()
        one.system, one.number, one.reason, one.elevation_rad, one.azimuth_rad, one.cn0_dbhz = 0, number, reason, 0.5, 1.0, 45.0
        one.orbit_source, one.ephemeris_age_s = (2, 14.6) if reason == 0 else (0, math.nan)
        epoch.satellites.append(one)
    epoch.n_satellites = len(epoch.satellites)
    event = types.event_t()
    event.time_ns, event.schema, event.stage, event.kind, event.value = TIME_NS, 1, 2, 3, 0.25
    streams, stream = types.streams_t(), types.stream_t()
    stream.name, stream.state, stream.messages, stream.damaged, stream.message_age_s = "receiver", "good", 321, 2, 0.5
    stream.detail = DETAIL
    streams.time_ns, streams.schema, streams.n, streams.streams = TIME_NS, 1, 1, [stream]
    corrected = [corrected_states(types, TIME_NS - 10 * 10**9, 0, ((5, 4.0, 20.0, 0.05), (7, 5.0, 20.0, 0.07))),
                 corrected_states(types, TIME_NS - 2 * 10**9, 1, ((11, 6.0, 29.5, 0.06),))]
    return [("LEONAV_CORRECTED_STATES", one.encode()) for one in corrected] + [
            ("LEONAV_HEALTH", health.encode()), ("LEONAV_STREAMS", streams.encode()), ("LEONAV_EVENT", event.encode()),
            ("LEONAV_EPOCH", epoch.encode()), ("LEONAV_HEALTH", b"damaged"), ("LEONAV_SOLUTION", solution.encode())]


def corrected_states(types, time_ns, system, satellites):
    """A message with states of one system: numbers, ages of clock and orbit, sigmas."""
    message = types.corrected_states_t()
    message.time_ns, message.schema, message.provider, message.solution, message.ssr_issue = time_ns, 1, 258, 2, 5
    for number, clock, orbit, sigma in satellites:
        one = types.corrected_state_t()
        one.system, one.number, one.clock_age_s, one.orbit_age_s, one.sigma_m = system, number, clock, orbit, sigma
        message.states.append(one)
    message.n = len(message.states)
    return message


class Sender(threading.Thread):
    """Publishes all messages ten times a second until it is stopped."""

    def __init__(self, some):
        super().__init__(daemon=True)
        self.some, self.running = some, True
        self.start()

    def run(self):
        send = publisher()
        while self.running:
            for channel, data in self.some:
                send(channel, data)
            time.sleep(0.1)


def once(program, *arguments):
    return subprocess.run([sys.executable, program, "--once", *arguments], capture_output=True, text=True, check=False, timeout=100)


def require(text, *pieces):
    for piece in pieces:
        if piece not in text:
            fail(f"'{piece}' is not in:\n{text}")


def check_once(program, some):
    silent = once(program, "--wait", "0.5")
    if silent.returncode != 1 or "no message on LEONAV_* within 0.5 s; does leonavd run" not in silent.stderr:
        fail(f"nothing published: {silent}")
    for text in ("nan", "inf", "-1", "soon"):
        wrong = once(program, "--wait", text)
        if wrong.returncode != 2 or "--wait" not in wrong.stderr:
            fail(f"--wait {text}: {wrong}")
    sender = Sender(some)
    shown = once(program, "--wait", "60")
    sender.running = False
    sender.join()
    if shown.returncode != 0 or "\x1b" in shown.stdout:
        fail(f"--once: {shown}")
    require(shown.stdout, "DEGRADED  no heading ?[2Jyet", "uptime 33 s", "misses filter 0, smoother 17 of 200", "counts: rejected not_sane 4\n",
            "2022-03-10 00:00:43.5 UTC   source ekf", "latitude 45.50000000   longitude -7.25000000   height 123.46 m",
            "speed 5.00 m/s, up 1.00 m/s", "heading 270.00 degrees", "1 sigma north 0.50, east 0.25, down 1.50 m",
            "horizontal 6.2 m, vertical -", "1 used of 2, gps 1   PDOP 1.8", "G05      29  57 45.0 ###############      used             precise, 15 s\n",
            "G09      29  57 45.0 ###############      low_elevation\n",
            "provider 258, solution 2, issue 5: 3 satellites (gps 2, galileo 1)   oldest: clock 15 s, orbit 32 s   1 sigma 0.06 m   last 0 s ago",
            "satellites used: 3 by broadcast messages (oldest 1200 s), 9 by corrected or precise states (oldest 15 s)", DETAIL + "\n")


def check_terminal(program, some):
    """In a terminal of 60 columns: a picture, the silence after the sender has stopped, and a clean end."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "COLUMNS": "60", "LINES": "40", "TERM": "xterm"}
    running = subprocess.Popen([sys.executable, program], stdin=theirs, stdout=theirs, stderr=theirs, env=environment)
    os.close(theirs)
    shown = b""

    def read_until(*wanted):
        nonlocal shown
        end = time.monotonic() + 60
        while not all(one in shown for one in wanted):
            if time.monotonic() > end:
                fail(f"{wanted} did not come: {shown[-3000:]}")
            if select.select([ours], [], [], 0.2)[0]:
                shown += os.read(ours, 65536)
    sender = Sender(some)
    read_until(b"\x1b[?1049h", b"receiver", b"published 321, damaged 2", b"gnss: aligned", b"low_elevation")
    sender.running = False
    sender.join()
    read_until(b"SILENT for")
    running.send_signal(signal.SIGTERM)
    read_until(b"\x1b[?25h\x1b[?1049l")
    if running.wait(timeout=60) != 0:
        fail(f"SIGTERM: exit code {running.returncode}")
    for line in shown.decode(errors="replace").split("\n"):
        plain = line.split("\x1b[K")[0].split("\x1b[H")[-1]
        if len(plain) > 60 and "\x1b" not in plain:
            fail(f"a line is longer than the terminal: {plain}")


def check_what_has_stopped(types, some):
    """New misses, and corrections that do not come any more, by the picture itself."""
    sys.path[:0] = [str(ROOT / "tools" / "top"), str(ROOT / "tools" / "python")]
    import leonav
    from top.picture import State, picture

    state = State()
    for channel, data in some:
        if data != b"damaged":
            state.take(leonav.Message(channel[len("LEONAV_"):], *leonav.decode(data)), 100.0)
    again = types.health_t.decode(next(data for channel, data in some if channel == "LEONAV_HEALTH"))
    again.smoother_misses += 1
    state.take(leonav.Message("HEALTH", *leonav.decode(again.encode())), 110.0)
    require("\n".join(picture(state, 115.0, 200, 100)), "smoother 18 of 201, last 5 s ago", "-- solution: SILENT for 15 s", "-- corrections\n")
    require("\n".join(picture(state, 170.0, 200, 100)), "-- corrections: SILENT for 70 s", "3 satellites (gps 2, galileo 1)", "last 70 s ago")
    require("\n".join(picture(state, 300.0, 200, 100)), "provider 258, solution 2, issue 5: none for 200 s")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        import numpy  # noqa: F401
    except ImportError as missing:
        print(f"SKIPPED: {missing} for {sys.executable} (Debian package python3-numpy)")
        return
    if shutil.which("lcm-gen") is None:
        print("SKIPPED: no lcm-gen (package liblcm-bin)")
        return
    enter_namespace()
    program = os.path.join(sys.argv[1], "leonav-top")
    with tempfile.TemporaryDirectory() as work:
        types = generated_types(ROOT, pathlib.Path(work))
        some = messages(types)
        check_what_has_stopped(types, some)
        check_once(program, some)
        check_terminal(program, some)
    if subprocess.run([sys.executable, program, "--help"], capture_output=True, check=False).returncode != 0:
        fail("--help")
    print("leonav-top: passed")


main()
