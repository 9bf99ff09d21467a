#!/usr/bin/env python3
"""What the PyPI package novatel-edie reads in NovAtel bytes, as an oracle for drivers/oem7.

  oem7.py fields FILE        one line of numbers for each measurement, ephemeris, set of coefficients and inertial sample
  oem7.py generate SEED >OUT messages of every log that leonav reads, with random fields, packed by the manual's tables
  oem7.py examples >OUT      the manual's ASCII examples of GALINAVEPHEMERIS and GALFNAVEPHEMERIS, made binary by the package.
                             Their headers name the same definitions of the fields (dbe9, 02cd) as the package has
  oem7.py --have             exits 0 if novatel-edie is there

Numbers are printed so that they are read back to the last bit. Messages that name another source than the first antenna
(OEM-V sets those bits) are given to the package as if of the first, because it decompresses no others.
"""
import random
import struct
import sys

LONG, SHORT = b"\xaa\x44\x12", b"\xaa\x44\x13"
WEEK, START_MS = 2209, 512487000


def crc32(data):
    """Of the manual: the polynomial bit by bit, begun with 0 and not inverted."""
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc


def long_message(number, payload, milliseconds, kind=0, week=WEEK, status=180):
    head = LONG + struct.pack("<BHBBHHBBHIIHH", 28, number, kind, 0x20, len(payload), 0, 100, status, week, milliseconds,
                              0, 0, 16809)
    return head + payload + struct.pack("<I", crc32(head + payload))


def short_message(number, payload, milliseconds):
    head = SHORT + struct.pack("<BHHI", len(payload), number, WEEK, milliseconds)
    return head + payload + struct.pack("<I", crc32(head + payload))


def frames(data):
    """Whole messages with a good checksum: number, header's length, bytes."""
    at = 0
    while at + 12 <= len(data):
        if data[at:at + 3] == LONG and at + 28 <= len(data):
            head, size = data[at + 3], struct.unpack_from("<H", data, at + 8)[0]
        elif data[at:at + 3] == SHORT:
            head, size = 12, data[at + 3]
        else:
            at += 1
            continue
        end = at + head + size
        if end + 4 <= len(data) and crc32(data[at:end]) == struct.unpack_from("<I", data, end)[0]:
            yield struct.unpack_from("<H", data, at + 4)[0], head, data[at:end + 4]
            at = end + 4
        else:
            at += 1


