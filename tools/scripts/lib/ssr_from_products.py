#!/usr/bin/env python3
"""Makes a stream of SSR messages (RTCM 3) from precise products, as a service would have sent it.

  ssr_from_products.py --nav FILE --sp3 FILE... --clk FILE --from WEEK:SECONDS --to WEEK:SECONDS [--biases FILE] -o OUT.rtcm3

Orbits (1057, 1240) every 60 s and clocks (1058, 1241) every 30 s of GPS and Galileo (I/NAV): the products minus the
broadcast message, rounded as the messages are. Orbits are those of the centre of mass. A clock holds until the next
one: c1 and c2 are zero, and nothing later than its time is in it. With --biases also code biases (1059, 1242) every 60 s:
of each line of the file (satellite, signal, metres that the code has too much) what takes them away. It shares no code with the decoder: bits, broadcast
orbit and interpolation are its own. Sources: RTCM 10403.3, 3.5.12; IS-GPS-200, table 20-IV; Galileo OS-SIS-ICD 5.1.
"""
import argparse
import bisect
import collections
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[3] / "test/support/python"))
from crc24q import crc24q  # noqa: E402
from navigation_file import records  # noqa: E402

C = 299792458.0
OMEGA = 7.2921151467e-5
MU = {"G": 3.986005e14, "E": 3.986004418e14}
WEEK = 604800
PROVIDER, SOLUTION = 4095, 1
ORBIT_INTERVAL, CLOCK_INTERVAL = 60, 30
SETTLED_S = 120  # a service refers to a broadcast message that users have had for so long


def days(y, m, d):
    """Days since 1980-01-06."""
    a = (14 - m) // 12
    y, m = y + 4800 - a, m + 12 * a - 3
    return d + (153 * m + 2) // 5 + 365 * y + y // 4 - y // 100 + y // 400 - 32045 - 2444245


def stamp(words):
    y, mo, d, h, mi = (int(w) for w in words[:5])
    return days(y, mo, d) * 86400 + h * 3600 + mi * 60 + float(words[5])


def read_nav(path):
    """RINEX 3: satellite -> list of sets."""
    sets = collections.defaultdict(list)
    for satellite, toc, clock, orbit in records(path):
        if satellite[0] not in "GE":
            continue
        keys = ("af0 af1 af2 iode crs deltan m0 cuc e cus sqrta toe cic omega0 cis i0 crc omega omegadot idot source week "
                "l2p accuracy health tgd iodc sent").split()
        s = dict(zip(keys, clock + orbit))
        if s["health"] != 0:
            continue
        if satellite[0] == "E" and not int(s["source"]) & 5:  # I/NAV: bits 0 and 2
            continue
        s["system"] = satellite[0]
        s["toc"] = float(toc)
        s["toe_s"] = s["toe"]
        s["toe"] = s["week"] * WEEK + s["toe"]
        s["sent"] = s["week"] * WEEK + s["sent"]
        if s["sent"] - s["toe"] > WEEK / 2:
            s["sent"] -= WEEK
        sets[satellite].append(s)
    for of in sets.values():
        of.sort(key=lambda s: s["sent"])
    return sets


def broadcast(s, t):
    """Position in m, clock in s with its relativistic term."""
    mu = MU[s["system"]]
    a = s["sqrta"] ** 2
    tk = t - s["toe"]
    n = math.sqrt(mu / a ** 3) + s["deltan"]
    m = s["m0"] + n * tk
    ecc = m
    for _ in range(30):
        ecc = m + s["e"] * math.sin(ecc)
    nu = math.atan2(math.sqrt(1 - s["e"] ** 2) * math.sin(ecc), math.cos(ecc) - s["e"])
    phi = nu + s["omega"]
    c2, s2 = math.cos(2 * phi), math.sin(2 * phi)
    u = phi + s["cus"] * s2 + s["cuc"] * c2
    r = a * (1 - s["e"] * math.cos(ecc)) + s["crs"] * s2 + s["crc"] * c2
    inc = s["i0"] + s["idot"] * tk + s["cis"] * s2 + s["cic"] * c2
    node = s["omega0"] + (s["omegadot"] - OMEGA) * tk - OMEGA * s["toe_s"]
    x, y = r * math.cos(u), r * math.sin(u)
    p = (x * math.cos(node) - y * math.cos(inc) * math.sin(node), x * math.sin(node) + y * math.cos(inc) * math.cos(node),
         y * math.sin(inc))
    tc = t - s["toc"]
    clock = s["af0"] + tc * (s["af1"] + tc * s["af2"])
    clock += -2 * math.sqrt(mu) / C ** 2 * s["e"] * s["sqrta"] * math.sin(ecc)
    return p, clock


