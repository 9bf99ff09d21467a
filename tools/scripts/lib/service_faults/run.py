"""One row in a network and mount namespace of its own: drive, daemon, fault, recording."""
import math
import subprocess
import time

from service_faults.daemon import Daemon, Recorder
from service_faults.datagrams import Sender
from service_faults.drive import Drive

ROUTE = ["ip", "route", "add", "224.0.0.0/4", "dev", "lo"]


def make_network():
    subprocess.run(["ip", "link", "set", "lo", "up", "multicast", "on"], check=True)
    subprocess.run(ROUTE, check=True)


class Run:
    """What a row's functions get. `notes` are the words that it adds to the table."""

    def __init__(self, row, bin_dir, out):
        self.row, self.bin, self.folder = row, bin_dir, out / row.name
        self.drives = out / "drives"
        self.sender, self.notes, self.journal_bytes = Sender(), [], []
        self.drive = self.daemon = None
        self.begin_wall_s = self.last_s = self.late_s = 0.0
        self.starts = 0  # of the daemon, where a row has several

    def clear(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        for pattern in ("leonavd*.txt", "checkpoint*", "journal/*", "disk/*", "whole/*"):
            for old in self.folder.glob(pattern):
                old.unlink()

    def make_drive(self):
        self.drive = Drive(self.bin, self.drives, self.row.duration_s, self.row.scenario)
        return self.drive

    def make_daemon(self, **keys):
        row = self.row
        heading_deg = self.drive.heading_deg() + row.heading_off_deg if self.drive and row.knows_heading else None
        self.daemon = Daemon(self.bin, self.folder, row.options, heading_deg=heading_deg, **row.daemon, **keys)
        return self.daemon

    def note_event(self, outputs, kind, codes, name):
        """Seconds from the fault's begin to its event."""
        found = next((event.t - self.row.begin_s for event in outputs.events if event.t >= self.row.begin_s and event.kind == kind
                      and event.code in codes), math.inf)
        self.notes.append(f"event `{name}` after {found:.0f} s" if math.isfinite(found) else f"no event `{name}`")
        return found

    def journals(self):
        """The first pieces of all runs of the daemon."""
        first = self.daemon.journal
        found = [first, *(first.with_name(f"{first.name}.{k}") for k in range(1, 10))]
        return [path for path in found if path.exists() or path.with_name(path.name + ".kept").exists()]

    def play(self, messages, actions):
        """Sends each message and calls each of (s, function) when it is due. An action must not wait: nothing is sent meanwhile."""
        due = sorted(actions, key=lambda action: action[0])
        begin = time.monotonic() + 0.05
        self.begin_wall_s = time.time() + 0.05
        for t, channel, data in messages:
            while due and due[0][0] <= t:
                self.act(begin, *due.pop(0))
            if self.row.until_stopped and self.daemon.process.poll() is not None:
                break
            wait = begin + t - time.monotonic()
            if wait > 0:
                time.sleep(wait)
            else:
                self.late_s = max(self.late_s, -wait)
            self.sender.send(channel, data)
        for t, function in due:
            self.act(begin, t, function)
        self.last_s = time.monotonic() - begin

    def act(self, begin, t, function):
        time.sleep(max(begin + t - time.monotonic(), 0.0))
        function(self)

    def whole(self):
        """A row with a drive from its begin to its end."""
        row = self.row
        self.make_drive()
        messages = self.drive.messages()
        if row.change:
            messages = row.change(row, messages)
        if row.before:
            row.before(self)
        recorder = None
        self.make_daemon()
        try:
            self.daemon.start()
            recorder = Recorder(self.folder)
            self.play(messages, row.actions)
            time.sleep(0.5)
            if self.daemon.process.poll() is None:
                self.daemon.stop()
            elif not self.daemon.codes:
                self.daemon.codes.append(self.daemon.process.returncode)
        finally:
            self.daemon.kill()
            if recorder:
                recorder.stop()
            if row.after:
                row.after(self)