class Bits:
    """Fields one after the other, the least significant bit first."""
    def __init__(self):
        self.value, self.count = 0, 0

    def add(self, value, count):
        self.value |= (value & (1 << count) - 1) << self.count
        self.count += count
        return self

    def bytes(self):
        return self.value.to_bytes((self.count + 7) // 8, "little")


class Sky:
    """Satellites whose ranges change steadily, so that each compression finds values that it can hold."""
    # System of the tracking status, of RANGECMP2 and 4; signal numbers of the three; frequency. GPS, Galileo, BeiDou, GLONASS.
    SIGNALS = {
        (0, 0): [(0, 1, 1, 1575.42e6), (9, 4, 4, 1227.6e6), (17, 5, 5, 1227.6e6), (14, 7, 7, 1176.45e6), (16, 15, 15, 1575.42e6)],
        (3, 5): [(2, 1, 1, 1575.42e6), (12, 2, 2, 1176.45e6), (17, 3, 3, 1207.14e6), (20, 4, 4, 1191.795e6),
                 (7, 5, 5, 1278.75e6), (6, 12, 12, 1278.75e6)],
        (4, 6): [(0, 1, 1, 1561.098e6), (1, 3, 3, 1207.14e6), (2, 13, 5, 1268.52e6), (7, 19, 7, 1575.42e6),
                 (9, 20, 9, 1176.45e6)],
        (1, 1): [(0, 1, 1, 1602e6)]}

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.satellites = []
        for systems, signals in self.SIGNALS.items():
            for number in sorted(self.random.sample(range(1, 24), 5)):
                chosen = [s for s in signals if self.random.random() < 0.8] or signals[:1]
                self.satellites.append((systems, number, self.random.uniform(2e7, 4e7), self.random.uniform(-800, 800), chosen))

    def at(self, seconds):
        for systems, number, start, rate, signals in self.satellites:
            yield systems, number, start + rate * seconds, rate, signals


LIGHT = 299792458.0


def status_word(system, signal, rnd):
    return (4 | 1 << 10 | (rnd.random() < 0.9) << 11 | 1 << 12 | system << 16 | signal << 21 | (rnd.random() < 0.1) << 28)


def make_range(sky, seconds):
    rnd, records = sky.random, b""
    for (system, _), number, distance, rate, signals in sky.at(seconds):
        for signal, _, _, frequency in signals:
            records += struct.pack("<HHdfdffffI", number + (37 if system == 1 else 0), 7, distance + rnd.uniform(-5, 5), 0.1,
                                   -(distance * frequency / LIGHT) + rnd.uniform(-5, 5), 0.01, -rate * frequency / LIGHT,
                                   rnd.uniform(25, 55), seconds + rnd.uniform(1, 100), status_word(system, signal, rnd))
    return struct.pack("<I", len(records) // 44) + records


def make_rangecmp(sky, seconds):
    rnd, records = sky.random, b""
    for (system, _), number, distance, rate, signals in sky.at(seconds):
        for signal, _, _, frequency in signals:
            adr = -(distance * frequency / LIGHT) + rnd.uniform(-50, 50)
            adr = (adr + 2 ** 22) % 2 ** 23 - 2 ** 22
            bits = Bits().add(status_word(system, signal, rnd), 32).add(round(-rate * frequency / LIGHT * 256), 28)
            bits.add(round(distance * 128), 36).add(round(adr * 256), 32).add(3, 4).add(1, 4)
            bits.add(number + (37 if system == 1 else 0), 8).add(round((seconds + 20) * 32), 21).add(rnd.randrange(1, 32), 5)
            records += bits.add(7, 6).add(0, 16).bytes()
    return struct.pack("<I", len(records) // 24) + records


def make_rangecmp2(sky, seconds):
    rnd, blocks = sky.random, b""
    for (_, system), number, distance, rate, signals in sky.at(seconds):
        base = int(distance)
        first = 1561.098e6 if system == 6 else 1602e6 if system == 1 else 1575.42e6
        doppler = -rate * first / LIGHT
        blocks += Bits().add(3, 8).add(number, 8).add(7, 4).add(system, 5).add(0, 1).add(base, 29).add(round(doppler), 21).add(
            len(signals), 4).bytes()
        for _, signal, _, _ in signals:
            bits = Bits().add(signal, 5).add(1, 1).add(rnd.random() < 0.9, 1).add(1, 1).add(round(seconds * 1000) + 500, 17)
            bits.add(1, 4).add(0, 1).add(rnd.random() < 0.1, 1).add(0, 1).add(rnd.randrange(1, 32), 5).add(2, 4).add(3, 4)
            bits.add(rnd.randrange(1 << 14), 14).add(rnd.randrange(1 << 20), 20)
            blocks += bits.add(rnd.randrange(-2 ** 16, 2 ** 16), 17).bytes()
    return struct.pack("<I", len(blocks)) + blocks


def make_rangecmp4(sky, seconds):
    """A reference at the whole second, differences between."""
    rnd, bits, milliseconds = sky.random, Bits(), round(seconds * 1000)
    by_system = {}
    for systems, number, distance, rate, signals in sky.at(seconds):
        by_system.setdefault(systems[1], []).append((number, distance, rate, [(s[2], s[3]) for s in signals]))
    mask = 0
    for system in by_system:
        mask |= 1 << system
    bits.add(mask, 16)
    for system in sorted(by_system):
        satellites = sorted(by_system[system])
        all_signals = sorted({s for satellite in satellites for s, _ in satellite[3]})
        bits.add(sum(1 << number - 1 for number, *_ in satellites), 64).add(sum(1 << s for s in all_signals), 16)
        for _, _, _, signals in satellites:
            bits.add(sum(1 << i for i, s in enumerate(all_signals) if s in dict(signals)), len(all_signals))
        for number, distance, rate, signals in satellites:
            is_difference = milliseconds % 1000 != 0
            bits.add(is_difference, 1).add(5, 3)
            if system == 1 and not is_difference:
                bits.add(7, 5)
            for i, _ in enumerate(sorted(signals)):
                bits.add(rnd.random() < 0.9, 1).add(rnd.random() < 0.1, 1).add(rnd.randrange(400, 1200), 11).add(8, 4)
                bits.add(2, 4).add(3, 4)
                if is_difference:
                    code, carrier, doppler = 19, 16, 18 if i == 0 else 14
                    bits.add(rnd.randrange(-2 ** 17, 2 ** 17), code).add(rnd.randrange(-2 ** 14, 2 ** 14), carrier)
                    bits.add(rnd.randrange(-2 ** 12, 2 ** 12), doppler)
                elif i == 0:
                    bits.add(round(distance / 0.0005), 37).add(rnd.randrange(-2 ** 21, 2 ** 21), 23).add(round(rate * 10000), 26)
                else:
                    bits.add(rnd.randrange(-2 ** 18, 2 ** 18), 20).add(rnd.randrange(-2 ** 21, 2 ** 21), 23)
                    bits.add(rnd.randrange(-2 ** 12, 2 ** 12), 14)
    data = bits.bytes()
    return struct.pack("<I", len(data)) + data


def orbit(rnd):
    """sqrt(A), eccentricity, and the other elements in order of GPSEPHEM behind A, in radians and metres."""
    small = [rnd.uniform(-1e-5, 1e-5) for _ in range(2)] + [rnd.uniform(-300, 300) for _ in range(2)]
    small += [rnd.uniform(-1e-7, 1e-7) for _ in range(2)]
    return {"dn": rnd.uniform(3e-9, 6e-9), "m0": rnd.uniform(-3, 3), "e": rnd.uniform(0, 0.02), "w": rnd.uniform(-3, 3),
            "c": small, "i0": rnd.uniform(0.9, 1.0), "idot": rnd.uniform(-1e-9, 1e-9), "o0": rnd.uniform(-3, 3),
            "odot": rnd.uniform(-9e-9, -7e-9), "f": [rnd.uniform(-1e-4, 1e-4), rnd.uniform(-1e-11, 1e-11), 0.0]}


def make_gpsephem(rnd):
    o, toe = orbit(rnd), 511200 + 7200 * rnd.randrange(3)
    issue = rnd.randrange(256)
    return struct.pack("<IdIIIIIdd", rnd.randrange(1, 33), 512010.0, rnd.choice([0, 0, 63]), issue, issue, WEEK, WEEK, toe,
                       5153.6 ** 2 + rnd.uniform(-1e4, 1e4)) + struct.pack(
        "<14d", o["dn"], o["m0"], o["e"], o["w"], *o["c"], o["i0"], o["idot"], o["o0"], o["odot"]) + struct.pack(
        "<Idd3dIdd", issue | rnd.randrange(4) << 8, toe, rnd.uniform(-2e-8, 2e-8), *o["f"], 1, 1.458e-4,
        rnd.choice([2.0, 2.8, 4.0]) ** 2)


def make_galephemeris(rnd):
    o, toe = orbit(rnd), 511200 + 600 * rnd.randrange(12)
    bits = [rnd.randrange(2) * 3 for _ in range(3)] + [rnd.randrange(2) for _ in range(3)]
    return struct.pack("<III6BBBII", rnd.randrange(1, 37), rnd.random() < 0.8, rnd.random() < 0.8, *bits, 107, 0,
                       rnd.randrange(1024), toe) + struct.pack(
        "<16d", 5440.6 + rnd.uniform(-1, 1), o["dn"], o["m0"], o["e"], o["w"], *o["c"], o["i0"], o["idot"], o["o0"], o["odot"],
        0.0)[:-8] + struct.pack("<I3dI3ddd", toe, *o["f"], toe + 60, *[2 * f for f in o["f"]], rnd.uniform(-2e-8, 2e-8),
                                rnd.uniform(-2e-8, 2e-8))


def make_galileo_set(rnd):
    """From the issue to the delay between E1 and E5a, which I/NAV and F/NAV have in common."""
    o, toe = orbit(rnd), 511200 + 600 * rnd.randrange(12)
    return struct.pack("<HBBII", rnd.randrange(1024), 107, 3, toe, toe + 60) + struct.pack(
        "<19d", o["m0"], o["dn"], o["e"], 5440.6 + rnd.uniform(-1, 1), o["i0"], o["idot"], o["o0"], o["w"], o["odot"], *o["c"],
        *o["f"], rnd.uniform(-2e-8, 2e-8))


def make_galinavephemeris(rnd):
    health = [rnd.randrange(2) * 3, rnd.randrange(2), 0, 0, rnd.randrange(2) * 3, rnd.randrange(2), 0, 0]
    return struct.pack("<I8B", rnd.randrange(1, 37), *health) + make_galileo_set(rnd) + struct.pack("<d", rnd.uniform(-2e-8, 2e-8))


def make_galfnavephemeris(rnd):
    return struct.pack("<I4B", rnd.randrange(1, 37), rnd.randrange(2) * 3, rnd.randrange(2), 0, 0) + make_galileo_set(rnd)


def make_bdsephemeris(rnd):
    o, toe = orbit(rnd), 511200 + 3600 * rnd.randrange(2)
    number = rnd.randrange(1, 60)
    root, incline = (6493.4, o["i0"]) if number < 6 or number > 58 else (5282.6, o["i0"])
    return struct.pack("<IIdIddIIdddII", number, WEEK - 1356, rnd.choice([2.0, 2.8]), rnd.randrange(2), rnd.uniform(-2e-8, 2e-8),
                       rnd.uniform(-2e-8, 2e-8), rnd.randrange(32), toe, *o["f"], rnd.randrange(32), toe) + struct.pack(
        "<15d", root, o["e"], o["w"], o["dn"], o["m0"], o["o0"], o["odot"], incline, o["idot"], *o["c"])


def make_ionutc(rnd):
    return struct.pack("<8dIIddIIiiI", *[rnd.uniform(-1e-7, 1e-7) for _ in range(4)],
                       *[rnd.uniform(-1e5, 1e5) for _ in range(4)], WEEK, 61440, 0.0, 0.0, WEEK, 7, 18, 18, 0)


def make_rawimu(rnd, seconds, extended):
    counts = [rnd.randrange(-2 ** 30, 2 ** 30) for _ in range(6)]
    head = struct.pack("<BBH", 0, 41, WEEK) if extended else struct.pack("<I", WEEK)
    return head + struct.pack("<dI6i", seconds, 0x12345678, *counts)


def generate(seed):
    rnd, sky = random.Random(seed), Sky(seed)
    for log, make, step, count in ((43, make_range, 1000, 20), (140, make_rangecmp, 1000, 20), (1273, make_rangecmp2, 1000, 20),
                                   (2050, make_rangecmp4, 250, 40)):
        start = START_MS + 100000 * (log % 7)
        for k in range(count):
            yield long_message(log, make(sky, k * step / 1000), start + k * step)
    for k in range(300):
        yield long_message(7, make_gpsephem(rnd), START_MS)
        yield long_message(1122, make_galephemeris(rnd), START_MS)
        yield long_message(1309, make_galinavephemeris(rnd), START_MS)
        yield long_message(1310, make_galfnavephemeris(rnd), START_MS)
        yield long_message(1696, make_bdsephemeris(rnd), START_MS)
        yield long_message(8, make_ionutc(rnd), START_MS)
    for k in range(300):
        seconds = 512487 + k / 125
        yield short_message(1462, make_rawimu(rnd, seconds, True), round(seconds * 1000))
        yield short_message(325, make_rawimu(rnd, seconds + 0.001, False), round(seconds * 1000))
        yield long_message(1461, make_rawimu(rnd, seconds + 0.002, True), round(seconds * 1000))
        yield long_message(268, make_rawimu(rnd, seconds + 0.003, False), round(seconds * 1000))


def as_of_first_antenna(data):
    for _, head, raw in frames(data):
        if head == 12 or raw[6] == 0:
            yield raw
            continue
        changed = raw[:6] + b"\0" + raw[7:-4]
        yield changed + struct.pack("<I", crc32(changed))


GALILEO_SET = ("ecc m0 delta_n omega0 omega_dot i0 i_dot omega cuc cus crc crs cic cis toc af0 af1 af2 sisa e1_e5a_bgd")
EPHEMERIDES = {
    "GPSEPHEM": "satellite_id tow health7 iode1 iodc toe toc a ecc m0 delta_n omega0 omega_dot i0 i_dot omega cuc cus crc crs cic "
                "cis af0 af1 af2 tgd eph_var",
    "GALEPHEMERIS": "sat_id fnav_received inav_received e1_b_health e5a_health e5b_health e1_bdvs e5a_dvs e5b_dvs iod_nav t0e "
                    "root_a ecc m0 delta_n omega0 omega_dot i0 i_dot omega cuc cus crc crs cic cis fnavt0c fnav_af0 fnav_af1 "
                    "fnav_af2 inavt0c inav_af0 inav_af1 inav_af2 e1_e5a_bgd e1_e5b_bgd",
    "GALINAVEPHEMERIS": "sat_id e5b_health e5b_dvs e1b_health e1b_dvs io_dnav toe root_a " + GALILEO_SET + " e1_e5b_bgd",
    "GALFNAVEPHEMERIS": "sat_id e5a_health e5a_dvs io_dnav toe root_a " + GALILEO_SET,
    "BDSEPHEMERIS": "satellite_id sat_h1 iode iodc toe toc root_a eccentricity m0 delta_n omega0 omega_dot i0 i_dot omega cuc cus crc crs "
                    "cic cis a0 a1 a2 tgd1 tgd2 ura",
    "IONUTC": "a0 a1 a2 a3 b0 b1 b2 b3"}
# Letter of a system, and the RINEX code of each of its signals, by the numbers of the tracking status.
SYSTEMS = {0: ("G", {0: "1C", 5: "2P", 9: "2W", 14: "5Q", 16: "1L", 17: "2S"}),
           3: ("E", {2: "1C", 6: "6B", 7: "6C", 12: "5Q", 17: "7Q", 20: "8Q"}),
           4: ("C", {0: "2I", 1: "7I", 2: "6I", 4: "2I", 5: "7I", 6: "6I", 7: "1P", 9: "5P", 11: "7D"})}
SAMPLE = "gps_week gps_seconds accel_z accel_y accel_x gyro_z gyro_y gyro_x"


def numbers(message, names):
    return " ".join(repr(float(getattr(message, name))) for name in names.split())


def print_fields(path):
    from novatel_edie import oem
    with open(path, "rb") as file:
        data = file.read()
    parser = oem.Parser()
    parser.decompress_range_cmp = True
    for raw in as_of_first_antenna(data):
        parser.write(raw)
        for message in parser:
            name = type(message).__name__.split("_")[0]
            if name == "RANGE":
                for o in message.obs:
                    letter, codes = SYSTEMS.get(o.c_status >> 16 & 7, ("-", {}))
                    print("O", message.header.week, round(message.header.milliseconds), f"{letter}{o.sv_prn:02d}",
                          codes.get(o.c_status >> 21 & 31, "-"), repr(o.psr), repr(-o.adr), repr(o.dop), repr(o.C_No),
                          repr(o.lock_time), 1 - (o.c_status >> 11 & 1))
            elif name in EPHEMERIDES:
                print(name, numbers(message, EPHEMERIDES[name]))
            elif name.startswith("RAWIMU"):
                print("RAWIMU", numbers(message, SAMPLE))


EXAMPLES = (
    "GALINAVEPHEMERISA,USB1,21,54.0,SATTIME,2209,504514.000,02000020,dbe9,16809;2,0,0,0,0,0,0,0,0,68,107,3,501600,501600,"
    "1.94195529e+00,3.0676e-09,3.055053530e-04,5.44060316e+03,9.740321573e-01,5.6931e-10,6.473214246e-01,3.503504077e-01,"
    "-5.8141708e-09,7.6238e-06,4.7404e-06,2.409e+02,1.610e+02,-5.0291e-08,2.9802e-08,2.989528002e-04,2.359002e-12,0.0,"
    "-6.985e-10,-1.630e-09*96bd12ad",
    "GALFNAVEPHEMERISA,USB1,21,35.5,SATTIME,2209,504150.000,02000020,02cd,16809;2,0,0,0,0,68,107,0,501600,501600,"
    "1.94195529e+00,3.0676e-09,3.055053530e-04,5.44060316e+03,9.740321573e-01,5.6931e-10,6.473214246e-01,3.503504077e-01,"
    "-5.8141708e-09,7.6238e-06,4.7404e-06,2.409e+02,1.610e+02,-5.0291e-08,2.9802e-08,2.989536151e-04,2.359002e-12,0.0,"
    "-6.985e-10*e65b02c5")


def examples():
    import novatel_edie
    from novatel_edie import oem
    parser = oem.Parser()
    for text in EXAMPLES:
        parser.write(f"#{text}\r\n".encode())
    for message in parser:
        yield bytes(message.encode(novatel_edie.ENCODE_FORMAT.BINARY).message)


def main():
    if sys.argv[1:] == ["--have"]:
        import novatel_edie  # noqa: F401
    elif len(sys.argv) == 3 and sys.argv[1] == "fields":
        print_fields(sys.argv[2])
        # The package complains at its own end; what was asked for is printed.
        sys.stdout.flush()
    elif sys.argv[1:] == ["examples"]:
        sys.stdout.buffer.write(b"".join(examples()))
        sys.stdout.flush()
    elif len(sys.argv) == 3 and sys.argv[1] == "generate":
        sys.stdout.buffer.write(b"".join(generate(int(sys.argv[2]))))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
