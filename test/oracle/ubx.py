#!/usr/bin/env python3
"""What the PyPI package pyubx2 reads in u-blox bytes, as an oracle for drivers/ubx.

  ubx.py rawx FILE           prints every measurement of UBX-RXM-RAWX: GPS time (ns), satellite, RINEX code, code (m), carrier
                             (cycles), Doppler (Hz), C/N0 (dB-Hz), lock time (ms), whether the half cycle is known; nan: not measured
  ubx.py generate SEED OUT   writes messages of inertial sensors and time marks with random contents to OUT, and prints what
                             pyubx2 reads in them
  ubx.py --have              exits 0 if pyubx2 is there

Of generated messages a line is `meas` or `raw`, the time tag (ms, or ticks of 24 bits), the rates about x, y, z as whole numbers of 2^-12 degrees/s, the
forces along x, y, z as those of 2^-10 m/s^2, and the temperature as that of 0.01 degrees, or -. Or it is `mark`, the input, the
count of rising edges, the GPS time of the rising and of the falling edge (ns, or -), and the accuracy (ns).
"""
import random
import struct
import sys

AXES = {14: 0, 13: 1, 5: 2, 16: 3, 17: 4, 18: 5}
GYRO, FORCE = (14, 13, 5), (16, 17, 18)
WEEK_NS, LEAP_NS = 604_800 * 10 ** 9, 18 * 10 ** 9


