"""Heap allocations of a running program by thread, by the library leonav-count-allocations.so."""
import pathlib
import struct
import threading
import time

ROWS, ROW = 64, struct.Struct("<qQ16s")  # as in tools/common/allocations/preload
LIBRARY = "leonav-count-allocations.so"


class Counted:
    """Allocations of threads by name, within some time."""

    def __init__(self, by_thread):
        self.by_thread = by_thread

    def is_none(self):
        return not any(self.by_thread.values())

    def text(self):
        return ", ".join(f"{name} {count}" for name, count in sorted(self.by_thread.items()) if count) or "0"


class Allocations:
    def __init__(self, bin_dir, path):
        self.library, self.path, self.begin = pathlib.Path(bin_dir) / LIBRARY, path, {}
        if not self.library.is_file():
            raise FileNotFoundError(f"{self.library} is not there; build the target leonav-count-allocations")
        path.write_bytes(bytes(ROWS * ROW.size))

    def environment(self):
        return {"LD_PRELOAD": str(self.library), "LEONAV_ALLOCATIONS": str(self.path)}

    def rows(self):
        return {thread: (name.rstrip(b"\0").decode(errors="replace"), count)
                for thread, count, name in ROW.iter_unpack(self.path.read_bytes()) if thread or count}

    def count_from(self, wall_s):
        """Counts what comes after this time of the wall clock."""
        timer = threading.Timer(max(wall_s - time.time(), 0.0), lambda: self.begin.update(self.rows()))
        timer.daemon = True
        timer.start()

    def counted(self):
        now = self.rows()
        if not now or not self.begin:
            raise RuntimeError(f"{self.path}: nothing was counted, not even at the program's start")
        by_thread = {}
        for thread, (name, count) in now.items():
            by_thread[name] = by_thread.get(name, 0) + count - self.begin.get(thread, ("", 0))[1]
        return Counted(by_thread)
