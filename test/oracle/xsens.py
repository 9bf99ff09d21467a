#!/usr/bin/env python3
"""Encodes Xsens MTData2 messages, as an oracle for drivers/xsens.

Written from the public protocol document alone, so that it is independent of leonav's decoder: Xsens, MT Low Level
Communication Protocol Documentation (MT0101P), "Message structure" and "MTData2".

  xsens.py generate SEED OUT   writes random messages in every precision to OUT, and prints what each one with motion holds
  xsens.py drive IMU.csv OUT [DRIFT_PPM]   imu.csv as a sensor without GPS time has it: DeltaQ, DeltaV, SampleTimeFine

A line of `generate` has the words, with - for what the message has not: UTC as nanoseconds since 1970, SampleTimeFine,
SampleTimeCoarse, PacketCounter, status word, temperature, rotation vector of DeltaQ with the error that its rounding may have,
DeltaV, RateOfTurn, Acceleration. Numbers are printed so that they are read back to the last bit.
"""
import csv
import datetime
import math
import random
import struct
import sys

MTDATA2 = 0x36
UTC, COUNTER, FINE, COARSE, TEMPERATURE, STATUS = 0x1010, 0x1020, 0x1060, 0x1070, 0x0810, 0xE020
DELTA_V, ACCELERATION, RATE_OF_TURN, DELTA_Q = 0x4010, 0x4020, 0x8020, 0x8030
FLOAT32, FP1220, FP1632, FLOAT64 = range(4)
RESOLUTION = {FLOAT32: 2.0 ** -24, FP1220: 2.0 ** -21, FP1632: 2.0 ** -33, FLOAT64: 2.0 ** -53}  # of numbers up to one
NO_MOTION = [0x2010, 0x2034, 0x3010, 0x4030, 0x4040, 0x5042, 0x8040, 0xC020, 0xD012, 0xE010, 0xA010]  # groups that are not read


def message(identifier, payload):
    length = bytes([len(payload)]) if len(payload) < 255 else b"\xff" + struct.pack(">H", len(payload))
    body = b"\xff" + bytes([identifier]) + length + payload
    return b"\xfa" + body + bytes([-sum(body) & 0xFF])


def group(identifier, data):
    return struct.pack(">HB", identifier, len(data)) + data


def number(value, precision):
    """(bytes, the number that they stand for)"""
    if precision == FLOAT32:
        data = struct.pack(">f", value)
        return data, struct.unpack(">f", data)[0]
    if precision == FLOAT64:
        return struct.pack(">d", value), value
    steps = round(value * 2 ** (20 if precision == FP1220 else 32))
    if precision == FP1220:
        return struct.pack(">i", steps), steps / 2 ** 20
    # The fraction comes first, then the whole part.
    return struct.pack(">Ih", steps & 0xFFFFFFFF, steps >> 32), steps / 2 ** 32


def numbers(identifier, values, precision, frame=0):
    """(group, the numbers that it stands for)"""
    parts = [number(value, precision) for value in values]
    return group(identifier | frame | precision, b"".join(data for data, _ in parts)), [value for _, value in parts]


def quaternion(rotation):
    angle = math.sqrt(sum(x * x for x in rotation))
    scale = math.sin(angle / 2) / angle if angle > 0 else 0.0
    return [math.cos(angle / 2)] + [x * scale for x in rotation]


def utc(time_ns, flags):
    whole, ns = divmod(time_ns, 10 ** 9)
    t = datetime.datetime.fromtimestamp(whole, datetime.timezone.utc)
    return group(UTC, struct.pack(">IHBBBBBB", ns, t.year, t.month, t.day, t.hour, t.minute, t.second, flags))


