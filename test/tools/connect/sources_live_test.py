#!/usr/bin/env python3
"""sources_live_test.py BIN_DIR WORK_DIR: leonav-connect with an NTRIP caster, a client that connects, and datagrams.

Every byte must be in the recording as it was sent; no password may be in any text of the program or in the recording. A
receiver without ephemerides, and messages that are not used, are told once. Runs in a network namespace of its own; exit 77:
none can be made here.
"""
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path += [str(HERE.parent), str(ROOT / "test/drivers/transport")]
import caster  # noqa: E402
import ubx_bytes  # noqa: E402
from live_program import enter_namespace, fail, require_log_thread  # noqa: E402


def wait_for(what, done):
    for _ in range(300):
        if done():
            return
        time.sleep(0.1)
    fail(f"30 s passed without {what}")


def blocks(path):
    """The blocks of a recording, as far as it has been written out."""
    data, found = path.read_bytes(), []
    at = len("leonav recording 1\n")
    while at + 12 <= len(data):
        length = struct.unpack_from("<qI", data, at)[1]
        found.append(data[at + 12:at + 12 + length])
        at += 12 + length
    return found


def recorded(path):
    return b"".join(blocks(path))


class Run:
    """leonav-connect with one stream that is recorded."""

    def __init__(self, work, name, keys, **environment):
        self.record, self.text = work / f"{name}.leoraw", work / f"{name}.txt"
        config = work / f"{name}.yaml"
        config.write_text(f"streams:\n  - {{name: {name}, {keys}, format: rtcm3, record: {name}.leoraw}}\n")
        self.check = subprocess.run([BIN / "leonav-connect", "--check", config], stderr=subprocess.PIPE, check=False)
        with open(self.text, "wb") as text:
            self.process = subprocess.Popen([BIN / "leonav-connect", config], stderr=text, env={**os.environ, **environment})

    def says(self, words):
        wait_for(f"'{words}'", lambda: words in self.text.read_text(encoding="utf-8"))

    def finish(self):
        self.process.send_signal(signal.SIGTERM)
        if self.process.wait(timeout=20) != 0:
            fail("leonav-connect did not end cleanly")
        text = self.text.read_text(encoding="utf-8")
        print(text)
        for secret in ("sesame", caster.AUTHORIZATION.split()[-1]):
            if secret in text or secret.encode() in self.check.stderr + self.record.read_bytes():
                fail("the password is in what the program says or records")
        return recorded(self.record)


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def ntrip(work):
    with open(work / "said.txt", "w", encoding="utf-8") as said:
        server = subprocess.Popen([sys.executable, caster.__file__, work / "caster"], stdin=subprocess.PIPE, stdout=said)
    said = lambda: (work / "said.txt").read_text(encoding="utf-8")
    wait_for("a caster", lambda: "tls " in said())
    port = dict(line.split()[:2] for line in said().splitlines())["tls"]
    (work / "credentials").write_text("me\nopen:sesame\n")
    os.chmod(work / "credentials", 0o600)
    keys = f"source: ntrip, host: localhost, port: {port}, tls: true, ca_file: caster/ca.pem, credentials_file: credentials"
    run = Run(work, "base", f"{keys}, mountpoint: POSITION, position: [52.5, 13.4, 80], position_interval_s: 1")
    run.says("is open")
    wait_for("two positions", lambda: said().count("position $GPGGA,") >= 2)
    data = run.finish()
    sent = b"".join(map(caster.message, range(100)))
    if len(data) < 18 or not sent.startswith(data):
        fail(f"NTRIP: the recording is not what was sent: {data[:40].hex()}")
    wrong = Run(work, "absent", f"{keys}, mountpoint: ABSENT")
    wrong.says("no mountpoint ABSENT")
    wrong.finish()
    os.chmod(work / "credentials", 0o644)
    check = subprocess.run([BIN / "leonav-connect", "--check", work / "base.yaml"], stderr=subprocess.PIPE, check=False)
    if check.returncode != 3 or b"chmod 600" not in check.stderr:
        fail(f"a credentials file that others may read is taken: {check.stderr}")
    server.stdin.close()
    server.wait(timeout=20)
    print(f"NTRIP: {len(data)} bytes through TLS, as they were sent")


