"""Faults of the machine that leonavd runs on: disks, memory, clock, network, processes, configuration."""
import fcntl
import math
import os
import re
import signal
import subprocess
import threading
import time

from service_faults import disks, said, stream
from service_faults.datagrams import FRAGMENT
from service_faults.drive import IMU, PREFIX
from service_faults.recorded import FILTER, SMOOTHER
from service_faults.process_status import status_kb
from service_faults.row import ALIGNING_CHANGES, Expected, Row, fault
from service_faults.run import ROUTE
from service_faults.witness import Witness

ANY = "."


def kill_and_start(run):
    run.daemon.process.send_signal(signal.SIGKILL)
    run.daemon.codes.append(run.daemon.process.wait())
    run.daemon.start(wait=False)


def first_answers(run, outputs, result):
    """From when the second one listens on: the first SOLUTION, the first HEALTH without FAULT, the errors of the first 5 s."""
    listens = next((t for t, line in said.lines_of(run.daemon.said(), run.begin_wall_s) if line.startswith("running; LCM")), math.inf)
    solution = outputs.first_after(listens)
    health = next((one.t for one in outputs.health if one.t >= listens and one.status != "FAULT"), math.inf)
    error, sigma, _, sigmas = outputs.worst(solution, solution + 5)
    run.notes.append(f"listens after {listens - run.row.begin_s:.1f} s, first SOLUTION {solution - listens:.1f} s later, HEALTH without "
                     f"FAULT {health - listens:.1f} s later; first 5 s: {error:.2f} m ({sigma:.2f}), {sigmas:.1f} sigmas")
    result.at_most("listens", listens - run.row.begin_s, 5)
    result.at_most("first SOLUTION after it listens", solution - listens, 2)
    result.at_most("HEALTH without FAULT after it listens", health - listens, 3)
    result.at_most("error / sigma of the first 5 s", sigmas, 5, "")


def start_second(run):
    run.second = subprocess.Popen([str(word) for word in run.daemon.command()], stderr=subprocess.PIPE, text=True)
    run.second_s = time.monotonic()

    def wait():
        run.second_text = run.second.communicate()[1]
        run.second_s = time.monotonic() - run.second_s
    run.second_thread = threading.Thread(target=wait, daemon=True)
    run.second_thread.start()


def second_is_refused(run, outputs, result):
    run.second_thread.join(timeout=1)
    code = run.second.poll()
    result.must(code == 4, f"exit code of the second {code}")
    if code is None:
        run.second.kill()
        return
    result.at_most("the second ends", run.second_s, 5)
    result.must("another leonavd" in run.second_text, f"the second said: {run.second_text.strip()[-200:]}")
    run.notes.append(f"exit code {code} after {run.second_s:.1f} s")


SMOOTHER_FAILED = 16  # kind of event; its code is what failed
SINGULAR, DIVERGED = 3, 4


def no_worse_than_filter(run, outputs, result):
    """The filter's errors are those of its own answers at the epochs."""
    row, end = run.row, run.last_s - 1
    worst = outputs.worst(max(row.begin_s, row.settled_s), end)[0]
    filter_m = max((one.error for one in outputs.epochs_within(max(row.begin_s, row.settled_s), end)), default=math.nan)
    run.notes.append(f"worst error {worst:.2f} m, of the filter {filter_m:.2f} m")
    # Between epochs the inertial answer moves away from the filter's by centimetres.
    result.must(worst <= filter_m + 0.1, f"worst error {worst:.2f} m, of the filter {filter_m:.2f} m")


def fails_once(run, outputs, result):
    begin = run.row.begin_s
    result.at_most("event `smoother_failed`", run.note_event(outputs, SMOOTHER_FAILED, (DIVERGED,), "smoother_failed"), 5)
    result.must(outputs.share_of(SMOOTHER, begin - 10, begin) == 1, "the smoother does not answer before")
    result.must(outputs.share_of(FILTER, begin, begin + 5) > 0, "the filter does not answer")
    result.must(outputs.share_of(SMOOTHER, run.last_s - 10, run.last_s - 1) == 1, "the smoother does not answer at the end")
    no_worse_than_filter(run, outputs, result)