def frame(message_class, identifier, payload):
    body = struct.pack("<BBH", message_class, identifier, len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 255
        b = (b + a) & 255
    return b"\xb5\x62" + body + bytes((a, b))


def word(kind, value):
    return kind << 24 | value & 0xFFFFFF


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value


def meas(tag, words, calibrated=None):
    flags = len(words) << 11 | (8 if calibrated is not None else 0)
    tail = b"" if calibrated is None else struct.pack("<I", calibrated)
    return frame(0x10, 0x02, struct.pack("<IHH", tag, flags, 0) + struct.pack(f"<{len(words)}I", *words) + tail)


def raw(pairs):
    return frame(0x10, 0x03, bytes(4) + b"".join(struct.pack("<II", data, tag) for data, tag in pairs))


def stream(dice):
    """Inertial messages of MEAS first, of RAW then, with time marks and odometers between them."""
    value = lambda: dice.choice([dice.randrange(-2 ** 20, 2 ** 20), dice.randrange(-50, 50), -2 ** 23, 2 ** 23 - 1])
    tag = 2 ** 32 - 1000  # ms; it wraps on the way
    for count in range(300):
        tag = (tag + 10) % 2 ** 32
        calibrated = 5000 + 10 * count if count >= 200 else None
        gyro = [word(kind, value()) for kind in dice.sample(GYRO, 3)] + ([word(12, dice.randrange(-4000, 8500))] if count % 3 == 0 else [])
        force = [word(kind, value()) for kind in dice.sample(FORCE, 3)]
        messages = [meas(tag, gyro, calibrated), meas(tag, force, calibrated)]
        dice.shuffle(messages)
        if count % 10 == 0:
            messages.insert(1, meas(tag, [word(8, 123), word(9, 456)], calibrated))  # wheel ticks
        yield from messages
        if count % 4 == 0:
            yield mark(dice)
    tick = 2 ** 24 - 3000
    for _ in range(60):
        pairs = []
        for _ in range(dice.choice([1, 1, 10])):
            tick += 256
            kinds = [14, 13, 5, 12, 16, 17, 18]
            dice.shuffle(kinds)
            # The bits above the counter's hold anything.
            pairs += [(word(kind, value() if kind != 12 else dice.randrange(-4000, 8500)), tick % 2 ** 24 | dice.choice([0, 0xAB000000])) for kind in kinds]
        yield raw(pairs)


def mark(dice):
    base = dice.choice([1, 1, 2])
    flags = base << 3 | 1 << 5 | 1 << 6 | dice.choice([0x80, 0x04, 0x84]) | dice.randrange(4)
    tow = [dice.randrange(100_000, 604_700_000) for _ in range(2)]
    return frame(0x0D, 0x03, struct.pack("<BBHHHIIIII", dice.randrange(2), flags, dice.randrange(65536), 2300, 2301, tow[0],
                                         dice.randrange(10 ** 6), tow[1], dice.randrange(10 ** 6), dice.randrange(10 ** 5)))


def number(field):
    """pyubx2 gives fields without bits of their own as bytes."""
    return int.from_bytes(field, "little") if isinstance(field, bytes) else field


def fields(path):
    from pyubx2 import UBXReader
    with open(path, "rb") as file:
        temperature, axes = "-", {}
        for _, message in UBXReader(file, protfilter=2):
            if message.identity == "ESF-MEAS":
                tag, last = message.timeTag, message.numMeas + 1
                if message.calibTtagValid:  # pyubx2 gives it as one value more, without its two highest bits
                    tag = getattr(message, f"dataField_{last:02d}") | getattr(message, f"dataType_{last:02d}") << 24
                for index in range(1, message.numMeas + 1):
                    kind, data = getattr(message, f"dataType_{index:02d}"), signed(number(getattr(message, f"dataField_{index:02d}")), 24)
                    if kind == 12:
                        temperature = data
                    elif kind in AXES:
                        axes[AXES[kind]] = data
                    if len(axes) == 6:  # a temperature behind the sixth axis belongs to the next sample
                        print("meas", tag, *(axes[axis] for axis in range(6)), temperature)
                        axes = {}
            elif message.identity == "ESF-RAW":
                index, axes = 1, {}
                while hasattr(message, f"data_{index:02d}"):
                    data = number(getattr(message, f"data_{index:02d}"))
                    kind, data = data >> 24, signed(data & 0xFFFFFF, 24)
                    if kind == 12:
                        temperature = data
                    else:
                        axes[AXES[kind]] = data
                    if len(axes) == 6:
                        tag = number(getattr(message, f"sTag_{index:02d}")) & 0xFFFFFF
                        print("raw", tag, *(axes[axis] for axis in range(6)), temperature)
                        axes = {}
                    index += 1
            elif message.identity == "TIM-TM2":
                leap = LEAP_NS if message.timeBase == 2 else 0
                rising = message.wnR * WEEK_NS + message.towMsR * 10 ** 6 + message.towSubMsR + leap if message.newRisingEdge else "-"
                falling = message.wnF * WEEK_NS + message.towMsF * 10 ** 6 + message.towSubMsF + leap if message.newFallingEdge else "-"
                print("mark", message.ch, message.count, rising, falling, message.accEst)


# Of the interface description: letter of a gnssId, and the RINEX code of each sigId.
SIGNALS = {0: ("G", {0: "1C", 3: "2L", 4: "2S", 6: "5I", 7: "5Q"}),
           2: ("E", {0: "1C", 1: "1B", 3: "5I", 4: "5Q", 5: "7I", 6: "7Q", 8: "6B", 9: "6C", 10: "6A"}),
           3: ("C", {0: "2I", 1: "2I", 2: "7I", 3: "7I", 4: "6I", 5: "1P", 6: "1D", 7: "5P", 8: "5D", 10: "6I"})}


def measurements(path):
    from pyubx2 import UBXReader
    with open(path, "rb") as file:
        for _, message in UBXReader(file, protfilter=2, quitonerror=0):
            if message is None or message.identity != "RXM-RAWX":
                continue
            time_ns = message.week * WEEK_NS + round(message.rcvTow * 1e9)
            for index in range(1, message.numMeas + 1):
                def get(name):
                    return getattr(message, f"{name}_{index:02d}")
                letter, codes = SIGNALS.get(get("gnssId"), ("", {}))
                if get("sigId") not in codes:
                    continue
                # A carrier of 0 cycles (with a half cycle added -0.5), or of a deviation of 0.06 cycles and more, is none.
                has_carrier = get("cpValid") and get("cpMes") not in (0.0, -0.5) and get("cpStd") <= 14
                print(time_ns, f"{letter}{get('svId'):02d}", codes[get("sigId")], repr(get("prMes")) if get("prValid") else "nan",
                      repr(get("cpMes")) if has_carrier else "nan", repr(get("doMes")), get("cno") or "nan", get("locktime"),
                      int(bool(get("halfCyc"))))


def main():
    if sys.argv[1:] == ["--have"]:
        import pyubx2  # noqa: F401
        return
    if sys.argv[1] == "rawx":
        measurements(sys.argv[2])
        return
    with open(sys.argv[3], "wb") as file:
        for data in stream(random.Random(int(sys.argv[2]))):
            file.write(data)
    fields(sys.argv[3])


if __name__ == "__main__":
    main()