def generate(seed, path):
    dice = random.Random(seed)
    frame = lambda: dice.choice([0, 4, 8])
    vector = lambda limit: [dice.uniform(-limit, limit) for _ in range(3)]
    with open(path, "wb") as file:
        for _ in range(2000):
            groups, words = [], ["-"] * 19
            precision = dice.randrange(4)
            if dice.random() < 0.5:
                time_ns, flags = dice.randrange(1_300_000_000 * 10 ** 9, 2_000_000_000 * 10 ** 9), dice.choice([7, 7, 7, 0, 3, 4])
                groups.append(utc(time_ns, flags))
                words[0] = str(time_ns) if flags == 7 else "-"
            for place, identifier, form, limit in ((1, FINE, ">I", 2 ** 32), (2, COARSE, ">I", 2 ** 32), (3, COUNTER, ">H", 2 ** 16), (4, STATUS, ">I", 2 ** 32)):
                if dice.random() < 0.7:
                    value = dice.randrange(limit)
                    groups.append(group(identifier, struct.pack(form, value)))
                    words[place] = str(value)
            if dice.random() < 0.3:
                data, values = numbers(TEMPERATURE, [dice.uniform(-40, 85)], dice.randrange(4), frame())
                groups.append(data)
                words[5] = repr(values[0])
            kind = dice.choice(["increments", "rates", "both", "none", "half"])
            if kind in ("increments", "both"):
                rotation = vector(dice.choice([1e-7, 0.01, 1.0]))
                sign = dice.choice([1, 1, 1, -1])
                data, _ = numbers(DELTA_Q, [sign * q for q in quaternion(rotation)], precision, frame())
                groups.append(data)
                words[6:9] = [repr(x) for x in rotation]
                words[9] = repr(8 * RESOLUTION[precision])
                data, values = numbers(DELTA_V, vector(20.0), precision, frame())
                groups.append(data)
                words[10:13] = [repr(x) for x in values]
            if kind in ("rates", "both"):
                for place, identifier, limit in ((13, RATE_OF_TURN, 30.0), (16, ACCELERATION, 300.0)):
                    data, values = numbers(identifier, vector(limit), dice.randrange(4), frame())
                    groups.append(data)
                    words[place:place + 3] = [repr(x) for x in values]
            if kind == "half":
                groups.append(numbers(dice.choice([DELTA_V, ACCELERATION]), vector(1.0), precision)[0])
            for _ in range(dice.choice([0, 1, 2, 12])):
                groups.append(group(dice.choice(NO_MOTION), dice.randbytes(dice.choice([0, 1, 12, 16, 48, 94]))))
            dice.shuffle(groups)
            payload = b"".join(groups)
            if len(payload) > 2048:
                continue
            if dice.random() < 0.1:  # an error, a wake-up, an acknowledged setting
                file.write(message(dice.choice([0x42, 0x3E, 0xC1]), dice.randbytes(dice.randrange(100))))
            file.write(message(MTDATA2, payload))
            if kind not in ("none", "half"):
                print(*words)


def drive(source, drift_ppm=0.0):
    """(GPS time in ns, bytes) of each sample of imu.csv but the first, whose interval is not known."""
    first = last = None
    with open(source, newline="", encoding="ascii") as file:
        for count, row in enumerate(csv.DictReader(file)):
            whole, _, fraction = row["gps_tow_s"].partition(".")
            time_ns = (int(row["gps_week"]) * 604800 + int(whole)) * 10 ** 9 + int(fraction.ljust(9, "0")[:9])
            # The sensor's axes are x forward, y left, z up, those of the file forward, right, down.
            rate, force = ([float(row[f"{kind}_{axis}_{unit}"]) * sign for axis, sign in (("x", 1), ("y", -1), ("z", -1))]
                           for kind, unit in (("gyro", "rad_s"), ("accel", "m_s2")))
            first = time_ns if first is None else first
            if last is not None:
                interval = (time_ns - last) * 1e-9
                # The clock wraps in the tenth second of the drive.
                ticks = round(2 ** 32 - 95_000 + (time_ns - first) * (1 + drift_ppm * 1e-6) / 1e5) % 2 ** 32
                yield time_ns, message(MTDATA2, b"".join((
                    group(COUNTER, struct.pack(">H", count % 65536)), group(FINE, struct.pack(">I", ticks)),
                    numbers(DELTA_Q, quaternion([x * interval for x in rate]), FLOAT64)[0],
                    numbers(DELTA_V, [x * interval for x in force], FP1632)[0])))
            last = time_ns


def main():
    if sys.argv[1] == "generate":
        generate(int(sys.argv[2]), sys.argv[3])
    else:
        with open(sys.argv[3], "wb") as file:
            for _, data in drive(sys.argv[2], *(float(drift) for drift in sys.argv[4:5])):
                file.write(data)


if __name__ == "__main__":
    main()