def never_answers(run, outputs, result):
    result.at_most("event `smoother_failed`", run.note_event(outputs, SMOOTHER_FAILED, (SINGULAR,), "smoother_failed"), 5)
    result.must(outputs.share_of(FILTER, run.row.settled_s, run.last_s - 1) == 1, "not all is the filter's")
    no_worse_than_filter(run, outputs, result)


def delete_route(run):
    subprocess.run(["ip", "route", "del", "224.0.0.0/4"], check=True)


def restore_route(run):
    subprocess.run(ROUTE, check=True)


def damage_checkpoints(run):
    run.folder.joinpath("checkpoint.yaml").write_bytes(b"leonav: [\x00\xff, {position:\n" * 40)
    run.folder.joinpath("checkpoint.yaml.products").write_bytes(b"\xed\xa1\xda\x01" + bytes(range(256)) * 40)


def damage_is_told(run, outputs, result):
    for words in ("checkpoint ignored", "broadcast products ignored"):
        line = run.daemon.has_said(words)
        result.must(line, f"leonavd did not say '{words}'")
        result.must(not line or "warn" in line, f"no warning: {line}")


def stop_under_load(run):
    def stop():
        run.stopped = run.daemon.stop()
    run.stopper = threading.Thread(target=stop, daemon=True)
    run.stopper.start()


def stops_in_time(run, outputs, result):
    run.stopper.join(timeout=30)
    took, code = run.stopped
    run.notes.append(f"exit code {code} after {took:.1f} s")
    result.at_most("end after SIGTERM", took, 5)


def starts_and_ends(run, limit_s, memory_mb=None):
    """(what came of it, exit code, s, what it said) of a leonavd that should end by itself, or run and end after SIGTERM."""
    daemon = run.make_daemon(memory_mb=memory_mb)
    daemon.starts = run.starts
    daemon.start(wait=False)
    run.starts += 1
    begin = time.monotonic()
    runs = False
    while time.monotonic() < begin + limit_s and daemon.process.poll() is None and not runs:
        time.sleep(0.02)
        runs = "running; LCM" in daemon.said()
    took, code = time.monotonic() - begin, daemon.process.poll()
    what = f"exit code {code}"
    if runs:
        code = daemon.stop(limit_s)[1]
        what = {0: "runs", None: "runs and cannot be ended"}.get(code, f"runs, exit code {code} after SIGTERM")
    elif code is None:
        code = daemon.stop(limit_s)[1]
        what = "neither runs nor ends" + (", SIGTERM does not end it either" if code is None else f"; exit code {code} after SIGTERM")
    daemon.kill()
    return what, code, took, daemon.said()


def no_route(run, result):
    _, code, took, text = starts_and_ends(run, 10)
    result.must(code == 4, f"exit code {code}")
    result.at_most("it ends", took, 5)
    result.must("ip route add 224.0.0.0/4 dev lo" in text, f"no remedy: {text.strip()[-200:]}")
    run.notes.append(f"exit code {code} after {took:.1f} s")


def comma(run, result):
    config = run.folder / "comma.yaml"
    config.write_text(", preset: urban\nvehicle:\n  kind: car\n")
    daemon = run.make_daemon()
    begin = time.monotonic()
    command = f"ulimit -v {2 << 20}; exec {daemon.bin}/leonavd --config {config}"
    try:
        done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False, timeout=30)
        code, text = done.returncode, done.stderr
    except subprocess.TimeoutExpired:
        code, text = None, "it did not end within 30 s"
    took = time.monotonic() - begin
    result.must(code == 3, f"exit code {code}: {text.strip()[-200:]}")
    result.at_most("it ends", took, 5)
    result.must("comma.yaml" in text, f"the file is not named: {text.strip()[-200:]}")
    run.notes.append(f"exit code {code} after {took:.1f} s: `{text.strip().split('error: ')[-1].replace(f'{run.folder}/', '')}`")


