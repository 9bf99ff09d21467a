"""Sends the bytes of a drive at their times on pseudo-terminals, and hears what is written to one."""
import os
import pathlib
import sys
import threading
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[4] / "test/support/python"))
from serial_terminal import SerialTerminal  # noqa: E402


class Pace:
    """The host's clock against the drive's: real speed, from the moment of its making on."""

    def __init__(self, first_ns):
        self.first_ns, self.begin = first_ns, time.monotonic()

    def wait_until(self, gps_ns, latency_s=0.0):
        left = (gps_ns - self.first_ns) * 1e-9 + latency_s - (time.monotonic() - self.begin)
        if left > 0:
            time.sleep(left)


class Terminal(SerialTerminal):
    """A pseudo-terminal on whose other side a sensor, or a chart program, is."""

    def __init__(self):
        super().__init__()
        self.heard = b""

    def play(self, messages, pace, latency_s):
        """Starts to send (GPS time in ns, bytes), each `latency_s` after its time; gives the thread."""
        def run():
            for gps_ns, data in messages:
                pace.wait_until(gps_ns, latency_s)
                self.send(data)
        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        return thread

    def listen(self):
        """Keeps in `heard` what the program on the other side writes."""
        def run():
            while True:
                self.heard += os.read(self.sensor, 4096)
        threading.Thread(target=run, daemon=True).start()