def read_sp3(paths):
    orbits = collections.defaultdict(dict)
    for path in paths:
        t = None
        for line in open(path):
            if line.startswith("* "):
                t = stamp(line[1:].split())
            elif line.startswith("P") and t is not None and line[1] in "GE":
                p = tuple(1e3 * float(line[4 + 14 * k:18 + 14 * k]) for k in range(3))
                if p != (0, 0, 0):
                    orbits[line[1:4].replace(" ", "0")][t] = p
    return {sat: sorted(nodes.items()) for sat, nodes in orbits.items()}


def turn(p, angle):
    c, s = math.cos(angle), math.sin(angle)
    return (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2])


def orbit_at(nodes, t, points=12):
    """Lagrange's polynomial in the frame that is inertial and equals ECEF at t; None beyond the nodes."""
    times = [node[0] for node in nodes]
    i = bisect.bisect_left(times, t)
    first = i - points // 2
    if first < 0 or first + points > len(nodes):
        return None
    chosen = nodes[first:first + points]
    if chosen[-1][0] - chosen[0][0] > 900 * points:
        return None
    total = [0.0, 0.0, 0.0]
    for k, (tk, p) in enumerate(chosen):
        weight = 1.0
        for j, (tj, _) in enumerate(chosen):
            if j != k:
                weight *= (t - tj) / (tk - tj)
        q = turn(p, OMEGA * (tk - t))
        for axis in range(3):
            total[axis] += weight * q[axis]
    return tuple(total)


