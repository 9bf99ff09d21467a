"""Encodes RINEX files as the bytes of a Septentrio receiver: MeasEpoch and GPSRawCA.

Written from the guide alone, so that it is independent of leonav's decoder: mosaic-X5 Reference Guide, "MeasEpoch" and
"GPSRawCA". Numbers are rounded as those blocks round them. The frame is that of test/oracle/sbf.py.
"""
import pathlib
import struct
import sys

import ubx_bytes

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "oracle"))
from sbf import block  # noqa: E402

MEAS_EPOCH, GPS_RAW_CA = 4027, 4017
C = 299792458.0
# Numbers and carriers in MHz.
SIGNALS = {"G": {"1C": (0, 1575.42), "2W": (2, 1227.60), "5Q": (4, 1176.45)},
           "E": {"1C": (17, 1575.42), "5Q": (20, 1176.45), "7Q": (21, 1207.14)},
           "C": {"2I": (28, 1561.098), "7I": (29, 1207.14), "6I": (30, 1268.52)}}
WITHOUT_OFFSET = ("G", "2W")  # its strength is not counted from 10 dB-Hz
HALF_CYCLE = 1 << 2


def number_of(name):
    number = int(name[1:])
    return number + {"G": 0, "E": 70, "C": 140 if number <= 40 else 182}[name[0]]


def stamped(kind, payload, gps_s, revision=0):
    return block(kind, payload, round(gps_s * 1e3) % 604800000, revision=revision, week=int(gps_s // 604800))


def epoch(time, satellites, locks):
    """MeasEpoch; `locks`: (since when, s, each signal's carrier is locked, whole cycles taken off); kept from epoch to epoch.

    A carrier is given near its code: whole cycles are taken off when an arc begins.
    """
    now, body, count = time[0] + time[1], b"", 0
    for name, values in sorted(satellites.items()):
        measured = [(signal, values) for signal in SIGNALS.get(name[0], {}) if values.get("C" + signal)]
        if not measured:
            continue
        count += 1
        parts = [Signal(now, name, signal, values, locks) for signal, values in measured]
        body += parts[0].master(number_of(name), len(parts) - 1) + b"".join(part.slave(parts[0]) for part in parts[1:])
    return stamped(MEAS_EPOCH, struct.pack("<BBBBBB", count, 20, 12, 1, 0, 0) + body, now, revision=1)


class Signal:
    """What one signal of one satellite has measured, in the units of the block."""

    def __init__(self, now, name, signal, values, locks):
        code, carrier, doppler, strength = (values.get(kind + signal) for kind in "CLDS")
        self.number, self.megahertz = SIGNALS[name[0]][signal]
        self.code_mm = round(code[0] * 1e3)
        self.doppler = round(doppler[0] * 1e4) if doppler else None
        flags = carrier[1].strip() if carrier else ""
        key = name, signal
        if not carrier or flags and flags in "1357":
            locks.pop(key, None)
        self.offset, self.lock_s = -128 << 16, 0  # not measured
        if carrier:
            by_code = self.code_mm * 1e-3 / (C / (self.megahertz * 1e6))
            since, cycles = locks.setdefault(key, (now, round(carrier[0] - by_code)))
            self.offset, self.lock_s = round((carrier[0] - cycles - by_code) * 1e3), int(now - since)
        self.info = HALF_CYCLE if flags and flags in "23" else 0
        dbhz = strength[0] if strength else 10.0
        self.strength = round((dbhz - (0 if (name[0], signal) == WITHOUT_OFFSET else 10)) * 4)

    def master(self, satellite, slaves):
        return struct.pack("<BBBBIiHbBHBB", 1, self.number, satellite, self.code_mm >> 32, self.code_mm & 0xFFFFFFFF,
                           -2 ** 31 if self.doppler is None else self.doppler, self.offset & 0xFFFF, self.offset >> 16,
                           self.strength, min(self.lock_s, 65534), self.info, slaves)

    def slave(self, master):
        code = self.code_mm - master.code_mm
        doppler = -16 << 16
        if self.doppler is not None and master.doppler is not None:
            doppler = round(self.doppler - master.doppler * self.megahertz / master.megahertz)
        return struct.pack("<BBBBbBHHH", self.number, min(self.lock_s, 254), self.strength,
                           code >> 16 & 7 | (doppler >> 16 & 31) << 3, self.offset >> 16, self.info, code & 0xFFFF,
                           self.offset & 0xFFFF, doppler & 0xFFFF)


def broadcasts(path, start):
    """(time of reception, GPSRawCA) of what ubx_bytes.py lets the satellites send."""
    for received, satellite, words in ubx_bytes.received_subframes(path, start):
        bits = struct.pack("<10I", *(word & 0x3FFFFFFF for word in words))
        yield received, stamped(GPS_RAW_CA, struct.pack("<BBBBBB", satellite, 1, 0, 0, 0, 1) + bits, received)
