"""leonav-connect and leonavd on pseudo-terminals, a caster or recordings, fed at the pace of a drive."""
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

from drive import LEAP_SECONDS, ROOT, UNIX_GPS_S

sys.path.append(str(ROOT / "test/support/python"))
from ntrip_server import STREAM_1, read_request  # noqa: E402
from serial_terminal import SerialTerminal  # noqa: E402

URL = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"


class Terminal(SerialTerminal):
    """A serial port whose other side the sensor is; it never waits for room."""

    def __init__(self):
        super().__init__()
        os.set_blocking(self.sensor, False)

    def keys(self):
        return f"source: serial, device: {self.name}, baud: 460800"

    def send(self, data):
        self.send_for(data, 1.0)


class Caster:
    """An NTRIP caster of version 1 with one mountpoint, which can be gone."""

    def __init__(self, host="127.0.0.1"):
        self.host = host
        self.lock, self.listener, self.clients, self.port = threading.Lock(), None, [], 0
        self.up()

    def keys(self):
        return f"source: ntrip, host: {self.host}, port: {self.port}, mountpoint: SSR, version: 1"

    def up(self):
        self.listener = socket.create_server(("127.0.0.1", self.port))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self.accept, args=(self.listener,), daemon=True).start()

    def down(self):
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        with self.lock:
            for client in self.clients:
                client.close()
            self.clients.clear()

    def accept(self, listener):
        while True:
            try:
                client = listener.accept()[0]
                read_request(client)
                client.sendall(STREAM_1)
            except OSError:
                return
            with self.lock:
                self.clients.append(client)

    def send(self, data):
        with self.lock:
            for client in list(self.clients):
                try:
                    client.sendall(data)
                except OSError:
                    self.clients.remove(client)


class NameServer:
    """Knows every name by the address 127.0.0.1, and can be mute. It has the place of the host's: in a namespace of mounts alone."""

    def __init__(self, folder):
        (folder / "resolv.conf").write_text("nameserver 127.0.0.1\n")
        subprocess.run(["mount", "--bind", folder / "resolv.conf", "/etc/resolv.conf"], check=True)
        self.is_mute = False
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 53))
        threading.Thread(target=self.serve, daemon=True).start()

    def mute(self):
        self.is_mute = True

    def speak(self):
        self.is_mute = False

    def serve(self):
        while True:
            query, asker = self.socket.recvfrom(512)
            if not self.is_mute:
                self.socket.sendto(self.answer(query), asker)

    @staticmethod
    def answer(query):
        """RFC 1035, 4.1: of the type A the address, of others no record."""
        end = query.index(0, 12) + 5  # behind the question
        is_address = query[end - 4:end - 2] == b"\0\1"
        head = query[:2] + b"\x81\x80" + struct.pack(">HHHH", 1, is_address, 0, 0)
        record = b"\xc0\x0c" + struct.pack(">HHIH", 1, 1, 0, 4) + socket.inet_aton("127.0.0.1")
        return head + query[12:end] + (record if is_address else b"")


class HostClock:
    """The clock of day that the programs see, off by whole `days` where it is wrong. Their steady clock goes on."""

    LIBRARIES = [f"/usr/lib/{machine}-linux-gnu/faketime/libfaketimeMT.so.1" for machine in ("x86_64", "aarch64")]

    def __init__(self, folder, days, is_wrong):
        self.path, self.days = folder / "clock.txt", days
        self.wrong() if is_wrong else self.right()

    def wrong(self):
        self.set(self.days)

    def right(self):
        self.set(0)

    def set(self, days):
        new = self.path.with_suffix(".new")
        new.write_text(f"{days * 86400:+d}\n")
        new.replace(self.path)

    def environment(self):
        library = next((path for path in self.LIBRARIES if os.path.exists(path)), None)
        if library is None:
            sys.exit("libfaketime is missing (Debian: faketime)")
        return {"LD_PRELOAD": library, "FAKETIME_TIMESTAMP_FILE": str(self.path), "FAKETIME_NO_CACHE": "1",
                "FAKETIME_DONT_FAKE_MONOTONIC": "1", "DONT_FAKE_MONOTONIC": "1"}


class Recording:
    """A recording, complete before the program starts: it plays it by its arrivals."""

    def __init__(self, path, stream, first_gps_s):
        self.path = path
        with open(path, "wb") as file:
            file.write(b"leonav recording 1\n")
            for t, data in stream:
                # As the host's clock has it that counted from its start: without the leap second in between.
                file.write(struct.pack("<qI", round((first_gps_s + t + UNIX_GPS_S - LEAP_SECONDS + 1) * 1e9), len(data)) + data)

    def keys(self):
        return f"source: file, path: {self.path}"


class Programs:
    """Both programs with their logs. `streams`: (name, source, other keys) of the configuration."""

    def __init__(self, bin_dir, folder, streams, connect_keys=(), daemon_options=(), environment=None):
        self.bin, self.folder, self.environment = bin_dir, folder, {**os.environ, **(environment or {})}
        lines = [f"lcm: {{url: '{URL}'}}", "status_interval_s: 5", *connect_keys, "streams:"]
        lines += [f"  - {{name: {name}, {source.keys()}, {keys}}}" for name, source, keys in streams]
        (folder / "connect.yaml").write_text("\n".join(lines) + "\n")
        self.daemon = self.start("leonavd", "--preset", "urban", "--set", f"lcm.url={URL}", "--journal", folder / "run.journal", *daemon_options)
        self.wait_for("leonavd", self.daemon, "running; LCM")
        self.connect = self.start("leonav-connect", folder / "connect.yaml")
        self.begin = self.day_s()
        self.wait_for("leonav-connect", self.connect, "running; LCM")

    def start(self, name, *words):
        with open(self.folder / f"{name}.txt", "w", encoding="utf-8") as text:
            return subprocess.Popen([self.bin / name, *words], stderr=text, stdout=text, cwd=ROOT, env=self.environment)

    def said(self, name):
        return (self.folder / f"{name}.txt").read_text(encoding="utf-8", errors="replace")

    def wait_for(self, name, process, words, limit_s=60):
        for _ in range(limit_s * 20):
            if words in self.said(name):
                return
            if process.poll() is not None:
                break
            time.sleep(0.05)
        self.stop()
        sys.exit(f"{name} did not say '{words}':\n{self.said(name)}")

    @staticmethod
    def day_s():
        now = time.time()
        local = time.localtime(now)
        return local.tm_hour * 3600 + local.tm_min * 60 + local.tm_sec + now % 1

    def play(self, actions):
        """Calls each of (s, function) when it is due. `begin` is then the time of day of the s 0. Returns the longest delay."""
        start, latest = time.monotonic(), 0.0
        self.begin = self.day_s()
        for t, action in actions:
            wait = start + t - time.monotonic()
            if wait > 0:
                time.sleep(wait)
            latest = max(latest, -wait)
            action()
        return latest

    def stop(self):
        """Ends both; returns their exit codes."""
        codes = []
        for process in (getattr(self, "connect", None), self.daemon):
            if process is None:
                continue
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
            try:
                codes.append(process.wait(timeout=30))
            except subprocess.TimeoutExpired:
                process.kill()
                codes.append(-9)
            time.sleep(1)
        return codes
