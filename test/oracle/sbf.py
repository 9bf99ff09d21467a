#!/usr/bin/env python3
"""What the PyPI package pysbf2 reads in SBF blocks, as an oracle for drivers/sbf, and blocks to read.

  sbf.py fields FILE         one line of numbers for each measurement, ephemeris and set of coefficients
  sbf.py generate SEED >OUT  blocks of every kind that leonav reads, with random fields, packed by the guide's tables
  sbf.py transcode FILE >OUT the subframes of a u-blox recording as blocks of raw navigation bits
  sbf.py cnav FILE >OUT      its CNAV and B-CNAV2 as blocks GPSRawL2C, GPSRawL5 and BDSRawB2a
  sbf.py has FILE >OUT       lines of pages of Galileo HAS (E6-B) as blocks GALRawCNAV
  sbf.py b2b FILE >OUT       lines of pages of PPP-B2b as blocks BDSRawB2b, between which are some of B-CNAV3
  sbf.py --have              exits 0 if pysbf2 is there
"""
import math
import random
import struct
import sys

WEEK, START_MS = 2367, 482321000
LIGHT = 299792458.0


def crc16(data):
    """CCITT, begun with 0, bit by bit."""
    crc = 0
    for byte in data:
        for k in range(7, -1, -1):
            feedback = crc >> 15 ^ byte >> k & 1
            crc = crc << 1 & 0xFFFF ^ (0x1021 if feedback else 0)
    return crc


def block(number, payload, milliseconds, revision=0, week=WEEK):
    body = struct.pack("<IH", milliseconds, week) + payload
    body += b"\xa5" * (-(8 + len(body)) % 4)
    covered = struct.pack("<HH", number | revision << 13, 8 + len(body)) + body
    return b"$@" + struct.pack("<H", crc16(covered)) + covered


# Numbers of the guide's table of signals with their carriers in MHz; satellites from first to last of each system.
SIGNALS = {
    "G": {0: 1575.42, 1: 1575.42, 2: 1227.6, 3: 1227.6, 4: 1176.45, 5: 1575.42},
    "E": {17: 1575.42, 19: 1278.75, 20: 1176.45, 21: 1207.14, 22: 1191.795},
    "C": {13: 1575.42, 14: 1176.45, 28: 1561.098, 29: 1207.14, 30: 1268.52, 34: 1207.14},
    "R": {8: 1602.0, 9: 1602.0, 10: 1246.0, 11: 1246.0, 12: 1202.025},
    "J": {6: 1575.42, 7: 1227.6, 26: 1176.45, 32: 1575.42, 38: 1575.42},
    "S": {24: 1575.42, 25: 1176.45}}
SATELLITES = {"G": (1, 37), "E": (71, 106), "C": (141, 180), "C more": (223, 245), "R": (38, 61), "J": (181, 187), "S": (120, 140)}


def type_and_info(rnd, signal, half, antenna):
    """The bytes of signal and antenna, and of the observation's state."""
    low, high = (31, signal - 32) if signal >= 32 else (signal, 0)
    return low | antenna << 5, rnd.randrange(2) | half << 2 | high << 3


def make_meas_epoch(rnd, flags):
    """Masters with slaves, of every system; any value may be marked as not available."""
    longer = rnd.choice([0, 0, 4])
    body, count = b"", 0
    for system, (first, last) in SATELLITES.items():
        for satellite in rnd.sample(range(first, last + 1), 4):
            signals = rnd.sample(sorted(SIGNALS[system[0]]), rnd.randrange(1, len(SIGNALS[system[0]]) + 1))
            count += 1
            code = 0 if rnd.random() < 0.03 else rnd.randrange(20_000_000_000, 45_000_000_000)
            doppler = -2 ** 31 if rnd.random() < 0.05 else rnd.randrange(-60_000_000, 60_000_000)
            low, high = (0, -128) if rnd.random() < 0.05 else (rnd.randrange(65536), rnd.randrange(-127, 128))
            kind, info = type_and_info(rnd, signals[0], rnd.random() < 0.1, rnd.choice([0, 0, 0, 0, 1]))
            body += struct.pack("<BBBBIiHbBHBB", rnd.randrange(1, 200), kind, satellite, code >> 32 | 0xA0, code & 0xFFFFFFFF, doppler,
                                low, high, rnd.choice([255] + [rnd.randrange(60, 200)] * 9),
                                rnd.choice([65535] + [rnd.randrange(65535)] * 9), info, len(signals) - 1) + b"\x77" * longer
            for signal in signals[1:]:
                code_low, code_high = (0, -4) if rnd.random() < 0.05 else (rnd.randrange(65536), rnd.randrange(-4, 4))
                doppler_low, doppler_high = (0, -16) if rnd.random() < 0.05 else (rnd.randrange(65536), rnd.randrange(-16, 16))
                low, high = (0, -128) if rnd.random() < 0.05 else (rnd.randrange(65536), rnd.randrange(-127, 128))
                kind, info = type_and_info(rnd, signal, rnd.random() < 0.1, rnd.choice([0, 0, 0, 0, 2]))
                body += struct.pack("<BBBBbBHHH", kind, rnd.choice([255] + [rnd.randrange(255)] * 9),
                                    rnd.choice([255] + [rnd.randrange(60, 200)] * 9), code_high & 7 | (doppler_high & 31) << 3, high,
                                    info, code_low, low, doppler_low) + b"\x77" * longer
    return struct.pack("<BBBBBB", count, 20 + longer, 12 + longer, flags, rnd.randrange(256), 0) + body