MEMORY_MB = (16, 32, 64, 96, 128, 192, 256, 384, 512, 1024)


def little_memory(run, result):
    words = []
    for memory in MEMORY_MB:
        what, code, _, text = starts_and_ends(run, 10, memory)
        words.append(f"{memory} MB: {what}")
        if what == "runs":
            continue
        last = (text.strip().splitlines() or ["nothing"])[-1][-100:]
        is_clear = what == f"exit code {code}" and code in (1, 3, 4, 5, 127) and re.search("memory|alloc|thread|map", text)
        result.must(is_clear, f"{memory} MB: {what}; it said: {last}")
    result.must(words[-1].endswith("runs"), f"{words[-1]}")
    run.notes.append(", ".join(words))


FAKETIME = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1"


def faketime_library():
    return next((str(path) for path in (FAKETIME, FAKETIME.replace("x86_64", "aarch64")) if os.path.exists(path)), None)


def why_no_faketime():
    return "" if faketime_library() else "the library libfaketime is missing (Debian: faketime); a time namespace has no clock of day"


def clock_file(run):
    return run.folder / "clock.txt"


def fake_clock(run):
    clock_file(run).write_text("+0\n")
    run.row.daemon["environment"] = {
        "LD_PRELOAD": faketime_library(), "FAKETIME_TIMESTAMP_FILE": str(clock_file(run)), "FAKETIME_NO_CACHE": "1",
        "FAKETIME_DONT_FAKE_MONOTONIC": "1", "DONT_FAKE_MONOTONIC": "1"}


def step_clock(run):
    clock_file(run).write_text("+3600\n")


def clock_has_stepped(run, outputs, result):
    """Else the row would show nothing."""
    times = [t for t, _ in said.lines_of(run.daemon.said(), run.begin_wall_s)]
    stepped = any(3500 <= b - a <= 3800 for a, b in zip(times, times[1:]))
    run.notes.append("its log has stepped by an hour" if stepped else "its log has not stepped")
    result.must(stepped, "the clock did not step")


