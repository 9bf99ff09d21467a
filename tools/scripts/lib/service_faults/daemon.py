"""A leonavd of its own, and the logger that records what it says."""
import os
import re
import resource
import signal
import subprocess
import time

from service_faults.datagrams import URL
from service_faults.drive import HEADING_SIGMA_DEG, ROOT

START_S = 60  # of a busy machine
STOP_S = 30
OUTPUTS = "LEONAV_(HEALTH|SOLUTION|EVENT|EPOCH)"


class NoStart(Exception):
    pass


class Daemon:
    """leonavd with the preset urban or the file `config`, a car, the smoother, journal and checkpoint."""

    def __init__(self, bin_dir, folder, options=(), journal_folder="journal", heading_deg=None, environment=(), memory_mb=None,
                 config=None):
        self.bin, self.folder, self.options, self.memory_mb = bin_dir, folder, list(options), memory_mb
        self.journal = folder / journal_folder / "run.journal"
        self.checkpoint = folder / "checkpoint.yaml"
        self.heading_deg, self.environment = heading_deg, dict(environment)
        self.configuration = ["--config", config] if config else ["--preset", "urban"]
        self.process, self.starts, self.codes = None, 0, []

    def command(self):
        words = [*self.configuration, "--set", "vehicle.kind=car", "--set", "estimator=smoother", "--set", f"lcm.url={URL}",
                 "--journal", self.journal, "--set", f"checkpoint.path={self.checkpoint}"]
        if self.heading_deg is not None:
            words += ["--set", f"alignment.initial_heading_deg={self.heading_deg}",
                      "--set", f"alignment.initial_heading_sigma_deg={HEADING_SIGMA_DEG}"]
        return [self.bin / "leonavd", *words, *self.options]

    def start(self, wait=True):
        self.starts += 1
        self.journal.parent.mkdir(parents=True, exist_ok=True)
        with open(self.text_file(), "w", encoding="utf-8") as text:
            self.process = subprocess.Popen([str(word) for word in self.command()], stdout=text, stderr=text, cwd=ROOT,
                                            env={**os.environ, **self.environment}, preexec_fn=self.limit if self.memory_mb else None)
        self.started = time.time()
        if wait:
            self.wait_until_it_runs()

    def limit(self):
        resource.setrlimit(resource.RLIMIT_AS, (self.memory_mb << 20, self.memory_mb << 20))

    def wait_until_it_runs(self):
        while time.time() < self.started + START_S:
            if "running; LCM" in self.said():
                return
            if self.process.poll() is not None:
                break
            time.sleep(0.02)
        code = self.process.poll()
        self.kill()
        raise NoStart(f"leonavd did not start (exit code {code}): {self.said().strip()[-300:]}")

    def text_file(self):
        return self.folder / f"leonavd{self.starts}.txt"

    def said(self):
        return self.text_file().read_text(encoding="utf-8", errors="replace")

    def kill(self):
        if self.process and self.process.poll() is None:
            self.process.kill()
        if self.process:
            self.process.wait()

    def stop(self, limit_s=STOP_S):
        """SIGTERM; returns how long it took and the exit code. None for the code: it had to be killed."""
        begin = time.time()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(timeout=limit_s)
        except subprocess.TimeoutExpired:
            self.kill()
            code = None
        self.codes.append(code)
        return time.time() - begin, code

    def has_said(self, pattern):
        """The first line of its log, of any start, that matches."""
        for number in range(1, self.starts + 1):
            text = (self.folder / f"leonavd{number}.txt").read_text(encoding="utf-8", errors="replace")
            for line in text.splitlines():
                if re.search(pattern, line):
                    return line
        return None


class Recorder:
    """lcm-logger: the outputs with the times of their arrival."""

    def __init__(self, folder):
        self.log = folder / "outputs.lcmlog"
        self.log.unlink(missing_ok=True)
        self.text = open(folder / "lcm-logger.txt", "w", encoding="utf-8")
        self.process = subprocess.Popen(["lcm-logger", "-f", "-q", "--flush-interval=100", f"--lcm-url={URL}", "-c", OUTPUTS,
                                         str(self.log)],
                                        stdout=self.text, stderr=self.text)
        time.sleep(0.3)

    def stop(self):
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.text.close()