def orbit(rnd):
    """Elements in the units of the blocks, semicircles and metres, as the receivers' single precision holds them."""
    return {"crs": rnd.uniform(-300, 300), "dn": rnd.uniform(1e-9, 2e-9), "m0": rnd.uniform(-1, 1), "cuc": rnd.uniform(-1e-5, 1e-5),
            "e": rnd.uniform(0, 0.02), "cus": rnd.uniform(-1e-5, 1e-5), "cic": rnd.uniform(-1e-7, 1e-7),
            "o0": rnd.uniform(-1, 1), "cis": rnd.uniform(-1e-7, 1e-7), "i0": rnd.uniform(0.29, 0.32), "crc": rnd.uniform(100, 300),
            "w": rnd.uniform(-1, 1), "odot": rnd.uniform(-3e-9, -2e-9), "idot": rnd.uniform(-3e-10, 3e-10)}


def elements(rnd, toc, toe, root):
    o = orbit(rnd)
    return struct.pack("<I5fdfdfdIfdfdfdff", toc, 0.0, rnd.uniform(-1e-11, 1e-11), rnd.uniform(-1e-4, 1e-4), o["crs"], o["dn"],
                       o["m0"], o["cuc"], o["e"], o["cus"], root, toe, o["cic"], o["o0"], o["cis"], o["i0"], o["crc"], o["w"],
                       o["odot"], o["idot"])


def make_gpsnav(rnd):
    issue, toe = rnd.randrange(256), 482400 + 7200 * rnd.randrange(-1, 2)
    head = struct.pack("<BBHBBBBHBBBBf", rnd.randrange(1, 33), 0, WEEK % 1024, 1, rnd.randrange(16), rnd.choice([0, 0, 63]), 0,
                       issue | rnd.randrange(4) << 8, issue, issue, 0, 0, rnd.uniform(-2e-8, 2e-8))
    return head + elements(rnd, toe, toe, 5153.6 + rnd.uniform(-1, 1)) + struct.pack("<HH", WEEK % 1024, WEEK % 1024)


def make_bdsnav(rnd):
    number, toe = rnd.randrange(1, 62), 482400 + 3600 * rnd.randrange(-1, 2)
    satellite = number + 140 if number <= 40 else number + 182
    b2i = -2e10 if number > 18 and rnd.random() < 0.2 else rnd.uniform(-2e-8, 2e-8)
    head = struct.pack("<BBHBBBBHff", satellite, 0, WEEK - 1356, rnd.randrange(16), rnd.randrange(2), rnd.randrange(32),
                       rnd.randrange(32), 0, rnd.uniform(-2e-8, 2e-8), b2i)
    root = 6493.4 if number < 6 or number > 58 else 5282.6
    return head + elements(rnd, toe, toe, root) + struct.pack("<HH", WEEK - 1356, WEEK - 1356)


