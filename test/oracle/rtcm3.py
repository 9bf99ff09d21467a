#!/usr/bin/env python3
"""What the PyPI package pyrtcm reads in RTCM 3 bytes, as an oracle for drivers/rtcm3.

  rtcm3.py fields FILE                 one line of numbers for each measurement, ephemeris, position, equipment, and satellite
                                       of corrections
  rtcm3.py split FILE NUMBER... >OUT   the frames with these message numbers, each MSM marked as the last of its epoch, so
                                       that programs which expect all systems at one time accept each by itself
  rtcm3.py --have                      exits 0 if pyrtcm is there

Numbers are printed so that they are read back to the last bit. Lock times come from the tables of the standard written
out, not from a formula.
"""
import math
import sys

LIGHT = 299792458.0
FUNDAMENTAL = 10.23e6
MULTIPLES = {"G": {"1": 154.0, "2": 120.0, "5": 115.0},
             "E": {"1": 154.0, "5": 115.0, "7": 118.0, "8": 116.5, "6": 125.0},
             "C": {"1": 154.0, "2": 152.6, "5": 115.0, "6": 124.0, "7": 118.0}}
LETTERS = {"107": "G", "109": "E", "112": "C"}
EPOCH = {"G": "DF004", "E": "DF248", "C": "DF427"}
LOCK_MS = [0, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536, 131072, 262144, 524288]
# RTCM 10403.3, table 3.5-75: first indicator of a range, factor, and what is taken off.
LOCK_EXTENDED = [(0, 1, 0), (64, 2, 64), (96, 4, 256), (128, 8, 768), (160, 16, 2048), (192, 32, 5120), (224, 64, 12288),
                 (256, 128, 28672), (288, 256, 65536), (320, 512, 147456), (352, 1024, 327680), (384, 2048, 720896),
                 (416, 4096, 1572864), (448, 8192, 3407872), (480, 16384, 7340032), (512, 32768, 15728640),
                 (544, 65536, 33554432), (576, 131072, 71303168), (608, 262144, 150994944), (640, 524288, 318767104),
                 (672, 1048576, 671088640), (704, 2097152, 1409286144)]


def frames(path):
    from pyrtcm import RTCMReader
    with open(path, "rb") as file:
        for raw, message in RTCMReader(file, labelmsm=1, quitonerror=0):
            if raw is not None and hasattr(message, "identity"):
                yield raw, message


def get(message, name, *indices):
    return getattr(message, name + "".join(f"_{i:02d}" for i in indices))


def whole(value, power=0, unit=None):
    """The number that stands in the message, from the scaled one."""
    return round(value / unit) if unit else round(value * 2.0 ** power)


def lock_of(indicator, extended):
    if not extended:
        return LOCK_MS[indicator]
    indicator = min(indicator, 704)  # what is above is reserved
    row = [r for r in LOCK_EXTENDED if r[0] <= indicator][-1]
    return indicator * row[1] - row[2]


def measured(value, bits):
    return value if value != -(1 << (bits - 1)) else None


def print_observations(message):
    number = message.identity
    letter, form = LETTERS[number[:3]], int(number[3])
    fine, rate = form >= 6, form in (5, 7)
    satellites = {get(message, "PRN", i): i for i in range(1, message.NSat + 1)}
    for cell in range(1, message.NCell + 1):
        prn, code = get(message, "CELLPRN", cell), get(message, "CELLSIG", cell)
        i = satellites[prn]
        wavelength = LIGHT / (MULTIPLES[letter][code[0]] * FUNDAMENTAL)
        rough = get(message, "DF397", i) + get(message, "DF398", i)
        have_rough = get(message, "DF397", i) != 255
        code_bits, code_power = (20, 29) if fine else (15, 24)
        phase_bits, phase_power = (24, 31) if fine else (22, 29)
        fine_code = get(message, "DF405" if fine else "DF400", cell)
        fine_phase = get(message, "DF406" if fine else "DF401", cell)
        values = [math.nan] * 4
        if have_rough and measured(whole(fine_code, code_power), code_bits) is not None:
            values[0] = (rough + fine_code) * (LIGHT / 1e3)
        if have_rough and measured(whole(fine_phase, phase_power), phase_bits) is not None:
            values[1] = (rough + fine_phase) * (LIGHT / 1e3) / wavelength
        if rate:
            rough_rate = measured(get(message, "DF399", i), 14)
            fine_rate = measured(whole(get(message, "DF404", cell), unit=0.0001), 15)
            if rough_rate is not None and fine_rate is not None:
                values[2] = -((rough_rate * 10000 + fine_rate) / 10000) / wavelength
        strength = get(message, "DF408" if fine else "DF403", cell)
        values[3] = float(strength) if strength else math.nan
        lock = lock_of(get(message, "DF407" if fine else "DF402", cell), fine)
        print("O", number, getattr(message, EPOCH[letter]), message.DF393, f"{letter}{int(prn):02d}", code,
              *(repr(value) for value in values), lock, get(message, "DF420", cell))


