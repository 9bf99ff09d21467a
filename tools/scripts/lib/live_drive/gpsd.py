"""gpsd with the readers that Debian has for it: gpspipe, whose reports are kept, and cgps, whose screen is."""
import fcntl
import json
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import time

from programs import Failure, Program


class Gpsd:
    """gpsd at `source`, as docs/operations/serve.md starts it, and gpspipe with all its reports in NAME.json."""

    def __init__(self, out, name, source, port, options=()):
        self.reports, self.port = out / f"{name}.json", port
        # gpsd offers its time to NTP by shared memory: not that of a simulated drive to this machine.
        self.gpsd = Program(["unshare", "-i", "gpsd", "-N", "-n", *options, "-S", port, source], out / f"{name}.txt")
        self.connect(out, name)

    def connect(self, out, name):
        for _ in range(50):
            if subprocess.run(["gpspipe", "-w", "-n", "1", f"localhost:{self.port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              stdin=subprocess.DEVNULL, timeout=10, check=False).returncode == 0:
                break
            if self.gpsd.process.poll() is not None:
                raise Failure(f"gpsd ended: {self.gpsd.said()}")
            time.sleep(0.1)
        with open(self.reports, "wb") as out_file:
            self.pipe = Program(["gpspipe", "-w", f"localhost:{self.port}"], out / f"{name}.gpspipe.txt", stdout=out_file)

    def read(self):
        """The reports so far, as dicts; the last line may be half there."""
        lines = self.reports.read_text(encoding="utf-8").splitlines()
        found = []
        for number, line in enumerate(lines):
            try:
                found.append(json.loads(line))
            except json.JSONDecodeError:
                if number + 1 < len(lines):
                    raise Failure(f"{self.reports}: line {number + 1} is no JSON: {line[:80]}") from None
        return found

    def finish(self):
        self.pipe.finish()
        return self.gpsd.finish()

    def stop(self):
        self.pipe.stop()
        self.gpsd.stop()


def cgps_screen(port, seconds):
    """What cgps has written onto a terminal of 40 rows and 120 columns, without the codes that move the cursor."""
    process, terminal = pty.fork()
    if process == 0:
        os.environ["TERM"] = "xterm"
        os.execvp("cgps", ["cgps", f"localhost:{port}"])
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
    data, end = b"", time.monotonic() + seconds
    try:
        while (left := end - time.monotonic()) > 0:
            if select.select([terminal], [], [], left)[0]:
                data += os.read(terminal, 65536)
    except OSError:
        pass  # cgps has ended
    finally:
        os.kill(process, signal.SIGTERM)
        os.waitpid(process, 0)
        os.close(terminal)
    return re.sub(rb"\x1b(\[[0-9;?]*[A-Za-z]|[()][A-Z0-9]|[=>])", b" ", data).decode("utf-8", "replace")


def open_for_all(link):
    """gpsd as root gives up its rights: the terminal must be readable for all, as the page says."""
    os.chmod(pathlib.Path(link).resolve(), 0o666)