def make_galnav(rnd):
    o, toe, source = orbit(rnd), 482400 + 600 * rnd.randrange(-6, 6), rnd.choice([2, 16])
    valid = 0x111 if rnd.random() < 0.7 else rnd.choice([0x011, 0x100])
    health = valid | rnd.choice([0, 0, rnd.randrange(4096) & 0xEEE])
    # What the other message would tell may be missing; both delays are in I/NAV.
    accuracy = [255 if rnd.random() < 0.2 else 107 for _ in range(2)]
    delays = [rnd.uniform(-2e-8, 2e-8), -2e10 if source == 16 else rnd.uniform(-2e-8, 2e-8)]
    return struct.pack("<BB6d9f", rnd.randrange(71, 107), source, 5440.6 + rnd.uniform(-1, 1), o["m0"], o["e"], o["i0"], o["w"],
                       o["o0"], o["odot"], o["idot"], o["dn"], o["cuc"], o["cus"], o["crc"], o["crs"], o["cic"], o["cis"]) + struct.pack(
        "<IIffdHHHHBBBBfffB", toe, toe + 60, 0.0, rnd.uniform(-1e-11, 1e-11), rnd.uniform(-1e-3, 1e-3), WEEK, WEEK,
        rnd.randrange(1024), health, 255, *accuracy, 255, *delays, -2e10, 255)


def make_gpsion(rnd):
    return struct.pack("<BB8f", rnd.randrange(1, 33), 0, *[rnd.uniform(-1e-7, 1e-7) for _ in range(4)],
                       *[rnd.uniform(-1e5, 1e5) for _ in range(4)])


def generate(seed):
    rnd = random.Random(seed)
    for k in range(20):
        yield block(4027, make_meas_epoch(rnd, rnd.choice([0x01, 0x4D])), START_MS + 1000 * k, revision=1)
    for k in range(300):
        yield block(5891, make_gpsnav(rnd), START_MS)
        yield block(4002, make_galnav(rnd), START_MS)
        yield block(4081, make_bdsnav(rnd), START_MS)
        yield block(5893, make_gpsion(rnd), START_MS)


def ubx_messages(data):
    """Class and number together, and the payload, of messages with a good checksum."""
    at = 0
    while (at := data.find(b"\xb5\x62", at)) >= 0 and at + 8 <= len(data):
        end = at + 6 + struct.unpack_from("<H", data, at + 4)[0]
        a = b = 0
        for byte in data[at + 2:end]:
            a = a + byte & 255
            b = b + a & 255
        if data[end:end + 2] == bytes([a, b]):
            yield data[at + 2] << 8 | data[at + 3], data[at + 6:end]
            at = end + 2
        else:
            at += 1


def bits_of(words, count):
    return "".join(format(word & (1 << count) - 1, f"0{count}b") for word in words)


def words_of(bits, count):
    bits = bits.ljust(32 * count, "0")
    return struct.pack(f"<{count}I", *(int(bits[32 * i:32 * i + 32], 2) for i in range(count)))


def as_block(system, number, signal, words, now):
    """The same bits as Septentrio arranges them; None for messages that have no block here."""
    def raw(kind, satellite, source, bits):
        return block(kind, struct.pack("<BBBBBB", satellite, 1, 0, source, 0, 7) + bits, *now)
    if system == 0 and signal == 0 and len(words) == 10:
        return raw(4017, number, 0, struct.pack("<10I", *(word & 0x3FFFFFFF for word in words)))
    if system == 2 and signal in (1, 5) and len(words) == 8:
        page = bits_of(words, 32)
        return raw(4023, number + 70, 17 if signal == 1 else 21, words_of(page[:114] + page[128:248], 8))
    if system == 2 and signal == 3 and len(words) == 8:
        return raw(4022, number + 70, 20, words_of(bits_of(words, 32)[:244], 8))
    if system == 3 and len(words) == 10 and signal in (0, 1, 2, 3, 4, 10):
        source = 28 if signal < 2 else 29 if signal < 4 else 30
        return raw(4047, number + (140 if number <= 40 else 182), source, words_of(bits_of(words, 30), 10))
    return None


def as_cnav_block(system, number, signal, words, now):
    """The same of CNAV and B-CNAV2, whose code behind the bits is random: nobody reads it."""
    if system == 0 and signal in (3, 4, 6, 7) and len(words) == 10:
        name, kind, satellite, source = (("GPSRawL2C", 4018, number, 3) if signal < 5 else ("GPSRawL5", 4019, number, 4))
        bits, count = bits_of(words, 32)[:300], 10
    elif system == 3 and signal in (7, 8) and len(words) == 9:
        name, kind, satellite, source = "BDSRawB2a", 4219, number + (140 if number <= 40 else 182), 14
        bits, count = bits_of(words, 32) + format(random.Random(number).getrandbits(288), "0288b"), 18
    else:
        return None
    made = block(kind, struct.pack("<BBBBBB", satellite, 1, 0, source, 0, 7) + words_of(bits, count), *now)
    head = {"TOW": now[0], "WNc": now[2], "SVID": satellite, "CRCPassed": 1, "SigIdx": source, "RxChannel": 7}
    check_by_pysbf2(name, made, head, words_of(bits, count))
    return made