PI = math.pi
# Fields in the order of leonav's ephemeris, with the factor that makes them SI units and radians.
EPHEMERIDES = {
    "1019": ("G", "DF009", "DF076", [
        ("DF093", 1), ("DF081", 1), ("DF071", 1), ("DF085", 1), ("DF102", 1), ("DF092", 1), ("DF090", 1), ("DF088", PI),
        ("DF087", PI), ("DF095", PI), ("DF100", PI), ("DF097", PI), ("DF079", PI), ("DF099", PI), ("DF089", 1), ("DF091", 1),
        ("DF098", 1), ("DF086", 1), ("DF094", 1), ("DF096", 1), ("DF084", 1), ("DF083", 1), ("DF082", 1), ("DF101", 1),
        (None, 0)]),
    "1042": ("C", "DF488", "DF489", [
        ("DF505", 1), ("DF493", 1), ("DF492", 1), ("DF497", 1), ("DF515", 1), ("DF504", 1), ("DF502", 1), ("DF500", PI),
        ("DF499", PI), ("DF507", PI), ("DF512", PI), ("DF509", PI), ("DF491", PI), ("DF511", PI), ("DF501", 1), ("DF503", 1),
        ("DF510", 1), ("DF498", 1), ("DF506", 1), ("DF508", 1), ("DF496", 1), ("DF495", 1), ("DF494", 1),
        ("DF513", 1e-9), ("DF514", 1e-9)]),
    "1045": ("E", "DF252", "DF289", [
        ("DF304", 1), ("DF293", 1), ("DF290", 1), (None, 0), (None, 0), ("DF303", 1), ("DF301", 1), ("DF299", PI),
        ("DF298", PI), ("DF306", PI), ("DF311", PI), ("DF308", PI), ("DF292", PI), ("DF310", PI), ("DF300", 1), ("DF302", 1),
        ("DF309", 1), ("DF297", 1), ("DF305", 1), ("DF307", 1), ("DF296", 1), ("DF295", 1), ("DF294", 1), ("DF312", 1),
        (None, 0)])}
EPHEMERIDES["1046"] = ("E", "DF252", "DF289", EPHEMERIDES["1045"][3][:24] + [("DF313", 1)])


def print_ephemeris(message):
    letter, satellite, week, fields = EPHEMERIDES[message.identity]
    values = [getattr(message, name) * factor if name else 0 for name, factor in fields]
    if message.identity == "1045":
        values[4] = message.DF315 << 3 | message.DF314 << 4
    if message.identity == "1046":
        values[4] = message.DF288 | message.DF287 << 1 | message.DF317 << 6 | message.DF316 << 7
    print("E", message.identity, f"{letter}{getattr(message, satellite):02d}", getattr(message, week),
          *(repr(float(value)) for value in values))


SSR_KINDS = {"1057": "G o", "1058": "G c", "1059": "G b", "1060": "G oc", "1061": "G a", "1062": "G h",
             "1240": "E o", "1241": "E c", "1242": "E b", "1243": "E oc", "1244": "E a", "1245": "E h",
             "1258": "C o", "1259": "C c", "1260": "C b", "1261": "C oc", "1262": "C a", "1263": "C h"}
for first, system in ((20, "G"), (60, "E"), (100, "C")):
    for offset, kind in enumerate(("o", "c", "oc", "h", "b", "p", "a"), 1):
        SSR_KINDS[f"4076_{first + offset:03d}"] = f"{system} {kind}"
SSR_HIGHEST = {"G": 63, "E": 50, "C": 63}
SSR_SIGNALS = {"G": "1C 1P 1W 1Y 1M 2C 2D 2S 2L 2X 2P 2W 2Y 2M 5I 5Q 5X 1S 1L 1X".split(),
               "E": "1A 1B 1C 1X 1Z 5I 5Q 5X 7I 7Q 7X 8I 8Q 8X 6A 6B 6C 6X 6Z".split(),
               "C": "2I 2Q 2X 6I 6Q 6X 7I 7Q 7X 1D 1P 1X 5D 5P 5X".split()}
# Names of the fields: of RTCM by system, of the IGS.
SSR_SATELLITE = {"G": "DF068", "E": "DF252", "C": "DF488", "I": "IDF011"}
SSR_ISSUE = {"G": "DF071", "E": "DF459", "C": "DF471", "I": "IDF012"}
SSR_SIGNAL = {"G": "DF380", "E": "DF382", "C": "DF467", "I": "IDF024"}
SSR_EPOCH = {"G": "DF385", "E": "DF458", "C": "DF465", "I": "IDF003"}
SSR_HEADER = {False: ("DF391", "DF388", "DF413", "DF414", "DF415", "DF387"),
              True: ("IDF004", "IDF005", "IDF007", "IDF008", "IDF009", "IDF010")}
