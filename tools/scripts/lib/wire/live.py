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

    def __init__(self):
        self.lock, self.listener, self.clients, self.port = threading.Lock(), None, [], 0
        self.up()

    def keys(self):
        return f"source: ntrip, host: 127.0.0.1, port: {self.port}, mountpoint: SSR, version: 1"

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

    def __init__(self, bin_dir, folder, streams, connect_keys=(), daemon_options=()):
        self.bin, self.folder = bin_dir, folder
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
            return subprocess.Popen([self.bin / name, *words], stderr=text, stdout=text, cwd=ROOT)

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
