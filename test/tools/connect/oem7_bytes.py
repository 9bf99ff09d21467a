"""Encodes RINEX files as the bytes of a NovAtel receiver: RANGECMP, RAWEPHEM and IONUTC.

Written from the manual alone, so that it is independent of leonav's decoder: OEM7 Commands and Logs Reference Manual, chapters
of these names. Numbers are rounded as those logs round them. The frame is that of test/oracle/oem7.py.
"""
import pathlib
import struct
import sys

import ubx_bytes

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "oracle"))
from oem7 import Bits, long_message  # noqa: E402

RANGECMP, RAWEPHEM, IONUTC = 140, 41, 8
# Of the tracking status: numbers of systems and of their signals.
SYSTEMS = {"G": 0, "E": 3, "C": 4}
SIGNALS = {"G": {"1C": 0, "2W": 9, "5Q": 14}, "E": {"1C": 2, "5Q": 12, "7Q": 17}, "C": {"2I": 0, "7I": 1, "6I": 2}}
PHASE_LOCKED, PARITY_KNOWN, CODE_LOCKED = 1 << 10, 1 << 11, 1 << 12


def message(number, payload, gps_s):
    return long_message(number, payload, round(gps_s * 1e3) % 604800000, week=int(gps_s // 604800))


def epoch(time, satellites, locks):
    """RANGECMP; `locks`: since when (s) each signal's carrier is locked; kept from epoch to epoch."""
    now = time[0] + time[1]
    records = [record(now, name, signal, values, locks) for name, values in sorted(satellites.items())
               for signal in SIGNALS.get(name[0], {}) if values.get("C" + signal)]
    return message(RANGECMP, struct.pack("<I", len(records)) + b"".join(records), now)


def record(now, name, signal, values, locks):
    code, carrier, doppler, strength = (values.get(kind + signal) for kind in "CLDS")
    flags = carrier[1].strip() if carrier else ""
    if not carrier or flags and flags in "1357":
        locks.pop((name, signal), None)
    since = locks.setdefault((name, signal), now) if carrier else now
    status = CODE_LOCKED | SYSTEMS[name[0]] << 16 | SIGNALS[name[0]][signal] << 21
    status |= (PHASE_LOCKED if carrier else 0) | (0 if flags and flags in "23" else PARITY_KNOWN)
    bits = Bits().add(status, 32).add(round((doppler[0] if doppler else 0.0) * 256), 28).add(round(code[0] * 128), 36)
    bits.add(round(-carrier[0] * 256) if carrier else 0, 32).add(3, 4).add(1, 4).add(int(name[1:]), 8)  # rolls over by itself
    bits.add(min(round((now - since) * 32), (1 << 21) - 1), 21).add(min(max(round((strength[0] if strength else 20.0) - 20), 0), 31), 5)
    return bits.add(7, 6).add(0, 16).bytes()


def broadcasts(path, start):
    """(time, message): IONUTC, and RAWEPHEM of each satellite when its third subframe has come."""
    first = start - start % 6 + 6
    alpha = [value * 2.0 ** power for value, power in zip(ubx_bytes.ALPHA, (-30, -27, -24, -24))]
    beta = [value * 2.0 ** power for value, power in zip(ubx_bytes.BETA, (11, 14, 16, 16))]
    yield first + 24, message(IONUTC, struct.pack("<8dIIddIIiiI", *alpha, *beta, 0, 0, 0.0, 0.0, 0, 0, 18, 18, 0), first + 24)
    for satellite, (toc, clock, orbit) in ubx_bytes.newest_records(path, start).items():
        frames = [b"".join((word >> 6 & 0xFFFFFF).to_bytes(3, "big") for word in words)
                  for _, words in ubx_bytes.subframes(toc, clock, orbit, first)]
        head = struct.pack("<III", satellite, toc // 604800, toc % 604800)
        yield first + 18, message(RAWEPHEM, head + b"".join(frames), first + 18)