def tcp_server(work):
    port = free_port(socket.SOCK_STREAM)
    run = Run(work, "server", f"source: tcp_server, port: {port}")
    wait_for("a server", lambda: "running" in run.text.read_text(encoding="utf-8"))
    sent = b""
    for client in range(3):
        data = b"".join(caster.message(100 * client + i) for i in range(50))
        with socket.create_connection(("127.0.0.1", port), timeout=10) as one:
            one.sendall(data)
        sent += data
    wait_for("all bytes", lambda: len(recorded(run.record)) == len(sent))
    run.says("the client closed the connection")
    if run.finish() != sent:
        fail("tcp_server: the recording is not what was sent")
    found = blocks(run.record)
    begun = [len(b"".join(found[:i])) for i, one in enumerate(found) if not one]
    if begun != [0, len(sent) // 3, 2 * len(sent) // 3]:
        fail(f"tcp_server: the recording has connections that begin at {begun}")
    if run.text.read_text(encoding="utf-8").count("info: server: not used: 1029 text\n") != 1:
        fail("tcp_server: the message that is not used is not told once")
    print(f"tcp_server: {len(sent)} bytes of three clients, as they were sent")


def udp(work):
    port = free_port(socket.SOCK_DGRAM)
    run = Run(work, "datagrams", f"source: udp, port: {port}, silent_s: 1")
    run.says("is open")
    run.says("does the sender run")
    sent = b""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        for number in range(50):
            data = caster.message(number) * (number % 7 + 1)
            one.sendto(data, ("127.0.0.1", port))
            sent += data
    wait_for("all bytes", lambda: len(recorded(run.record)) == len(sent))
    if run.finish() != sent:
        fail("udp: the recording is not what was sent")
    print(f"udp: {len(sent)} bytes of 50 datagrams, as they were sent")


def without_ephemerides(work):
    """Three minutes of a receiver whose UBX-RXM-SFRBX is not switched on."""
    begin, locks = 1432000000, {}
    seen = {name: {"C1C": (2.3e7, " "), "S1C": (45.0, " ")} for name in ("G01", "G02", "E01", "E02", "E03")}
    (work / "epochs.ubx").write_bytes(b"".join(ubx_bytes.rawx((begin + second, 0.0), seen, locks) for second in range(180)))
    config = work / "silent.yaml"
    config.write_text("playback_speed: 100\nstreams:\n  - {name: receiver, source: file, path: epochs.ubx, format: ubx}\n")
    done = subprocess.run([BIN / "leonav-connect", config], stderr=subprocess.PIPE, check=True, timeout=60, text=True)
    told = "warning: receiver: 2 GPS and 3 Galileo satellites without an ephemeris: switch UBX-RXM-SFRBX on for this port of the receiver (unless another program sends their orbits: warn_without_ephemerides)\n"
    if done.stderr.count(told) != 1:
        fail(f"ephemerides that are missing are not told once: {done.stderr}")
    print("a receiver without ephemerides: told once")


def service_manager(work):
    """As systemd with Type=notify and a watchdog would hear it."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(work / "notify"))
        manager.settimeout(60)
        run = Run(work, "notified", f"source: udp, port: {free_port(socket.SOCK_DGRAM)}", NOTIFY_SOCKET=str(work / "notify"), WATCHDOG_USEC="10000000")
        heard = [manager.recv(100) for _ in range(3)]
        run.says("running; LCM")
        require_log_thread(run.process)
        run.finish()
        manager.settimeout(0)
        try:
            while True:
                heard.append(manager.recv(100))
        except BlockingIOError:
            pass
    if heard[:3] != [b"READY=1", b"WATCHDOG=1", b"WATCHDOG=1"] or heard[-1] != b"STOPPING=1":
        fail(f"a service manager heard {heard}")
    print("service manager: told of start, life and end")


def main():
    global BIN
    if shutil.which("openssl") is None:
        print("SKIPPED: no openssl")
        sys.exit(77)
    enter_namespace()
    BIN, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    ntrip(work)
    tcp_server(work)
    udp(work)
    without_ephemerides(work)
    service_manager(work)


if __name__ == "__main__":
    main()
