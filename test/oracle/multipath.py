#!/usr/bin/python3
"""Code multipath from a RINEX 3 observation file, as an oracle for tools/quality.

Shares nothing with the project: its own reader, MP1 and MP2 as Estey and Meertens (1999) write
them, arcs cut where the geometry-free combination jumps or the satellite was away, each arc about
its own mean. Prints one line per satellite and code: SATELLITE CODE SAMPLES RMS_M.

  multipath.py FILE
"""
import sys

import numpy as np

C = 299792458.0
# System: carriers and frequencies (Hz) of the pair.
PAIRS = {
    "G": ("L1C", 1575.42e6, "L2W", 1227.60e6),
    "E": ("L1C", 1575.42e6, "L7Q", 1207.14e6),
}
MAX_GAP_S = 75.0  # 2.5 intervals of 30 s
MIN_SAMPLES = 10
JUMP_M = 0.15  # over 30 s; the ionosphere stays far below


def read(path):
    """{satellite: [(time_s, {type: value})]}"""
    types, data, current, system = {}, {}, None, None
    with open(path) as file:
        for line in file:
            label = line[60:].strip()
            if label == "SYS / # / OBS TYPES":
                system = line[0] if line[0] != " " else system
                types.setdefault(system, []).extend(line[7:60].split())
            elif label == "END OF HEADER":
                break
        for line in file:
            if line[0] == ">":
                day, hour, minute, second = line[10:12], line[13:15], line[16:18], line[18:29]
                current = ((int(day) * 24 + int(hour)) * 60 + int(minute)) * 60 + float(second)
                continue
            values = {}
            for place, name in enumerate(types.get(line[0], [])):
                text = line[3 + 16 * place:17 + 16 * place].strip()
                if text and float(text) != 0.0:
                    values[name] = float(text)
            data.setdefault(line[:3].replace(" ", "0"), []).append((current, values))
    return data


def arcs(times, geometry_free):
    cuts = np.flatnonzero((np.diff(times) > MAX_GAP_S) | (np.abs(np.diff(geometry_free)) > JUMP_M)) + 1
    return np.split(np.arange(len(times)), cuts)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for satellite, rows in sorted(read(sys.argv[1]).items()):
        if satellite[0] not in PAIRS:
            continue
        first, f1, second, f2 = PAIRS[satellite[0]]
        a = (f1 / f2) ** 2
        rows = [(t, v) for t, v in rows if first in v and second in v]
        if not rows:
            continue
        times = np.array([t for t, _ in rows])
        l1 = np.array([v[first] for _, v in rows]) * C / f1
        l2 = np.array([v[second] for _, v in rows]) * C / f2
        cut = arcs(times, l1 - l2)
        for name in sorted({n for _, v in rows for n in v if n[0] == "C" and n[1] in (first[1], second[1])}):
            code = np.array([v.get(name, np.nan) for _, v in rows])
            if name[1] == first[1]:
                mp = code - (1 + 2 / (a - 1)) * l1 + 2 / (a - 1) * l2
            else:
                mp = code - 2 * a / (a - 1) * l1 + (2 * a / (a - 1) - 1) * l2
            squares, samples = 0.0, 0
            for arc in cut:
                values = mp[arc][np.isfinite(mp[arc])]
                if len(values) < MIN_SAMPLES:
                    continue
                squares += np.var(values, ddof=1) * len(values)
                samples += len(values)
            if samples:
                print(f"{satellite} {name[1:]} {samples} {np.sqrt(squares / samples):.4f}")


if __name__ == "__main__":
    main()
