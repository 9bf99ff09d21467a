#!/usr/bin/env python3
"""The group delays in the modernized navigation messages of a u-blox recording, as an oracle for drivers/binary.

  cnav.py FILE   one line for each message with delays: satellite, then code and metres of each signal

The fields are taken from strings of binary digits, the checksum is a division of polynomials.
"""
import struct
import sys

LIGHT = 299792458.0
GENERATOR = int("1100001100100110011111011", 2)  # CRC-24Q


def divides(digits):
    value = int(digits, 2)
    for shift in range(len(digits) - 25, -1, -1):
        if value >> (shift + 24) & 1:
            value ^= GENERATOR << shift
    return value == 0


def signed(digits):
    return int(digits, 2) - (1 << len(digits) if digits[0] == "1" else 0)


def gps(digits):
    digits = digits[:300]
    if digits[:8] != "10001011" or not divides(digits) or int(digits[14:20], 2) != 30:
        return None
    tgd, ca, l2c, i5, q5 = (signed(digits[127 + 13 * k:140 + 13 * k]) * 2.0**-35 * LIGHT for k in range(5))
    gamma = 77.0**2 / 60.0**2
    return {"1W": tgd, "1P": tgd, "2W": gamma * tgd, "2P": gamma * tgd, "1C": tgd - ca, "2S": tgd - l2c, "2L": tgd - l2c,
            "2X": tgd - l2c, "5I": tgd - i5, "5Q": tgd - q5, "5X": tgd - (i5 + q5) / 2}


def b1c(digits):
    digits = digits[:600]
    if not divides(digits):
        return None
    b2a, data, pilot = (signed(digits[533 + 12 * k:545 + 12 * k]) * 2.0**-34 * LIGHT for k in range(3))
    return {"5P": b2a, "1P": pilot, "1D": pilot + data, "1X": pilot + data / 4}


def b2a(digits):
    digits = digits[:288]
    if not divides(digits) or int(digits[6:12], 2) != 30:
        return None
    pilot, data, b1 = (signed(digits[at:at + 12]) * 2.0**-34 * LIGHT for at in (121, 133, 219))
    return {"5P": pilot, "5D": pilot + data, "5X": pilot + data / 2, "1P": b1}


READERS = {(0, 3, 10): gps, (0, 4, 10): gps, (0, 6, 10): gps, (0, 7, 10): gps,
           (3, 5, 19): b1c, (3, 6, 19): b1c, (3, 7, 9): b2a, (3, 8, 9): b2a}


def main():
    data = open(sys.argv[1], "rb").read()
    at = data.find(b"\xb5\x62\x02\x13")
    while at >= 0:
        size, = struct.unpack_from("<H", data, at + 4)
        system, number, signal, _, words = data[at + 6:at + 11]
        reader = READERS.get((system, signal, words))
        if reader and size == 8 + 4 * words:
            digits = "".join(f"{word:032b}" for word in struct.unpack_from(f"<{words}I", data, at + 14))
            delays = reader(digits)
            if delays:
                print(("G" if system == 0 else "C") + f"{number:02d}",
                      " ".join(f"{code} {metres!r}" for code, metres in sorted(delays.items())))
        at = data.find(b"\xb5\x62\x02\x13", at + 4)


if __name__ == "__main__":
    main()