def mapped_kb(run):
    """Resident memory by what is mapped."""
    sums, name = {}, ""
    with open(f"/proc/{run.daemon.process.pid}/smaps", encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if re.match(r"[0-9a-f]+-[0-9a-f]+ ", line):
                name = "blocks and stacks" if len(words) < 6 else words[5].strip("[]").rsplit("/", 1)[-1]
            elif words[0] == "Rss:":
                sums[name] = sums.get(name, 0) + int(words[1])
    return sorted(sums.items(), key=lambda one: -one[1])


def measure_memory(run):
    status = {name: status_kb(run.daemon.process.pid, name) for name in ("VmRSS", "VmHWM", "VmPeak", "VmLck")}
    run.memory = getattr(run, "memory", []) + [(status, mapped_kb(run))]


MOST_RESIDENT_MB, MOST_GROWTH_KB = 64, 1024


def memory_is_small(run, outputs, result):
    (first, _), (last, mapped) = run.memory[0], run.memory[-1]
    result.at_most("resident", last["VmRSS"] / 1024, MOST_RESIDENT_MB, "MB")
    result.at_most("grown", last["VmRSS"] - first["VmRSS"], MOST_GROWTH_KB, "kB")
    if last["VmLck"] == 0:
        run.notes.append("the system locks no memory here")
    words = [f"{name} {kb / 1024:.1f}" for name, kb in mapped[:8]]
    run.notes.append(f"resident {first['VmRSS'] / 1024:.1f} MB at the start, {last['VmRSS'] / 1024:.1f} MB after a minute, locked "
                     f"{last['VmLck'] / 1024:.1f} MB; " + ", ".join(words))


LONG_BYTES, LONG_ONES = 2**28 - 1, 200
NAMES, FRAGMENT_BYTES, FRAGMENTS = 100_000, 30_000, 2000
LEAST_ARRIVE = 0.5  # of what is sent; a busy machine sees less than leonavd does


def begin_long_message(run):
    run.sender.begin(IMU, LONG_BYTES)


def kind_of(datagram):
    """What of these faults a datagram is."""
    if datagram[:4] == b"LC03":
        return {LONG_BYTES: "long", FRAGMENT_BYTES: "fragment"}.get(FRAGMENT.unpack_from(datagram)[2])
    return "name" if re.match(rb"(LEONAV|NEW)_\d{6}\0", datagram[8:24]) else None


def watch_network(run):
    run.witness = Witness(kind_of)


def count_arrived(run):
    run.arrived = run.witness.stop()


def arrives(sent, run, result):
    """Else the row would show nothing."""
    for kind, count in sent.items():
        result.must(run.arrived.get(kind, 0) >= LEAST_ARRIVE * count, f"{run.arrived.get(kind, 0)} of {count} datagrams ({kind}) came to a socket")
    run.notes.append(", ".join(f"{run.arrived.get(kind, 0)} of {count} ({kind})" for kind, count in sent.items()) +
                     " came to another socket beside leonavd's")


def long_messages_cost_nothing(run, outputs, result):
    arrives({"long": LONG_ONES}, run, result)
    not_grown(run, outputs, result)


def names_cost_nothing(run, outputs, result):
    arrives({"name": NAMES, "fragment": FRAGMENTS}, run, result)
    not_grown(run, outputs, result)


def send_fragments(run):
    """The begin of a message on a channel that nobody has, and the middle of another one."""
    run.sender.begin(f"{PREFIX}FRAGMENT_{run.sender.number}", FRAGMENT_BYTES)
    run.sender.go_on(FRAGMENT_BYTES)


def not_grown(run, outputs, result):
    (first, _), (last, _) = run.memory
    grown = last["VmHWM"] - first["VmRSS"]
    result.at_most("grown", grown, MOST_GROWTH_KB, "kB")
    # Memory that is taken and not touched counts here, where the system locks none.
    result.at_most("addresses grown", last["VmPeak"] - first["VmPeak"], MOST_GROWTH_KB, "kB")
    run.notes.append(f"resident {first['VmRSS'] / 1024:.1f} MiB before it, {grown} kB more at most")


# Of each a burst every tenth of a second, of which nothing can be read, nearly as long as the channel allows
# (drivers/lcm/message_sizes.h): 60 MB a second.
FLOOD = {name: os.urandom(size) for name, size in (("GNSS_EPOCH", 23_000), ("ORBIT_CLOCK", 23_000), ("CORRECTED_STATES", 15_000), ("BIASES", 60_000))}
FLOOD_BURST, FLOODS = 50, 200
MOST_FLOOD_KB = 64 * 1024  # what waits, and what liblcm's buffer has too much while it grows


def flood(run):
    for channel, data in FLOOD.items():
        for _ in range(FLOOD_BURST):
            run.sender.send(PREFIX + channel, data)


def flood_is_bounded(run, outputs, result):
    (first, _), (last, _) = run.memory
    grown = last["VmHWM"] - first["VmRSS"]
    result.at_most("grown", grown, MOST_FLOOD_KB, "kB")
    run.notes.append(f"resident {first['VmRSS'] / 1024:.1f} MiB before it, {grown} kB more at most")


def reload(run):
    run.daemon.process.send_signal(signal.SIGHUP)


def reload_is_told(run, outputs, result):
    result.must(run.daemon.has_said("SIGHUP: .* read again, nothing has changed"), "leonavd did not say that it has read its configuration")


PIPE_BYTES = 4096
# Each reload of a configuration with so long a mistake is a line as long: all together six times what the daemon keeps. It ends one a
# second, and what is asked for meanwhile is one more.
RELOADS, MISTAKE_BYTES = 200, 15_000
GOOD = "preset: urban\n"


def put_file(path, text):
    """At once, so that no reader sees half of it."""
    path.with_suffix(".new").write_text(text)
    path.with_suffix(".new").replace(path)


def write_config(run):
    run.config = run.row.daemon["config"] = run.folder / "config.yaml"
    run.pipe = run.folder / "ocean.blq"
    run.pipe.unlink(missing_ok=True)
    put_file(run.config, GOOD)


def reload_from_pipe(run):
    """A pipe that nobody writes to stands for the disk: reading stops in the system as it does there. A frozen file system would not do,
    because it is read all the same."""
    os.mkfifo(run.pipe)
    put_file(run.config, f"{GOOD}gnss: {{ocean_loading_file: {run.pipe}}}\n")
    reload(run)


def answer_from_pipe(run):
    """With a file that says nothing. The configuration is good again for the reload behind it."""
    put_file(run.config, GOOD)
    with open(run.pipe, "w", encoding="utf-8") as pipe:
        pipe.write("$$\n")


def reload_waits_alone(run, outputs, result):
    """HEALTH once a second all the time; the log says that the disk does not answer, and then what became of both reloads."""
    lines = list(said.lines_of(run.daemon.said(), run.begin_wall_s))

    def told(pattern):
        return next((t for t, line in lines if t >= run.row.begin_s and re.search(pattern, line)), math.inf)
    result.at_most("leonavd says that the disk does not answer", told("SIGHUP: the disk .* does not answer") - run.row.begin_s, 5)
    result.at_most("leonavd says what it has read", told("nothing is changed: .*ocean.blq") - run.row.end_s, 2.5)
    result.must(told("nothing is changed: ") >= run.row.end_s, "the pipe did not hold the reload up")
    result.at_most("the reload behind it", told("read again, nothing has changed") - run.row.end_s, 5)
    gap = outputs.longest_health_gap(run.row.begin_s, run.row.end_s)
    result.at_most("longest time without HEALTH while the disk does not answer", gap, 1.5)
    run.notes.append(f"at most {gap:.2f} s between two HEALTH while the disk does not answer")


class LogPipe:
    """leonavd's standard error goes through a small pipe to a thread that writes its text file, and can stop reading."""

    def __init__(self, run):
        self.run, self.reads, self.is_over = run, threading.Event(), False
        self.reads.set()
        programs, fifo = run.folder / "bin", run.folder / "log.fifo"
        programs.mkdir(exist_ok=True)
        for old in (fifo, *programs.iterdir()):
            old.unlink(missing_ok=True)
        os.mkfifo(fifo)
        self.end = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
        fcntl.fcntl(self.end, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
        for program in run.bin.iterdir():
            if program.name != "leonavd":
                programs.joinpath(program.name).symlink_to(program)
        script = programs / "leonavd"
        script.write_text(f"#!/bin/sh\nexec {run.bin}/leonavd \"$@\" 2>{fifo}\n")
        script.chmod(0o755)
        run.bin = programs
        self.thread = threading.Thread(target=self.copy, daemon=True)
        self.thread.start()

    def copy(self):
        while not self.is_over:
            self.reads.wait()
            try:
                part = os.read(self.end, PIPE_BYTES)
            except BlockingIOError:
                part = b""
            if part:
                with open(self.run.daemon.text_file(), "ab") as text:
                    text.write(part)
            else:
                time.sleep(0.005)


def open_log_pipe(run):
    run.log = LogPipe(run)
    write_config(run)


def stall_log(run):
    run.log.reads.clear()
    put_file(run.config, f"{GOOD}log: {{level: {'x' * MISTAKE_BYTES}}}\n")


def read_log_again(run):
    run.log.reads.set()
    put_file(run.config, GOOD)


def close_log_pipe(run):
    run.log.reads.set()
    time.sleep(0.1)  # the last lines
    run.log.is_over = True
    run.log.thread.join(timeout=5)


def health_goes_on(run, outputs, result):
    """HEALTH once a second all the time; afterwards the log says what it lost, and goes on to its end."""
    times = [one.t for one in outputs.health if one.t >= run.row.begin_s]
    gap = max((b - a for a, b in zip(times, times[1:])), default=math.inf)
    result.at_most("longest time without HEALTH", gap, 1.5)
    lost = re.search(r"warning: log: (\d+) lines? lost", run.daemon.said())
    result.must(lost, "the log did not say how many lines are lost")
    result.must(run.daemon.has_said("read again, nothing has changed"), "the log has no line of a reload after it")
    result.must(run.daemon.has_said("stopped; "), "the log does not go on to its end")
    run.notes.append(f"at most {gap:.1f} s between two HEALTH, {lost[1] if lost else 'no'} lines lost")


def much_junk(row, messages):
    return stream.junk(row.begin_s, row.duration_s, 10)(messages)



ROWS = [
    Row("disk-full", "journal's disk full for 20 s", end_s=80, after_s=40, daemon={"journal_folder": "disk"}, skipped=disks.why_no_tmpfs,
        before=disks.mount_tmpfs, actions=((60, disks.fill), (80, disks.free)),
        expected=fault("FAULT", reason="journal", ok_s=20), quick=True),
    Row("disk-stalled", "journal's disk does not answer for 30 s", end_s=90, after_s=40, daemon={"journal_folder": "disk"},
        skipped=disks.why_no_freeze, before=disks.mount_loop, actions=((60, disks.freeze), (90, disks.thaw)), after=disks.thaw,
        expected=fault("DEGRADED", reason="the disk does not answer", told_s=10, ok_s=15)),
    Row("folder-removed", "journal's folder removed, and made again after 30 s", end_s=90, after_s=40,
        actions=((60, disks.remove), (90, disks.make_again)), journals=disks.pieces_of_both,
        expected=fault("DEGRADED", "FAULT", reason="journal", told_s=10, ok_s=20)),
    Row("kill-restart", "kill -9 in motion, started at once, no orbits sent again", begin_s=145, end_s=145, after_s=100,
        knows_heading=False, change=lambda row, messages: stream.products_stop(row.begin_s)(messages),
        actions=((145, kill_and_start),), judge=first_answers,
        expected=fault("DEGRADED", "FAULT", reason="no solution yet|aligning", gap_s=7, worst_m=6, ok_s=90, back_s=7, exit_codes=(-9, 0),
                       health_changes=ALIGNING_CHANGES)),
    Row("second-instance", "a second leonavd on the same channels", after_s=20, actions=((60, start_second),), judge=second_is_refused,
        expected=Expected(), quick=True),
    Row("no-route", "no multicast route at the start", has_route=False, check=no_route, quick=True),
    Row("route-removed", "multicast route removed for 15 s", end_s=75, after_s=100, actions=((60, delete_route), (75, restore_route)),
        loses_route=True, health_by_log=True,
        expected=fault("DEGRADED", "FAULT", reason=r"no usable IMU \(nothing comes", gap_s=18, ok_s=90, back_s=3, worst_m=8, health_changes=12)),
    Row("host-clock", "host clock steps by an hour", after_s=40, skipped=why_no_faketime, before=fake_clock, actions=((60, step_clock),),
        judge=clock_has_stepped, expected=Expected()),
    Row("smoother-late", "smoother late at every third epoch (drill)", begin_s=0, end_s=120, after_s=0,
        options=("--set", "drill.late_solve_every=3"),
        expected=fault("DEGRADED", reason="smoother late", told_s=60, stays=True, ok_s=None, back_s=None)),
    # Of the epochs of this drive the 60th alone is one of them.
    Row("smoother-fails", "one solve of the smoother diverges (drill)", begin_s=59, end_s=60, after_s=50, judge=fails_once,
        options=("--set", "smoother.drill_failure_every=60", "--set", "smoother.drill_failure=diverged"),
        expected=fault("DEGRADED", reason="smoother failed", ok_s=10)),
    Row("smoother-never-answers", "every solve of the smoother is singular (drill)", begin_s=0, end_s=120, after_s=0, judge=never_answers,
        options=("--set", "smoother.drill_failure_every=1"),
        expected=fault("DEGRADED", reason="smoother failed", told_s=30, stays=True, ok_s=None, back_s=None)),
    Row("comma", "configuration begins with a comma, 2 GB of memory", check=comma, quick=True),
    Row("checkpoint-damaged", "checkpoint and ephemerides are junk at the start", begin_s=0, end_s=0, after_s=60, before=damage_checkpoints,
        judge=damage_is_told, expected=Expected(allowed=ANY, ok_s=45, back_s=10), quick=True),
    Row("memory", "none: what is resident, everything locked", begin_s=5, end_s=65, after_s=5,
        actions=((5, measure_memory), (65, measure_memory)), judge=memory_is_small, expected=Expected(allowed=ANY)),
    Row("fragments", "ten datagrams a second that each begin a message of 256 MB, for 20 s", end_s=80, after_s=20,
        actions=((59.5, measure_memory), *((60 + k / 10, begin_long_message) for k in range(LONG_ONES)), (81, measure_memory)),
        before=watch_network, after=count_arrived, judge=long_messages_cost_nothing, expected=Expected(), quick=True),
    Row("new-names", f"{NAMES:,} messages on as many channels, for 40 s", end_s=100, after_s=20,
        change=lambda row, messages: stream.new_names(row.begin_s, row.end_s, NAMES)(messages),
        actions=((59.5, measure_memory), *((60 + k * 40 / (FRAGMENTS // 2), send_fragments) for k in range(FRAGMENTS // 2)), (101, measure_memory)),
        before=watch_network, after=count_arrived, judge=names_cost_nothing, expected=Expected()),
    Row("flood", f"{len(FLOOD) * FLOOD_BURST * 10:,} messages of 15 to 60 kB a second that nobody can read, for 20 s", end_s=80, after_s=30,
        actions=((59.5, measure_memory), *((60 + k / 10, flood) for k in range(FLOODS)), (81, measure_memory)), judge=flood_is_bounded,
        expected=fault("DEGRADED", reason="a tenth or more of an input is rejected", ok_s=20)),
    Row("reload", "SIGHUP", after_s=20, actions=((60, reload),), judge=reload_is_told, expected=Expected()),
    Row("reload-stalled", "SIGHUP three times while a file of the configuration does not answer for 30 s", end_s=90, after_s=15,
        before=write_config, actions=((60, reload_from_pipe), (65, reload), (70, reload), (90, answer_from_pipe)),
        judge=reload_waits_alone, expected=Expected()),
    Row("log-stalled", "nobody reads the log for 30 s, and it gets more lines than the daemon keeps", end_s=90, after_s=15, before=open_log_pipe,
        actions=((60, stall_log), *((60 + k * 28 / RELOADS, reload) for k in range(RELOADS)), (90, read_log_again), (95, reload)),
        after=close_log_pipe,
        judge=health_goes_on, expected=Expected(), quick=True),
    Row("little-memory", "memory limited to " + ", ".join(map(str, MEMORY_MB)) + " MB", check=little_memory),
    Row("sigterm-under-load", "SIGTERM after 20 s of junk at ten times the nominal rate", begin_s=40, after_s=30, until_stopped=True,
        change=much_junk, actions=((60, stop_under_load),), judge=stops_in_time,
        expected=fault("DEGRADED", reason="a tenth or more of an input is rejected", ok_s=None, gap_s=None, back_s=None,
                       health_changes=8), quick=True),
]
