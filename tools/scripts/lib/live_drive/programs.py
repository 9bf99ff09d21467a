"""Programs that this run has started: what they say, and their end. Nothing else is ever ended."""
import signal
import subprocess
import time


class Failure(Exception):
    """A step of the run that did not go as it must; the text says which."""


class Program:
    """A program with its standard error, or all that it prints, in a file."""

    def __init__(self, words, text, stdout=None):
        self.name, self.text = str(words[0]).rsplit("/", 1)[-1], text
        with open(text, "wb") as error:
            self.process = subprocess.Popen([str(word) for word in words], stdin=subprocess.DEVNULL, stdout=stdout or error, stderr=error)

    def said(self):
        return self.text.read_text(encoding="utf-8", errors="replace")

    def wait_for(self, what, limit_s=30.0):
        """Until the program has said `what`."""
        end = time.monotonic() + limit_s
        while what not in self.said():
            if self.process.poll() is not None:
                raise Failure(f"{self.name} ended with {self.process.returncode} before it said '{what}':\n{self.said()[-2000:]}")
            if time.monotonic() > end:
                raise Failure(f"{self.name} did not say '{what}' within {limit_s:.0f} s:\n{self.said()[-2000:]}")
            time.sleep(0.1)

    def finish(self, limit_s=30.0):
        """Ends it by SIGTERM; gives its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(timeout=limit_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise Failure(f"{self.name} did not end within {limit_s:.0f} s of SIGTERM") from None

    def stop(self):
        """Whatever has happened before, it runs no longer afterwards."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
