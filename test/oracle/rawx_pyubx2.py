"""Compares every measurement of a u-blox file, as pyubx2 (PyPI) reads it, with the log that leonav-import makes of it.

  python3 -m venv venv && venv/bin/pip install pyubx2
  venv/bin/python test/oracle/rawx_pyubx2.py RUN.ubx RUN.lcmlog

The log is read by the layout of lcmtypes/gnss_epoch_t.lcm and lcmtypes/gnss_observation_t.lcm, not by leonav.
"""
import math
import pathlib
import struct
import sys

import pyubx2

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/scripts/lib"))
import lcm_log  # noqa: E402

SYSTEMS = {0: 0, 2: 1, 3: 2}  # gnssId to leonav's number
SIGNALS = {0: {0: "1C", 3: "2L", 4: "2S", 6: "5I", 7: "5Q"}, 2: {0: "1C", 1: "1B", 3: "5I", 4: "5Q", 5: "7I", 6: "7Q", 8: "6B", 9: "6C", 10: "6A"},
           3: {0: "2I", 1: "2I", 2: "7I", 3: "7I", 4: "6I", 5: "1P", 6: "1D", 7: "5P", 8: "5D", 10: "6I"}}
HEADER = struct.Struct(">qqqii")
OBSERVATION = struct.Struct(">bhbbdddffb")


def by_pyubx2(path):
    """{GPS time in ns: {(system, number, signal): (code, carrier, Doppler, C/N0, lock time, half cycle known)}}"""
    found = {}
    with open(path, "rb") as file:
        for _, message in pyubx2.UBXReader(file, protfilter=2, quitonerror=0):
            if message is None or message.identity != "RXM-RAWX":
                continue
            signals = {}
            for index in range(1, message.numMeas + 1):
                get = lambda name, i=index: getattr(message, f"{name}_{i:02d}")
                signal = SIGNALS.get(get("gnssId"), {}).get(get("sigId"))
                if signal is None:
                    continue
                carrier = get("cpMes") if get("cpValid") and get("cpMes") not in (0.0, -0.5) and get("cpStd") <= 14 else math.nan
                signals[SYSTEMS[get("gnssId")], get("svId"), signal] = (
                    get("prMes") if get("prValid") else math.nan, carrier, get("doMes"), float(get("cno")), get("locktime") * 1e-3,
                    bool(get("halfCyc")))
            found[message.week * 604800 * 10**9 + round(message.rcvTow * 1e9)] = signals
    return found


def by_leonav(path):
    found = {}
    for _, channel, data in lcm_log.messages(path):
        if channel != "LEONAV_GNSS_EPOCH":
            continue
        _, time_ns, _, _, count = HEADER.unpack_from(data)
        signals, at = {}, HEADER.size
        for _ in range(count):
            system, number, band, attribute, code, carrier, doppler, cn0, lock, flags = OBSERVATION.unpack_from(data, at)
            signals[system, number, chr(band) + chr(attribute)] = code, carrier, doppler, cn0, lock, not flags & 2
            at += OBSERVATION.size
        found[time_ns] = signals
    return found


def same(a, b):
    return a == b or (math.isnan(a) and math.isnan(b))


def main():
    theirs, ours = by_pyubx2(sys.argv[1]), by_leonav(sys.argv[2])
    counts = dict.fromkeys(("epochs", "signals", "codes", "carriers", "Dopplers", "C/N0", "lock times", "half-cycle flags"), 0)
    different = len(set(theirs) ^ set(ours))
    for time in sorted(set(theirs) & set(ours)):
        counts["epochs"] += 1
        different += len(set(theirs[time]) ^ set(ours[time]))
        for signal in set(theirs[time]) & set(ours[time]):
            counts["signals"] += 1
            a, b = theirs[time][signal], ours[time][signal]
            for index, name in enumerate(("codes", "carriers", "Dopplers")):
                counts[name] += not math.isnan(a[index])
                different += not same(a[index], b[index])
            counts["C/N0"] += 1
            different += not (same(a[3], b[3]) or (a[3] == 0.0 and math.isnan(b[3])))
            counts["lock times"] += 1
            different += abs(a[4] - b[4]) > 1e-6 * max(a[4], 1.0)  # the message holds it as float
            if not math.isnan(a[1]):
                counts["half-cycle flags"] += 1
                different += a[5] != b[5]
    print(", ".join(f"{count} {name}" for name, count in counts.items()) + f"; {different} differ")
    return 1 if different else 0


sys.exit(main())