# Field of RTCM and of the IGS, pyrtcm's unit of it, and the unit in 10^-7 m (a fifth for the drift's rate).
SSR_ORBIT = (("DF365", "IDF013", 0.1, 1000), ("DF366", "IDF014", 0.4, 4000), ("DF367", "IDF015", 0.4, 4000),
             ("DF368", "IDF016", 0.001, 10), ("DF369", "IDF017", 0.004, 40), ("DF370", "IDF018", 0.004, 40))
SSR_CLOCK = (("DF376", "IDF019", 0.1, 1000), ("DF377", "IDF020", 0.001, 10), ("DF378", "IDF021", 0.00002, 0.2))


def ssr_values(message, fields, igs, index):
    values = []
    for rtcm, igs_name, unit, unit_e7 in fields:
        number = whole(get(message, igs_name if igs else rtcm, index), unit=unit)
        values.append(repr(number * 2.0 / 1e8 if unit_e7 == 0.2 else number * unit_e7 / 1e7))
    return values


def print_ssr(message):
    number = message.identity
    system, kind = SSR_KINDS[number].split()
    igs = number.startswith("4076")
    names = "I" if igs else system
    head = [number, getattr(message, SSR_EPOCH[names])] + [getattr(message, name) for name in SSR_HEADER[igs][:5]]
    for i in range(1, getattr(message, SSR_HEADER[igs][5]) + 1):
        satellite = get(message, SSR_SATELLITE[names], i)
        if not 1 <= satellite <= SSR_HIGHEST[system]:
            continue
        line = ["S"] + head + [f"{system}{satellite:02d}"]
        if "o" in kind:
            toe = get(message, "DF470", i) // 8 if names == "C" else -1
            line += ["o", get(message, SSR_ISSUE[names], i), toe] + ssr_values(message, SSR_ORBIT, igs, i)
        if "c" in kind:
            line += ["c"] + ssr_values(message, SSR_CLOCK, igs, i)
        if kind == "h":
            line += ["h", repr(whole(get(message, "IDF022" if igs else "DF390", i), unit=0.1) * 1000 / 1e7)]
        if kind == "a":
            line += ["a", get(message, "IDF034" if igs else "DF389", i)]
        if kind == "p":
            line += ["y", repr(get(message, "IDF026", i) * PI), repr(get(message, "IDF027", i) * PI)]
        for k in range(1, get(message, "IDF023" if igs else "DF379", i) + 1 if kind in "bp" else 1):
            signal = get(message, SSR_SIGNAL[names], i, k)
            if signal >= len(SSR_SIGNALS[system]):
                continue
            line += [kind, SSR_SIGNALS[system][signal]]
            if kind == "b":
                line += [repr(whole(get(message, "IDF025" if igs else "DF383", i, k), unit=0.01) * 100000 / 1e7)]
            else:
                line += [get(message, "IDF029", i, k), get(message, "IDF030", i, k), get(message, "IDF031", i, k),
                         repr(whole(get(message, "IDF028", i, k), unit=0.0001) * 1000 / 1e7)]
        print(*line)


def text(message, length, characters):
    parts = [get(message, characters, i) for i in range(1, getattr(message, length) + 1)]
    return "".join(str(part) for part in parts).rstrip() or "-"


def print_fields(path):
    for _, message in frames(path):
        number = message.identity
        if number[:3] in LETTERS and number[3] in "4567":
            print_observations(message)
        elif number in EPHEMERIDES:
            print_ephemeris(message)
        elif number in SSR_KINDS:
            print_ssr(message)
        elif number in ("1005", "1006"):
            print("P", number, message.DF003, repr(message.DF025), repr(message.DF026), repr(message.DF027),
                  repr(message.DF028) if number == "1006" else "nan")
        elif number == "1033":
            pairs = (("DF029", "DF030"), ("DF032", "DF033"), ("DF227", "DF228"), ("DF229", "DF230"), ("DF231", "DF232"))
            print("Q", number, message.DF003, "|".join(text(message, *pair) for pair in pairs))


def split(path, numbers):
    from pyrtcm.rtcmhelpers import calc_crc24q
    for raw, message in frames(path):
        if message.identity not in numbers:
            continue
        body = bytearray(raw[:-3])
        if message.identity[:3] in ("107", "108", "109", "110", "111", "112", "113"):
            body[3 + 54 // 8] &= 0xFF ^ (0x80 >> 54 % 8)
        crc = calc_crc24q(bytes(body))
        sys.stdout.buffer.write(bytes(body) + crc.to_bytes(3, "big"))


def main(arguments):
    if arguments[:1] == ["--have"]:
        import pyrtcm  # noqa: F401
    elif len(arguments) == 2 and arguments[0] == "fields":
        print_fields(arguments[1])
    elif len(arguments) > 2 and arguments[0] == "split":
        split(arguments[1], arguments[2:])
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
