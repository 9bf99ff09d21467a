"""Runs leonav-fleet with programs that wait, and disturbs it: disturb.py WHAT STARTED GO COMMAND...

The programs write "their id, their worker's id" into STARTED and wait for the file GO. WHAT is
  kill    ends a worker, then lets the programs go
  stop    Ctrl-C, of the whole process group, as a terminal does it
  listen  prints the addresses at which the processes listen, then lets the programs go
Prints "exit CODE" in the end, and whether the programs that waited are gone. Ends only processes of its own call.
"""
import os
import signal
import subprocess
import sys
import time


def parent_of(pid):
    with open(f"/proc/{pid}/stat") as file:
        return int(file.read().rsplit(")", 1)[1].split()[1])


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def descends(pid, ancestor):
    while pid > 1:
        if pid == ancestor:
            return True
        try:
            pid = parent_of(pid)
        except OSError:
            return False
    return False


def listening(ancestor):
    """Local addresses, in hexadecimal as /proc has them, of the sockets that descendants listen at."""
    sockets = {}
    for table in ("tcp", "tcp6"):
        with open(f"/proc/net/{table}") as file:
            for line in list(file)[1:]:
                words = line.split()
                if words[3] == "0A":
                    sockets[words[9]] = words[1]
    found = set()
    for pid in filter(str.isdigit, os.listdir("/proc")):
        if not descends(int(pid), ancestor):
            continue
        for handle in os.scandir(f"/proc/{pid}/fd"):
            target = os.readlink(handle.path)
            if target.startswith("socket:[") and target[8:-1] in sockets:
                found.add((int(pid) == ancestor, sockets[target[8:-1]]))
    return found


def wait_for(what, limit_s=60):
    end = time.monotonic() + limit_s
    while not what():
        if time.monotonic() > end:
            print("waited in vain")
            return
        time.sleep(0.05)


what, started, go, *command = sys.argv[1:]
process = subprocess.Popen(command, start_new_session=True)


def waiting():
    if not os.path.exists(started):
        return []
    with open(started) as file:
        return [tuple(map(int, line.split())) for line in file if line.endswith("\n")]


wait_for(lambda: waiting() or process.poll() is not None)
time.sleep(1.0)  # let the other worker begin too
programs = waiting()
if what == "kill":
    worker = programs[0][1]
    if parent_of(worker) == process.pid:
        os.kill(worker, signal.SIGKILL)
        print("a worker killed")
    wait_for(lambda: not is_alive(programs[0][0]))
elif what == "stop":
    os.killpg(process.pid, signal.SIGINT)
elif what == "listen":
    for own, address in sorted(listening(process.pid)):
        print("listens", "scheduler" if own else "worker", address.split(":")[0])
if what != "stop":
    open(go, "w").close()
print("exit", process.wait())
wait_for(lambda: not any(is_alive(pid) for pid, _ in programs), 10)
print("attempts:", len(waiting()))
print("programs left:", sum(is_alive(pid) for pid, _ in programs))
