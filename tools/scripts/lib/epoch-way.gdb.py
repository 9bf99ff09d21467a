"""Follows one epoch through leonav-replay in gdb and writes the unit of every function entered, in order.

$LEONAV_EPOCH_WAY names the output. Units of core/navigator's stages, of the filter and of the smoother count; what they
call below (mathematics, satellites) is a leaf that the way does not follow.
"""
import os
import re
import subprocess

import gdb

WORK = 100  # pieces of work of the GNSS stage (epochs, ephemerides) before the one that is followed
FOLDERS = re.compile(r"core/(navigator|ekf|filter|smoother|vehicle)/")

gdb.execute("set breakpoint pending off")
gdb.execute("set pagination off")
gdb.execute("set print thread-events off")
entered = []


def unit(frame):
    table = frame.find_sal().symtab
    name = table.filename if table else ""
    match = FOLDERS.search(name)
    return os.path.splitext(name[match.start():])[0] if match else None


class Enter(gdb.Breakpoint):
    def stop(self):
        name = unit(gdb.newest_frame())
        if name:
            entered.append(name)
        return False


program = gdb.current_progspace().filename
symbols = [line.split(" ", 2) for line in
           subprocess.run(["nm", "-C", "--defined-only", program], capture_output=True, text=True, check=True)
           .stdout.splitlines()]
# The function for epochs alone, where there is one: process() jumps to it, and a jump cannot be finished.
ENTRIES = ("leonav::GnssStage::process_work(leonav::EpochWork const&)", "leonav::GnssStage::process(")
anchor, entry = next((int(address, 16), name) for wanted in ENTRIES for address, kind, name in symbols
                     if name.startswith(wanted) and kind == "T")
start = gdb.Breakpoint(entry if entry == ENTRIES[0] else "leonav::GnssStage::process")
start.ignore_count = WORK
gdb.execute("run")
base = gdb.block_for_pc(gdb.newest_frame().pc()).start - anchor
for address, kind, name in symbols:
    place = base + int(address, 16)
    if kind not in "tTwW" or not name.startswith("leonav::") or kind in "wW":
        continue
    table = gdb.find_pc_line(place).symtab
    if table and FOLDERS.search(table.filename) and table.filename.endswith(".cc"):
        Enter(f"*{place:#x}")
# An ephemeris, or an epoch without measurements, does not reach the update.
while True:
    del entered[:]
    gdb.execute("finish")
    if any(name.endswith("robust_update") for name in entered):
        break
    gdb.execute("continue")
with open(os.environ["LEONAV_EPOCH_WAY"], "w", encoding="utf-8") as out:
    out.write("".join(name + "\n" for name in entered))
gdb.execute("kill")