def transcode(path, arrange=as_block):
    with open(path, "rb") as file:
        data = file.read()
    now = None
    for kind, payload in ubx_messages(data):
        if kind == 0x0215:
            tow, week = struct.unpack_from("<dH", payload)
            now = (round(tow * 1000), 0, week)
        elif kind == 0x0213 and now:
            system, number, signal, _, count = struct.unpack_from("<5B", payload)
            made = arrange(system, number, signal, struct.unpack_from(f"<{count}I", payload, 8), now)
            if made:
                yield made


def check_by_pysbf2(name, made, head, words):
    """Packs one block by pysbf2 too, where it is there; both must agree in every byte."""
    try:
        from pysbf2 import SBFMessage
    except ImportError:
        return
    if SBFMessage(name, NavBits=words, scaling=False, **head).serialize() != made:
        sys.exit(f"pysbf2 packs {name} otherwise")


def page_blocks(service, path):
    """Pages as Septentrio hands them out. Symbols of the code behind a page of PPP-B2b are random: nobody reads them."""
    rnd, at = random.Random(1), 0
    for line in open(path):
        week, second, satellite, _, _, text = line.split()
        week, second, satellite = int(week), int(second), int(satellite)
        bits = bin(int("1" + text, 16))[3:]
        at += 1
        if service == "has":
            name, number, source, count = "GALRawCNAV", satellite + 70, 19, 16
            words = words_of(bits[:492], count)
            head = {"ViterbiCnt": 0, "FreqNr": 0}
        else:
            # The seconds of these files are BeiDou's, 14 s behind those of the block.
            second += 14
            name, number, source, count = "BDSRawB2b", satellite + (140 if satellite <= 40 else 182), 34, 31
            frame = f"{satellite:06b}000000" + bits[:486] + format(rnd.getrandbits(486), "0486b")
            words = words_of(frame, count)
            head = {"Reserved1": 0, "Reserved2": 0}
            if at % 100 == 0:  # another satellite's navigation message on the same signal
                yield block(4242, struct.pack("<BBBBBB", 160, 1, 0, source, 0, 9) + words, second * 1000, week=week)
        made = block(4024 if service == "has" else 4242, struct.pack("<BBBBBB", number, 1, 0, source, 0, 9) + words,
                     second * 1000, week=week)
        if at % 100 == 1:
            check_by_pysbf2(name, made, dict(head, TOW=second * 1000, WNc=week, SVID=number, CRCPassed=1, SigIdx=source,
                                             RxChannel=9), words)
        yield made


def name_of(satellite):
    for system, first, last, offset in (("G", 1, 37, 0), ("E", 71, 106, 70), ("C", 141, 180, 140), ("C", 223, 245, 182)):
        if first <= satellite <= last:
            return f"{system}{satellite - offset:02d}"
    return "-"


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value


