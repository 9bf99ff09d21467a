"""Encodes imu.csv as the bytes of a VectorNav sensor.

Written from the user manual alone, so that it is independent of leonav's decoder: VN-300 user manual UM005, binary
output messages; the checksum is Python's own CRC-CCITT (binascii.crc_hqx), which the manual's example confirms.

  vectornav_bytes.py IMU.csv OUT [gps|startup] [DRIFT_PPM]

gps: TimeGps and TimeStartup, with DeltaTheta of the common group. startup: TimeStartup alone, by a clock that drifts, with
AngularRate and Accel of the IMU group.
"""
import binascii
import csv
import math
import struct
import sys


def message(groups, masks, payload):
    body = struct.pack("<B", groups) + b"".join(struct.pack("<H", mask) for mask in masks) + payload
    return b"\xfa" + body + struct.pack(">H", binascii.crc_hqx(body, 0))


assert message(1, [8], bytes.fromhex("93502E42833EF13F48B504BB")).hex() == "fa01080093502e42833ef13f48b504bb9288"


def samples(path):
    """(GPS time in ns, rates in rad/s and m/s^2)"""
    with open(path, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            whole, _, fraction = row["gps_tow_s"].partition(".")
            time_ns = (int(row["gps_week"]) * 604800 + int(whole)) * 10**9 + int(fraction.ljust(9, "0")[:9])
            yield time_ns, [float(row[f"{kind}_{axis}_{unit}"]) for kind, unit in (("gyro", "rad_s"), ("accel", "m_s2")) for axis in "xyz"]


def messages(path, kind="gps", drift_ppm=0.0, clock=None):
    """(GPS time in ns, bytes) of each sample but the first, whose interval is not known.

    `clock` gives what the sensor's clock shows of the s since the first sample; without it that drifts by `drift_ppm`."""
    clock = clock or (lambda passed_s: passed_s * (1 + drift_ppm * 1e-6))
    last = first = None
    for time_ns, rates in samples(path):
        first = time_ns if first is None else first
        startup_ns = 5 * 10**9 + round(clock((time_ns - first) * 1e-9) * 1e9)
        if last is not None and kind == "gps":
            interval = (time_ns - last) * 1e-9
            payload = struct.pack("<QQ7f", startup_ns, time_ns, interval, *(math.degrees(rate) * interval for rate in rates[:3]),
                                  *(force * interval for force in rates[3:]))
            yield time_ns, message(0x01, [1 << 0 | 1 << 1 | 1 << 11], payload)
        elif last is not None:
            yield time_ns, message(0x01 | 0x04, [1 << 0, 1 << 9 | 1 << 10], struct.pack("<Q6f", startup_ns, *rates[3:], *rates[:3]))
        last = time_ns


def main():
    source, out, *options = sys.argv[1:]
    with open(out, "wb") as file:
        for _, one in messages(source, *(options[:1] or ["gps"]), *(float(drift) for drift in options[1:2])):
            file.write(one)


if __name__ == "__main__":
    main()