def read_clk(path):
    clocks = collections.defaultdict(dict)
    for line in open(path):
        if line.startswith("AS "):
            words = line.split()
            if words[1][0] in "GE":
                clocks[words[1]][round(stamp(words[2:8]))] = float(words[9])
    return clocks


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    n = math.sqrt(sum(x * x for x in a))
    return tuple(x / n for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def rate(function, t, h=0.5):
    """Velocity from four points."""
    p = [function(t + k * h) for k in (-2, -1, 1, 2)]
    if any(q is None for q in p):
        return None
    return tuple((p[0][i] - 8 * p[1][i] + 8 * p[2][i] - p[3][i]) / (12 * h) for i in range(3))


def delta(s, nodes, t):
    """Broadcast minus precise, along radius, flight and across."""
    precise = orbit_at(nodes, t)
    if precise is None:
        return None
    p = broadcast(s, t)[0]
    v = rate(lambda u: broadcast(s, u)[0], t)
    along, across = unit(v), unit(cross(p, v))
    difference = minus(p, precise)
    return tuple(dot(axis, difference) for axis in (cross(along, across), along, across))


class Bits:
    def __init__(self):
        self.value, self.length = 0, 0

    def put(self, value, count, scale=None):
        if scale is not None:
            value = round(value / scale)
            if not -(1 << count - 1) <= value < 1 << count - 1:
                raise OverflowError
            value &= (1 << count) - 1
        self.value = self.value << count | int(value)
        self.length += count

    def bytes(self):
        pad = -self.length % 8
        return (self.value << pad).to_bytes((self.length + pad) // 8, "big")


def frame(message):
    data = b"\xd3" + len(message).to_bytes(2, "big") + message
    return data + crc24q(data).to_bytes(3, "big")


def header(number_, t, interval_index, satellites, is_orbit):
    bits = Bits()
    bits.put(number_, 12)
    bits.put(int(t) % WEEK, 20)
    bits.put(interval_index, 4)
    bits.put(0, 1)  # no more messages of this kind
    if is_orbit:
        bits.put(0, 1)  # ITRF
    bits.put(1, 4)  # issue of the SSR data
    bits.put(PROVIDER, 16)
    bits.put(SOLUTION, 4)
    bits.put(satellites, 6)
    return bits


def chosen_set(sets, t):
    """The newest set that users have had for a while and that is in force."""
    usable = [s for s in sets if s["sent"] + SETTLED_S <= t and abs(t - s["toe"]) <= 7200]
    return max(usable, key=lambda s: (s["toe"], s["sent"]), default=None)


def orbit_rows(system, t, orbits, in_force, interval=ORBIT_INTERVAL):
    """(satellite, broadcast set, delta in the middle of the interval that begins at t, its rate) of each satellite."""
    middle = t + interval / 2
    rows = []
    for sat, s in in_force.items():
        if sat[0] != system:
            continue
        now, before, after = (delta(s, orbits[sat], u) for u in (middle, t, t + interval))
        if None in (now, before, after):
            continue
        rows.append((sat, s, now, tuple((b - a) / interval for a, b in zip(before, after))))
    return rows


def encode_orbits(system, t, rows, interval=ORBIT_INTERVAL):
    bits = header({"G": 1057, "E": 1240}[system], t, {30: 5, 60: 6}[interval], len(rows), True)
    for sat, s, d, d_rate in rows:
        bits.put(int(sat[1:]), 6)
        bits.put(int(s["iode"]) & (0xFF if system == "G" else 0x3FF), 8 if system == "G" else 10)
        bits.put(d[0], 22, 1e-4)
        bits.put(d[1], 20, 4e-4)
        bits.put(d[2], 20, 4e-4)
        bits.put(d_rate[0], 21, 1e-6)
        bits.put(d_rate[1], 19, 4e-6)
        bits.put(d_rate[2], 19, 4e-6)
    return frame(bits.bytes())


def clock_rows(system, t, orbits, clocks, in_force):
    """(satellite, precise minus broadcast clock in m) of each satellite."""
    rows = []
    for sat, s in in_force.items():
        clock = clocks[sat].get(round(t))
        if sat[0] != system or clock is None:
            continue
        at = lambda u: turn(orbit_at(orbits[sat], u) or (math.nan,) * 3, OMEGA * (u - t))
        p, v = at(t), rate(at, t)
        precise = clock - 2 * dot(p, v) / C ** 2
        c0 = C * (precise - broadcast(s, t)[1])
        if math.isfinite(c0):
            rows.append((sat, c0))
    return rows


def encode_clocks(system, t, rows):
    bits = header({"G": 1058, "E": 1241}[system], t, 0, len(rows), False)
    for sat, c0 in rows:
        bits.put(int(sat[1:]), 6)
        bits.put(c0, 22, 1e-4)
        bits.put(0, 21)
        bits.put(0, 27)
    return frame(bits.bytes())


# Identifiers of signals: DF380 and DF382.
SIGNAL = {"G": "1C 1P 1W 1Y 1M 2C 2D 2S 2L 2X 2P 2W 2Y 2M 5I 5Q 5X 1S 1L 1X".split(),
          "E": "1A 1B 1C 1X 1Z 5I 5Q 5X 7I 7Q 7X 8I 8Q 8X 6A 6B 6C 6X 6Z".split()}


def read_biases(path):
    """{satellite: [(signal, metres), ...]}"""
    biases = collections.defaultdict(list)
    for line in open(path):
        satellite, signal, metres = line.split()
        biases[satellite].append((signal, float(metres)))
    return biases


def bias_message(system, t, biases):
    """What is sent is to be added to the codes (DF383)."""
    of = {sat: rows for sat, rows in biases.items() if sat[0] == system}
    bits = header({"G": 1059, "E": 1242}[system], t, 6, len(of), False)
    for sat, rows in sorted(of.items()):
        bits.put(int(sat[1:]), 6)
        bits.put(len(rows), 5)
        for signal, metres in rows:
            bits.put(SIGNAL[system].index(signal), 5)
            bits.put(-metres, 14, 1e-2)
    return frame(bits.bytes()), len(of)


def orbit_message(system, t, orbits, in_force):
    rows = orbit_rows(system, t, orbits, in_force)
    return encode_orbits(system, t, rows), len(rows)


def clock_message(system, t, orbits, clocks, in_force):
    rows = clock_rows(system, t, orbits, clocks, in_force)
    return encode_clocks(system, t, rows), len(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nav", required=True)
    parser.add_argument("--sp3", required=True, nargs="+")
    parser.add_argument("--clk", required=True)
    parser.add_argument("--from", required=True, dest="start", metavar="WEEK:SECONDS")
    parser.add_argument("--to", required=True, metavar="WEEK:SECONDS")
    parser.add_argument("--biases", metavar="FILE")
    parser.add_argument("-o", required=True, dest="out")
    words = parser.parse_args()
    instant = lambda text: int(text.split(":")[0]) * WEEK + int(text.split(":")[1])
    sets, orbits, clocks = read_nav(words.nav), read_sp3(words.sp3), read_clk(words.clk)
    biases = read_biases(words.biases) if words.biases else {}
    satellites = sorted(set(sets) & set(orbits) & set(clocks))
    messages = satellites_sent = 0
    in_force = {}
    with open(words.out, "wb") as out:
        for t in range(instant(words.start), instant(words.to) + 1, CLOCK_INTERVAL):
            if t % ORBIT_INTERVAL == 0:
                in_force = {sat: s for sat in satellites if (s := chosen_set(sets[sat], t))}
                made = [orbit_message(system, t, orbits, in_force) for system in "GE"]
                made += [bias_message(system, t, biases) for system in "GE" if biases]
            else:
                made = []
            made += [clock_message(system, t, orbits, clocks, in_force) for system in "GE"]
            for data, count in made:
                out.write(data)
                messages += 1
                satellites_sent += count
    print(f"{words.out}: {messages} messages, {satellites_sent} corrections of {len(satellites)} satellites")


if __name__ == "__main__":
    main()