def print_measurements(message):
    """The guide's formulas on the whole numbers that pysbf2 finds, with its table of signals."""
    from pysbf2.sbftypes_decodes import SIGNAL_TYPE
    def describe(suffix):
        low, high = getattr(message, "SigIdxLo" + suffix), getattr(message, "SigIdxHi" + suffix)
        number = high + 32 if low == 31 else low
        _, system, megahertz, code = SIGNAL_TYPE.get(number, ("", "", 0, ""))
        if number == 0:
            megahertz = 1575.42  # the package's table has a digit less here alone
        if code == "6C/6B":
            code = "6B" if message.E6BUsed else "6C"
        letter = {"GPS": "G", "Galileo": "E", "BeiDou": "C"}.get(system, "-")
        return number, letter, megahertz * 1e6, code
    def show(suffix, satellite, code_m, doppler, ceiling):
        number, letter, frequency, code = describe(suffix)
        if getattr(message, "AntennaID" + suffix) != 0 or satellite == "-" or letter != satellite[0]:
            return
        high, low = getattr(message, "CarrierMSB" + suffix), getattr(message, "CarrierLSB" + suffix)
        carrier = math.nan if high == -128 and low == 0 else code_m / (LIGHT / frequency) + (high * 65536 + low) * 0.001
        strength, lock = getattr(message, "CN0" + suffix), getattr(message, "LockTime" + suffix)
        cn0 = math.nan if strength == 255 else strength * 0.25 + (0 if number in (1, 2) else 10)
        print("O", message.WNc, message.TOW, satellite, code, repr(code_m), repr(carrier), repr(doppler), repr(cn0),
              "nan" if lock > ceiling else lock, getattr(message, "HalfCycleAmbiguity" + suffix))
    for i in range(1, message.N1 + 1):
        suffix = f"_{i:02d}"
        satellite = name_of(getattr(message, "SVID" + suffix))
        whole = getattr(message, "CodeMSB" + suffix) << 32 | getattr(message, "CodeLSB" + suffix)
        code_m = whole * 0.001 if whole else math.nan
        raw = getattr(message, "Doppler" + suffix)
        doppler = math.nan if raw == -2 ** 31 else raw * 0.0001
        show(suffix, satellite, code_m, doppler, 65534)
        for k in range(1, getattr(message, "N2" + suffix) + 1):
            slave = f"{suffix}_{k:02d}"
            high, low = signed(getattr(message, "CodeOffsetMSB" + slave), 3), getattr(message, "CodeOffsetLSB" + slave)
            slave_m = math.nan if high == -4 and low == 0 else code_m + (high * 65536 + low) * 0.001
            high, low = signed(getattr(message, "DopplerOffsetMSB" + slave), 5), getattr(message, "DopplerOffsetLSB" + slave)
            ratio = describe(slave)[2] / describe(suffix)[2] if describe(suffix)[2] else math.nan
            slave_doppler = math.nan if high == -16 and low == 0 else doppler * ratio + (high * 65536 + low) * 1e-4
            show(slave, satellite, slave_m, slave_doppler, 254)


ORBIT = "SQRT_A e M_0 DEL_N OMEGA_0 OMEGADOT i_0 IDOT omega C_uc C_us C_rc C_rs C_ic C_is a_f0 a_f1 a_f2"
EPHEMERIDES = {
    "GPSNav": "PRN URA health IODC IODE2 t_oe t_oc " + ORBIT + " T_gd",
    "BDSNav": "PRN URA SatH1 IODC IODE t_oe t_oc " + ORBIT + " T_GD1 T_GD2",
    "GALNav": "SVID Source IODnav t_oe t_oc " + ORBIT + " BGD_L1E5a BGD_L1E5b SISA_L1E5a SISA_L1E5b L1-BHealth L1-Bdvs L1-Bhs "
              "E5bHealth E5bdvs E5bhs E5aHealth E5advs E5ahs",
    "GPSIon": "alpha_0 alpha_1 alpha_2 alpha_3 beta_0 beta_1 beta_2 beta_3"}


def print_fields(path):
    from pysbf2 import SBFReader
    with open(path, "rb") as file:
        for _, message in SBFReader(file, protfilter=2, scaling=False, quitonerror=2):
            name = message.identity
            if name == "MeasEpoch":
                print_measurements(message)
            elif name in EPHEMERIDES:
                print(name, " ".join(repr(float(getattr(message, field))) for field in EPHEMERIDES[name].split()))


def main():
    if sys.argv[1:] == ["--have"]:
        import pysbf2  # noqa: F401
    elif len(sys.argv) == 3 and sys.argv[1] == "fields":
        print_fields(sys.argv[2])
    elif len(sys.argv) == 3 and sys.argv[1] == "generate":
        sys.stdout.buffer.write(b"".join(generate(int(sys.argv[2]))))
    elif len(sys.argv) == 3 and sys.argv[1] == "transcode":
        sys.stdout.buffer.write(b"".join(transcode(sys.argv[2])))
    elif len(sys.argv) == 3 and sys.argv[1] == "cnav":
        sys.stdout.buffer.write(b"".join(transcode(sys.argv[2], as_cnav_block)))
    elif len(sys.argv) == 3 and sys.argv[1] in ("has", "b2b"):
        sys.stdout.buffer.write(b"".join(page_blocks(*sys.argv[1:])))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
