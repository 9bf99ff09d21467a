"""Measures processor time and latency of leonav-connect and leonavd with a fast receiver and sensor.

  wire_load.py BIN OUT [--duration S] [--rate HZ] [--imu-rate HZ]

Runs inside a network namespace with LCM's multicast route. A latency is from just before the write of a message's last byte
to the pseudo-terminal, to the kernel's time of the LCM datagram that it became. Exit code 1: messages are missing, or a
limit at the end of this file does not hold.
"""
import argparse
import json
import os
import pathlib
import socket
import struct
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "wire"))
import live  # noqa: E402
from drive import Drive  # noqa: E402
from rows import IMU, SERVICE, UBX  # noqa: E402

GROUP, PORT = "239.255.76.67", 7667
SHORT_MAGIC = 0x4C433032
SO_TIMESTAMPNS = 35
SETTLED_S = 10  # what comes before is the start, and not counted
CHANNELS = {b"LEONAV_GNSS_EPOCH": "epoch", b"LEONAV_IMU": "sample"}


class Listener:
    """A process of its own that notes when the kernel got the datagrams of the two channels."""

    def __init__(self, path):
        self.path = path
        self.stop_read, self.stop_write = os.pipe()
        ready_read, ready_write = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            self.listen(ready_write)
            os._exit(0)
        os.read(ready_read, 1)

    def listen(self, ready):
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 23)
        udp.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        udp.bind((GROUP, PORT))
        udp.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP) + socket.inet_aton("127.0.0.1"))
        udp.settimeout(0.2)
        os.set_blocking(self.stop_read, False)
        os.write(ready, b"r")
        found = {"epoch": {}, "sample": {}}
        while True:
            try:
                data, ancillary, _, _ = udp.recvmsg(65535, 64)
            except socket.timeout:
                try:
                    os.read(self.stop_read, 1)
                    break
                except BlockingIOError:
                    continue
            if struct.unpack_from(">I", data)[0] != SHORT_MAGIC:
                continue
            end = data.index(0, 8)
            kind = CHANNELS.get(data[8:end])
            if kind:
                seconds, nanoseconds = struct.unpack("qq", ancillary[0][2])
                found[kind][struct.unpack_from(">q", data, end + 9)[0]] = seconds * 10**9 + nanoseconds
        self.path.write_text(json.dumps(found))

    def result(self):
        os.write(self.stop_write, b"s")
        os.waitpid(self.pid, 0)
        return {kind: {int(key): value for key, value in times.items()} for kind, times in json.loads(self.path.read_text()).items()}


def send(terminal, data):
    """Returns when the last byte went out."""
    while True:
        now = time.time_ns()
        try:
            data = data[os.write(terminal.sensor, data):]
        except BlockingIOError:
            time.sleep(0.0001)
            continue
        if not data:
            return now


def processor_s(process):
    words = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def percentiles(values):
    ordered = sorted(values)
    return [ordered[min(int(share * len(ordered)), len(ordered) - 1)] for share in (0.5, 0.99, 0.999, 1.0)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("out", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--duration", type=int, default=70)
    parser.add_argument("--rate", type=int, default=20)
    parser.add_argument("--imu-rate", type=int, default=400)
    words = parser.parse_args()
    folder = words.out / "load"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("run.journal*"):
        old.unlink()
    drive = Drive(words.bin, folder / "drive", words.duration, settings=(f"receiver.interval_s={1 / words.rate}", f"imu.rate_hz={words.imu_rate}", *SKY))
    satellites = sorted(len(of) for _, of in drive.epochs)
    ubx = [(t, data, instant[0] * 10**9 + round(instant[1] * 1e9)) for (instant, _), (t, data) in
           zip(drive.epochs, (item for item in drive.ubx() if item[1][2:4] == b"\x02\x15"))]
    imu = drive.vectornav()
    ports = {"receiver": live.Terminal(), "imu": live.Terminal(), "ephemerides": live.Terminal()}
    listener = Listener(folder / "heard.json")
    programs = live.Programs(words.bin, folder, [("receiver", ports["receiver"], UBX), ("imu", ports["imu"], IMU), ("ephemerides", ports["ephemerides"], SERVICE)],
                             daemon_options=("--set", f"realtime.epoch_interval_s={1 / words.rate}"))
    messages = [(t, "epoch", key, ports["receiver"], data) for t, data, key in ubx]
    messages += [(t, "sample", struct.unpack_from("<Q", data, 4 + 8)[0], ports["imu"], data) for t, data in imu]
    for t in range(0, words.duration, 20):
        messages += [(t + 0.013, "ephemeris", None, ports["ephemerides"], data) for data in drive.ephemerides(drive.first + t).values()]
    messages.sort(key=lambda message: message[0])

    sent, begin, used = {"epoch": {}, "sample": {}, "ephemeris": {}}, time.monotonic(), None
    for t, kind, key, port, data in messages:
        wait = begin + t - time.monotonic()
        if wait > 0:
            time.sleep(wait)
        if used is None and t >= SETTLED_S:
            used = time.monotonic(), processor_s(programs.connect), processor_s(programs.daemon)
        sent[kind][key] = send(port, data)
    wall = time.monotonic() - used[0]
    shares = [(processor_s(process) - before) / wall * 100 for process, before in zip((programs.connect, programs.daemon), used[1:])]
    time.sleep(1)
    codes = programs.stop()
    heard = listener.result()

    print(f"{words.rate} epochs/s of {satellites[0]} to {satellites[-1]} satellites ({len(ubx[-1][1])} bytes), {words.imu_rate} samples/s, "
          f"{wall:.0f} s; load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    print(f"processor time: leonav-connect {shares[0]:.1f} %, leonavd {shares[1]:.1f} % of one processor")
    print("| latency, ms | messages | missing | median | 99 % | 99.9 % | largest |\n|---|---|---|---|---|---|---|")
    failed = codes != [0, 0]
    settled = {"epoch": int((drive.first + SETTLED_S) * 1e9), "sample": int((drive.first + SETTLED_S) * 1e9)}
    for kind in ("epoch", "sample"):
        wanted = {key: when for key, when in sent[kind].items() if key >= settled[kind]}
        delays = [(heard[kind][key] - when) * 1e-6 for key, when in wanted.items() if key in heard[kind]]
        missing = len(wanted) - len(delays)
        values = percentiles(delays) if delays else [float("nan")] * 4
        print(f"| {kind} | {len(wanted)} | {missing} | " + " | ".join(f"{value:.2f}" for value in values) + " |")
        failed = failed or missing > 0 or not values[0] <= LIMIT_MEDIAN_MS or not shares[0] <= LIMIT_CONNECT_PERCENT
    sys.exit(1 if failed else 0)


# More satellites than today's systems show: half as many again of GPS and Galileo, down to the horizon.
SKY = ("receiver.elevation_mask_deg=0", "satellites.gps.only_risen=true", "satellites.galileo.only_risen=true",
       "satellites.gps.shells=[{planes: 6, per_plane: 9, semi_major_axis_km: 26560, inclination_deg: 55, node_span_deg: 360, phase_per_plane_deg: 20}]",
       "satellites.galileo.shells=[{planes: 3, per_plane: 14, semi_major_axis_km: 29600, inclination_deg: 56, node_span_deg: 360, phase_per_plane_deg: 10}]")
# Bounds that a machine under other load still keeps.
LIMIT_MEDIAN_MS, LIMIT_CONNECT_PERCENT = 2.0, 20.0

if __name__ == "__main__":
    main()
