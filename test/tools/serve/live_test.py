#!/usr/bin/env python3
"""live_test.py BIN_DIR WORK_DIR: leonav-serve from LCM to TCP clients and a pseudo-terminal.

Publishes solutions and epochs by types that lcm-gen writes for Python and by the datagrams of LCM, not by leonav's code, and
compares every sentence's numbers with what was published. A client that does not read must lose sentences, be told of it when
it reads again, and hold nobody up. Damaged messages come in between. Leaves WORK_DIR/client.nmea and WORK_DIR/truth.csv for
test/oracle/nmea.py, and runs it with the Python of LEONAV_PYTHON where that has pynmeagps and pynmea2. Runs in a network namespace of its own; exit 77: none can be made here.
"""
import csv
import datetime
import glob
import math
import os
import pathlib
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.append(str(HERE.parent))
from live_program import enter_namespace, fail, require_log_thread  # noqa: E402

PORT, RATE, INSTANTS = 10110, 20, 2000
GPS_EPOCH = datetime.datetime(1980, 1, 6)
START = datetime.datetime(2024, 2, 28, 23, 59, 30)  # UTC; a leap day begins within the run


class Publisher:
    """The short datagrams of LCM's udpm: magic word, number, channel, message."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.number = 0

    def send(self, channel, data):
        self.number += 1
        self.socket.sendto(struct.pack(">II", 0x4C433032, self.number) + channel.encode() + b"\0" + data, ("239.255.76.67", 7667))


class Reader(threading.Thread):
    """Collects what a client or the pseudo-terminal gets."""

    def __init__(self, read):
        super().__init__(daemon=True)
        self.read, self.data = read, b""
        self.start()

    def run(self):
        try:
            while part := self.read(4096):
                self.data += part
        except OSError:
            pass


def connect(small=False):
    client = socket.socket()
    if small:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
    client.connect(("127.0.0.1", PORT))
    return client


def solution_at(types, index):
    """A curve across the equator and the meridian of Greenwich, with heights of both signs."""
    message = types.solution_t()
    utc = START + datetime.timedelta(seconds=index / RATE)
    message.time_ns = round((utc - GPS_EPOCH).total_seconds() * 1000) * 10**6 + 18 * 10**9
    message.sequence, message.schema = index + 1, 2
    message.source = (3, 2, 0, 4, 1)[index // 400 % 5]
    message.has_attitude = message.source != 1
    turn = 2 * math.pi * index / 700
    message.latitude_rad, message.longitude_rad = 0.3 * math.cos(turn), 0.4 * math.sin(turn)
    message.height_m = 900.0 * math.sin(3 * turn)
    message.v_n, message.rpy_rad = [15 * math.cos(turn), 15 * math.sin(turn), 0.0], [0.0, 0.0, math.atan2(math.sin(turn), math.cos(turn))]
    message.sigma_p_n, message.sigma_v_n, message.sigma_rpy = [0.4, 0.3, 0.9], [0.02, 0.03, 0.04], [0.001] * 3
    return utc, message


def epoch_at(types, solution):
    message = types.epoch_t()
    message.time_ns, message.sequence, message.schema, message.solution = solution.time_ns, 1, 2, solution
    message.satellites_used, message.pdop, message.hdop, message.vdop = 7, 1.6, 0.8, 1.4
    for number in range(9):
        one = types.satellite_report_t()
        one.system, one.number, one.reason = number % 3, number + 1, 0 if number < 7 else 7
        one.elevation_rad, one.azimuth_rad, one.cn0_dbhz = 0.1 * number, 0.6 * number, 40.0 + number
        message.satellites.append(one)
    message.n_satellites = len(message.satellites)
    return message


def sentences(data):
    """Fields of each whole sentence; its checksum must be right."""
    for line in data.split(b"\r\n")[:-1]:
        text = line.decode("ascii")
        body, checksum = text[1:-3], text[-2:]
        total = 0
        for character in body:
            total ^= ord(character)
        if not text.startswith("$") or text[-3] != "*" or f"{total:02X}" != checksum or len(text) > 80:
            fail(f"a bad sentence: {text}")
        yield body.split(",")


def angle(text, letter):
    point = text.index(".")
    return math.radians((int(text[:point - 2]) + float(text[point - 2:]) / 60) * (-1 if letter in "SW" else 1))


def check(name, data, published, all_of_them):
    """Every GGA and RMC against the solution of its time."""
    seen, dates = 0, set()
    by_clock = {utc.strftime("%H%M%S.%f")[:9]: solution for utc, solution in published.items()}
    for fields in sentences(data):
        if fields[0] == "GNRMC":
            day = datetime.datetime.strptime(fields[9] + fields[1] + "0000", "%d%m%y%H%M%S.%f")
            dates.add(fields[9])
            solution = published[day]
            if fields[12] != {0: "N", 2: "E"}.get(solution.source, "A") or fields[2] != ("V" if solution.source == 0 else "A"):
                fail(f"{name}: {fields} of source {solution.source}")
            if solution.source and abs(float(fields[7]) * 1852 / 3600 - 15) > 3e-4:
                fail(f"{name}: speed {fields[7]}")
        elif fields[0] == "GNGGA":
            seen += 1
            solution = by_clock[fields[1]]
            if solution.source == 0:
                if any(fields[2:6]) or fields[6] != "0" or any(fields[8:]):
                    fail(f"{name}: {fields} without a position")
                continue
            off = max(abs(angle(*fields[2:4]) - solution.latitude_rad), abs(angle(*fields[4:6]) - solution.longitude_rad)) * 6.4e6
            if off > 1.1e-3 or abs(float(fields[9]) - solution.height_m) > 5.1e-4 or fields[6] != ("6" if solution.source == 2 else "1"):
                fail(f"{name}: {fields}, off by {off * 1e3:.2f} mm")
    if all_of_them and (seen != len(published) or dates != {"280224", "290224"}):
        fail(f"{name}: {seen} of {len(published)} instants, dates {dates}")
    print(f"{name}: {seen} instants, all equal to what was published within half of the last digit")
    return seen


def run(work, types, text):
    link = work / "nmea"
    manager = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)  # as systemd with Type=notify and a watchdog would hear it
    manager.bind(str(work / "notify"))
    manager.settimeout(60)
    told = {**os.environ, "NOTIFY_SOCKET": str(work / "notify"), "WATCHDOG_USEC": "10000000"}
    sentences_wanted = "sentences=[GGA, RMC, VTG, GST, GSA, GSV, HDT, ZDA]"
    process = subprocess.Popen([BIN / "leonav-serve", "--tcp", str(PORT), "--pty", link, "--rate", str(RATE),
                                "--set", sentences_wanted], stderr=text, env=told)
    for _ in range(100):
        if "running" in (work / "serve.txt").read_text(encoding="utf-8"):
            break
        time.sleep(0.1)
    require_log_thread(process)
    fast = [Reader(connect().recv) for _ in range(3)]
    leaver, slow = connect(), connect(small=True)
    terminal = os.open(link, os.O_RDWR | os.O_NOCTTY)
    pty = Reader(lambda size: os.read(terminal, size))
    time.sleep(0.5)
    publisher, published = Publisher(), {}
    begin = time.monotonic()
    with open(work / "truth.csv", "w", newline="", encoding="ascii") as file:
        truth = csv.writer(file)
        for index in range(INSTANTS):
            utc, solution = solution_at(types, index)
            published[utc] = solution
            truth.writerow([utc.isoformat(timespec="milliseconds"), solution.source, math.degrees(solution.latitude_rad),
                            math.degrees(solution.longitude_rad), solution.height_m, *solution.v_n, solution.rpy_rad[2]])
            data = solution.encode()
            if index % RATE == 0:
                publisher.send("LEONAV_EPOCH", epoch_at(types, solution).encode())
                publisher.send("LEONAV_EPOCH", bytes(20) + data)
                publisher.send("LEONAV_SOLUTION", data[:-1])
                publisher.send("LEONAV_SOLUTION", os.urandom(40))
            publisher.send("LEONAV_SOLUTION", data)
            if index == 500:
                leaver.close()
            time.sleep(max(0.0, begin + index / 200 - time.monotonic()))
    time.sleep(2)
    late = Reader(slow.recv)
    time.sleep(2)
    utc, solution = solution_at(types, INSTANTS)
    solution.source = 3
    published[utc] = solution
    publisher.send("LEONAV_SOLUTION", solution.encode())
    time.sleep(1)
    process.send_signal(signal.SIGTERM)
    if process.wait(timeout=20) != 0:
        fail("leonav-serve did not end well")
    if link.is_symlink():
        fail("the link is still there")
    heard = [manager.recv(100) for _ in range(3)]
    if heard != [b"READY=1", b"WATCHDOG=1", b"WATCHDOG=1"]:
        fail(f"a service manager heard {heard}")
    return published, fast, late, pty


def compare_with_oracle(work):
    python = os.environ.get("LEONAV_PYTHON", "python3")
    if subprocess.run([python, "-c", "import pynmea2, pynmeagps"], stderr=subprocess.DEVNULL).returncode != 0:
        print("SKIPPED (optional): no Python with pynmeagps and pynmea2 (LEONAV_PYTHON names another)")
    elif subprocess.run([python, "-B", ROOT / "test/oracle/nmea.py", work / "client.nmea", work / "truth.csv"]).returncode != 0:
        fail("pynmeagps or pynmea2 reads something else")


def main():
    global BIN
    enter_namespace()
    BIN, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    subprocess.run(["lcm-gen", "--python", "--ppath", work, *sorted(glob.glob(str(ROOT / "lcmtypes/*.lcm")))], check=True)
    sys.path.insert(0, str(work))
    import leonav as types  # pylint: disable=import-outside-toplevel
    with open(work / "serve.txt", "w", encoding="utf-8") as text:
        published, fast, late, pty = run(work, types, text)
    log = (work / "serve.txt").read_text(encoding="utf-8")
    print(log)
    (work / "client.nmea").write_bytes(fast[0].data)
    for number, client in enumerate(fast):
        check(f"client {number}", client.data, published, True)
    check("pseudo-terminal", pty.data, published, True)
    compare_with_oracle(work)
    if check("slow client", late.data, published, False) >= INSTANTS or b"sentences lost" not in late.data:
        fail("the slow client lost nothing, or was not told")
    for words in ("reads too slowly", f"{3 * INSTANTS // RATE} messages refused", "gone ("):
        if words not in log:
            fail(f"leonav-serve did not say '{words}'")


if __name__ == "__main__":
    main()
