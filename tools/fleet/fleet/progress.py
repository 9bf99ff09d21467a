"""How far the runs are: a bar with the time that is left on a terminal, plain lines otherwise."""
import sys
import time

BAR = 30


def duration(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = seconds / 60.0
    return f"{minutes:.0f} min" if minutes < 90 else f"{minutes / 60.0:.1f} h"


class Progress:
    def __init__(self, total, stream=sys.stderr, clock=time.monotonic):
        self.total, self.stream, self.clock = total, stream, clock
        self.begun, self.done, self.failed = clock(), 0, 0
        self.terminal = stream.isatty()

    def left(self):
        """Of the time, by the runs that have ended."""
        return (self.clock() - self.begun) / self.done * (self.total - self.done) if self.done else None

    def tell(self, text, failed=False):
        self.done += 1
        self.failed += failed
        left = duration(self.left())
        if not self.terminal:
            print(f"[{self.done}/{self.total}, {left} left] {text}", file=self.stream, flush=True)
            return
        if failed:
            print(f"\r\033[K{text}", file=self.stream)
        full = BAR * self.done // max(1, self.total)
        bar = "=" * full + " " * (BAR - full)
        more = f", {self.failed} failed" if self.failed else ""
        print(f"\r\033[K[{bar}] {self.done} of {self.total}, {left} left{more}", end="", file=self.stream, flush=True)

    def end(self):
        if self.terminal and self.done:
            print(file=self.stream)
