#!/usr/bin/env python3
"""live_test.py BIN_DIR WORK_DIR: leonav-connect from pseudo-terminals to LCM, against leonav-import of the same bytes.

A simulated drive leaves as UBX on one pseudo-terminal and as VectorNav binary on another, with noise between the messages.
What leonav-connect publishes must be what leonav-import writes: GNSS messages to the last bit, IMU samples within the
sensor's 32-bit numbers. LCM is UDP, and the logger loses messages where the machine is busy: how many were published is
what the program says, and messages are compared by their sequence. Its recordings, played as files, must give the same once more. Then a sensor without GPS time,
with a clock that drifts, must be stamped by arrivals within what its sigma says, and an Xsens sensor whose pulses the receiver
sees within what its clock shows. Antenna models, biases and elements of LEO satellites in files must come as the import has
them, and the antenna's must move the solution of leonav-replay by what they say. Runs in a network namespace of its own;
exit 77: none can be made here.
"""
import bisect
import pathlib
import random
import re
import signal
import struct
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path += [str(HERE), str(HERE.parent), str(ROOT / "test/oracle"), str(ROOT / "test/support/python"), str(ROOT / "tools/scripts/lib")]
import lcm_log  # noqa: E402
import ubx_bytes  # noqa: E402
import vectornav_bytes  # noqa: E402
import xsens  # noqa: E402
from live_program import enter_namespace, fail  # noqa: E402
from serial_terminal import SerialTerminal  # noqa: E402

SPEED = 4.0
RAISED_M = 3.0
IMU = struct.Struct(">qqqiq6d")  # fingerprint, time, sequence, schema, interval, increments


class Run:
    """leonav-connect with a logger beside it."""

    def __init__(self, work, name, config):
        self.log, self.text = work / f"{name}.lcmlog", work / f"{name}.txt"
        (work / f"{name}.yaml").write_text(config)
        self.logger = subprocess.Popen(["lcm-logger", "--lcm-url=udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304", str(self.log)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1)
        with open(self.text, "w", encoding="utf-8") as text:
            self.process = subprocess.Popen([BIN / "leonav-connect", work / f"{name}.yaml"], stderr=text)

    def says(self, words, times=1):
        for _ in range(600):
            if self.text.read_text(encoding="utf-8").count(words) >= times:
                return
            if self.process.poll() is not None:
                break
            time.sleep(0.1)
        print(self.text.read_text(encoding="utf-8"))
        fail(f"leonav-connect did not say '{words}'")

    def finish(self, stop):
        if stop:
            self.process.send_signal(signal.SIGTERM)
        status = self.process.wait(timeout=120)
        time.sleep(1)
        self.logger.send_signal(signal.SIGTERM)
        self.logger.wait(timeout=20)
        print(self.text.read_text(encoding="utf-8"))
        if status != 0:
            fail(f"leonav-connect ended with {status}")
        text = self.text.read_text(encoding="utf-8")
        self.published = {name: int(count) for name, count in re.findall(r"(\w+): \w+, \d+ bytes, (\d+) messages", text)}
        return channels(self.log)


def channels(path):
    """{channel: {sequence: message}}"""
    found = {}
    for _, channel, payload in lcm_log.messages(path):
        found.setdefault(channel, {})[struct.unpack_from(">q", payload, 16)[0]] = payload
    return found


def check_loss(what, published, wanted, captured):
    if published != wanted:
        fail(f"{what}: {published} messages were published, not {wanted}")
    if captured < 0.1 * wanted:
        fail(f"{what}: the logger has only {captured} of {wanted} messages; is the machine overloaded?")


def same_gnss(expected, run, found, where):
    names = ("LEONAV_GNSS_EPOCH", "LEONAV_EPHEMERIS", "LEONAV_IONOSPHERE")
    check_loss(f"{where}: GNSS", run.published["receiver"], sum(len(expected[name]) for name in names),
               sum(len(found.get(name, {})) for name in names))
    for name in names:
        got = found.get(name, {})
        wrong = [sequence for sequence, payload in got.items() if expected[name].get(sequence) != payload]
        if wrong:
            fail(f"{where}: {name}: messages {wrong[:5]} differ from those of the import")
        print(f"{where}: {name}: {len(got)} messages of {len(expected[name])}, equal to the last bit")


def same_imu(expected, run, found, where):
    """The sensor's numbers have 24 bits; the first sample of the file has no interval on the wire."""
    wanted = {sequence - 1: IMU.unpack(payload) for sequence, payload in expected["LEONAV_IMU"].items() if sequence > 1}
    got = {sequence: IMU.unpack(payload) for sequence, payload in found.get("LEONAV_IMU", {}).items()}
    check_loss(f"{where}: IMU", run.published["imu"], len(wanted), len(got))
    worst = 0.0
    for sequence, b in got.items():
        a = wanted[sequence]
        if a[1] != b[1] or a[4] != b[4]:
            fail(f"{where}: a sample at {b[1]} over {b[4]} ns instead of {a[1]}, {a[4]}")
        worst = max(worst, *(abs(x - y) / max(abs(x), 1e-9) for x, y in zip(a[5:], b[5:])))
    if worst > 3e-7:
        fail(f"{where}: increments differ by {worst:.1e} of themselves")
    print(f"{where}: LEONAV_IMU: {len(got)} samples of {len(wanted)}, stamps equal, increments within {worst:.1e} of themselves")


def simulate(work):
    """Exports a short drive; returns (GPS time in ns, bytes) of every message of receiver and sensor, and the import's log."""
    subprocess.run([BIN / "leonav-sim", ROOT / "config/scenario/open_sky.yaml", "--set", "duration_s=40", "--set", "route.standing_s=5", "--set", "satellites.leo.told=both",
                    "--export", work / "export", "-o", work / "run.lcmlog"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    locks, receiver, waiting = {}, [], None
    for instant, satellites in ubx_bytes.epochs(work / "export/run.obs"):
        if waiting is None:
            waiting = sorted(ubx_bytes.broadcasts(work / "export/run.nav", instant[0]))
        data = ubx_bytes.rawx(instant, satellites, locks)
        while waiting and waiting[0][0] <= instant[0]:
            data += waiting.pop(0)[1]
        receiver.append((round((instant[0] + instant[1]) * 1e9), data))
    (work / "receiver.ubx").write_bytes(b"".join(data for _, data in receiver))
    (work / "dataset.yaml").write_text("observations: receiver.ubx\nimu: export/imu.csv\n")
    subprocess.run([BIN / "leonav-import", work / "dataset.yaml", "-o", work / "import.lcmlog"], check=True, stdout=subprocess.DEVNULL)
    return receiver, channels(work / "import.lcmlog")


def play(terminal, messages, noise, first_ns):
    """At SPEED, with bytes of nobody between the messages."""
    begin = time.monotonic()
    for time_ns, data in messages:
        wait = (time_ns - first_ns) * 1e-9 / SPEED - (time.monotonic() - begin)
        if wait > 0:
            time.sleep(wait)
        terminal.send(noise() + data)


def live(work, receiver, sensor, expected):
    gnss, imu = SerialTerminal(), SerialTerminal()
    run = Run(work, "live", f"""
streams:
  - {{name: receiver, source: serial, device: {gnss.name}, baud: 460800, format: ubx, repeat_ephemerides_s: 0, record: receiver.leoraw}}
  - {{name: imu, source: serial, device: {imu.name}, baud: 921600, format: vectornav, record: imu.leoraw}}
""")
    run.says("is open", 2)
    first_ns = min(receiver[0][0], sensor[0][0])
    dice = random.Random(1)
    sentence = b"$GNTXT,01,01,02,noise*2D\r\n"
    junk = lambda: dice.choice([b"", b"", b"", sentence, b"\xb5\x62\x02\x15", b"\xfa\x01", dice.randbytes(7).replace(b"\xb5", b"").replace(b"\xfa", b"")])
    # A false start may hold a message back until more bytes have come: nothing may be lost by it.
    threads = [threading.Thread(target=play, args=(gnss, receiver, junk, first_ns)),
               threading.Thread(target=play, args=(imu, sensor, lambda: junk() if dice.random() < 0.05 else b"", first_ns))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for terminal in (gnss, imu):
        terminal.send(bytes(12000))  # releases what a false start holds back
    time.sleep(2)
    found = run.finish(stop=True)
    same_gnss(expected, run, found, "live")
    same_imu(expected, run, found, "live")
    if "LEONAV_STREAMS" not in found:
        fail("no status was published")


def played_again(work, expected):
    run = Run(work, "again", """
playback_speed: 1
streams:
  - {name: receiver, source: file, path: receiver.leoraw, format: ubx, repeat_ephemerides_s: 0}
  - {name: imu, source: file, path: imu.leoraw, format: vectornav}
""")
    found = run.finish(stop=False)
    same_gnss(expected, run, found, "recordings")
    same_imu(expected, run, found, "recordings")


def antenna_file(path):
    """Models of a satellite and of a receiver's antenna that is RAISED_M above its reference point."""
    label = lambda text, what: f"{text:<60}{what}\n"
    antenna = lambda name, up_m: (
        label("", "START OF ANTENNA") + label(name, "TYPE / SERIAL NO") + label("     0.0", "DAZI") + label("     0.0   1.0   1.0", "ZEN1 / ZEN2 / DZEN") +
        "".join(label("   " + band, "START OF FREQUENCY") + label(f"{0:10.2f}{0:10.2f}{1e3 * up_m:10.2f}", "NORTH / EAST / UP") +
                "   NOAZI    0.00    0.00\n" + label("   " + band, "END OF FREQUENCY") for band in ("G01", "G02")) + label("", "END OF ANTENNA"))
    path.write_text(label("     1.4            M", "ANTEX VERSION / SYST") + label("A", "PCV TYPE / REFANT") + label("", "END OF HEADER") +
                    antenna(f"{'BLOCK IIF':<20}{'G05':<20}{'G063':<10}{'2011-036A'}", 1.25) + antenna("TRM59800.00     NONE", RAISED_M))


def bias_file(path):
    record = lambda prn, code, value: f" OSB       {prn:<3}           {code:<4}      2000:001:00000 2090:001:00000 ns   {value:21.4f} {0.01:11.4f}\n"
    path.write_text("%=BIA 1.00 TST 2024:127:00000 TST 2000:001:00000 2090:001:00000 A 00000002\n+BIAS/DESCRIPTION\n TIME_SYSTEM  G\n"
                    "-BIAS/DESCRIPTION\n+BIAS/SOLUTION\n" + record("G05", "C1C", 1.5) + record("E11", "C5Q", -2.5) + "-BIAS/SOLUTION\n%=ENDBIA\n")


def without_antennas(work, log):
    """The same log without its ANTENNA messages."""
    stripped = work / f"{log.stem}_stripped.lcmlog"
    lcm_log.write(stripped, (one for one in lcm_log.messages(log) if one[1] != "LEONAV_ANTENNA"))
    return stripped


def heights(work, log):
    """{time: height} of leonav-replay without IMU."""
    out = work / f"{log.stem}_result"
    subprocess.run([BIN / "leonav-replay", "--preset", "demo", "--set", "ekf.motion=constant_velocity", log, "--out", out], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    lines = [line.split(",") for line in (out / "solution.csv").read_text().splitlines()]
    time_column, height_column = lines[0].index("gps_tow_s"), lines[0].index("height_m")
    return {line[time_column]: float(line[height_column]) for line in lines[1:]}


def products_of_files(work):
    """What comes of files live is what an import makes of them, and serves."""
    antenna_file(work / "models.atx")
    bias_file(work / "biases.bia")
    keys = 'antenna_models: models.atx\n{0}receiver_antenna: TRM59800.00     NONE\n{0}biases: biases.bia\n'
    (work / "products.yaml").write_text("observations: receiver.ubx\nimu: export/imu.csv\nleo_elements: export/leo_elements.csv\n" + keys.format(""))
    subprocess.run([BIN / "leonav-import", work / "products.yaml", "-o", work / "products.lcmlog"], check=True, stdout=subprocess.DEVNULL)
    streams = "streams:\n  - {name: receiver, source: file, path: receiver.leoraw, format: ubx, repeat_ephemerides_s: 5}\n"
    run = Run(work, "files", f"playback_speed: 4\nleo_elements: export/leo_elements.csv\ncorrections:\n  {keys.format('  ')}{streams}")
    found = run.finish(stop=False)
    run.says("2 antenna models of the receiver and 2 of satellites (one for each band), biases of 2 signals")
    plain = Run(work, "no_files", f"playback_speed: 4\n{streams}")
    if {"LEONAV_ANTENNA", "LEONAV_BIASES"} & set(plain.finish(stop=False)):
        fail("antenna models or biases come without a file")
    expected = channels(work / "products.lcmlog")
    # Each message has the time of its sending, behind which all else must be equal.
    rest = lambda of, name: {payload[24:] for payload in of.get(name, {}).values()}
    antennas = rest(expected, "LEONAV_ANTENNA")
    if len(antennas) != 4 or rest(found, "LEONAV_ANTENNA") != antennas:
        fail(f"{len(rest(found, 'LEONAV_ANTENNA'))} antenna models came live, {len(antennas)} of the import")
    if rest(found, "LEONAV_BIASES") != rest(expected, "LEONAV_BIASES") or not rest(expected, "LEONAV_BIASES"):
        fail("the biases that came live are not those of the import")
    low = lambda of: {payload[24:] for payload in of["LEONAV_EPHEMERIS"].values() if struct.unpack_from(">i", payload, 24)[0] == 2}
    if not low(expected) or low(found) != low(expected):
        fail(f"elements of LEO satellites: {len(low(found))} live, {len(low(expected))} of the import")
    if len(found["LEONAV_ANTENNA"]) < 3 * len(antennas):
        fail("antenna models are not repeated")
    print(f"files: {len(antennas)} antenna models, biases, {len(low(found))} sets of elements, equal to those of the import")
    steps = {}
    for name, log in (("live", run.log), ("import", work / "products.lcmlog")):
        with_models, without = heights(work, log), heights(work, without_antennas(work, log))
        steps[name] = max((time_, without[time_] - with_models[time_]) for time_ in set(with_models) & set(without))[1]
    print("files: the model of an antenna 3 m up lowers the last solution by " + ", ".join(f"{step:.3f} m ({name})" for name, step in steps.items()))
    # Codes are averaged, so that the whole of it does not show in half a minute.
    if not 0.7 * RAISED_M < steps["live"] < 1.1 * RAISED_M or abs(steps["live"] - steps["import"]) > 0.2 * RAISED_M:
        fail("the receiver antenna's model does not serve")


def recording(path, messages, delay):
    """A recording of messages that arrive `delay()` seconds after their time."""
    latest = 0
    with open(path, "wb") as file:
        file.write(b"leonav recording 1\n")
        for time_ns, data in messages:
            latest = max(latest, time_ns + 315964800 * 10**9 - 18 * 10**9 + round(delay() * 1e9))
            file.write(struct.pack("<qI", latest, len(data)) + data)


def own_clock(work, receiver, expected):
    """Latencies of at least 50 ms and 4 ms, with queues behind them; the sensor's clock is 100 ppm fast."""
    dice = random.Random(2)
    sensor = list(vectornav_bytes.messages(work / "export/imu.csv", "startup", 100.0))
    recording(work / "gnss_late.leoraw", receiver, lambda: 0.05 + dice.expovariate(1 / 0.003))
    recording(work / "imu_late.leoraw", sensor, lambda: 0.004 + dice.expovariate(1 / 0.002) + (0.2 if dice.random() < 0.001 else 0.0))
    run = Run(work, "clock", """
playback_speed: 5
streams:
  - {name: receiver, source: file, path: gnss_late.leoraw, format: ubx, repeat_ephemerides_s: 0}
  - {name: imu, source: file, path: imu_late.leoraw, format: vectornav, latency_ms: 4}
""")
    found = run.finish(stop=False)
    same_gnss(expected, run, found, "own clock")
    # Samples are missing at the start only, until both clocks are tied: the last one published is the sensor's last.
    truth = [time_ns for time_ns, _ in sensor]
    missing = len(truth) - run.published["imu"]
    errors = [(IMU.unpack(payload)[1] - truth[missing + sequence - 1]) * 1e-6 for sequence, payload in sorted(found["LEONAV_IMU"].items())]
    late = errors[len(errors) // 2:]
    print(f"own clock: {len(errors)} of {len(truth)} samples; stamps off by {min(errors):.2f} to {max(errors):.2f} ms, "
          f"in the second half by {min(late):.2f} to {max(late):.2f} ms")
    if run.published["imu"] < 0.8 * len(truth) or max(map(abs, late)) > 1.5:
        fail("the sensor's clock is not tied to GPS time")


def time_mark(time_ns):
    """UBX-TIM-TM2 of a rising edge at EXTINT0, in GNSS time."""
    week, tow_ns = divmod(time_ns, 604800 * 10**9)
    return ubx_bytes.frame(0x0D, 0x03, struct.pack("<BBHHHIIIII", 0, 0xC8, 1, week, 0, tow_ns // 10**6, tow_ns % 10**6, 0, 0, 30))


def own_pulses(work, receiver, expected):
    """An Xsens sensor, 100 ppm fast, whose clock shows 0.1 ms and wraps on the way; a pulse at each 200th sample. Its latency is
    configured wrong by 1 ms."""
    dice = random.Random(3)
    sensor = list(xsens.drive(work / "export/imu.csv", 100.0))
    pulses = [time_ns for time_ns, _ in sensor][::200]
    marked, last = [], 0
    for time_ns, data in receiver:
        marked.append((time_ns, b"".join(time_mark(pulse) for pulse in pulses if last < pulse <= time_ns) + data))
        last = time_ns
    recording(work / "gnss_marks.leoraw", marked, lambda: 0.05 + dice.expovariate(1 / 0.003))
    recording(work / "xsens_late.leoraw", sensor, lambda: 0.004 + dice.expovariate(1 / 0.0005))
    run = Run(work, "pulses", """
playback_speed: 5
time:
  pulse: {stream: imu}
streams:
  - {name: receiver, source: file, path: gnss_marks.leoraw, format: ubx, repeat_ephemerides_s: 0}
  - {name: imu, source: file, path: xsens_late.leoraw, format: xsens, latency_ms: 3}
""")
    found = run.finish(stop=False)
    same_gnss(expected, run, found, "pulses")
    wanted = [IMU.unpack(payload) for sequence, payload in sorted(expected["LEONAV_IMU"].items()) if sequence > 1]
    # Those at the start are missing, until both clocks are tied. Each is compared with the sample of the nearest time.
    times = [one[1] for one in wanted]
    errors, worst = [], 0.0
    for _, payload in sorted(found["LEONAV_IMU"].items()):
        got = IMU.unpack(payload)
        index = bisect.bisect_left(times, got[1])
        truth = min(wanted[max(index - 1, 0):index + 1], key=lambda one: abs(one[1] - got[1]))
        errors.append((got[1] - truth[1]) * 1e-6)
        worst = max(worst, *(abs(x - y) for x, y in zip(truth[5:], got[5:])))
    late = errors[len(errors) // 2:]
    print(f"pulses: {run.published['imu']} of {len(wanted)} samples; increments within {worst:.1e}; "
          f"stamps in the second half off by {min(late):.3f} to {max(late):.3f} ms")
    if worst > 1e-9 or run.published["imu"] < 0.7 * len(wanted):
        fail("samples of the Xsens sensor are missing or wrong")
    if max(map(abs, late)) > 0.2:
        fail("the sensor's clock is not tied to GPS time by its pulses")
    if "pulses at the receiver" not in run.text.read_text(encoding="utf-8"):
        fail("leonav-connect does not say that it uses pulses")


def main():
    global BIN
    enter_namespace()
    BIN, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    receiver, expected = simulate(work)
    sensor = list(vectornav_bytes.messages(work / "export/imu.csv", "gps"))
    live(work, receiver, sensor, expected)
    played_again(work, expected)
    products_of_files(work)
    own_clock(work, receiver, expected)
    own_pulses(work, receiver, expected)


if __name__ == "__main__":
    main()
