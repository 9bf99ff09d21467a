"""Encodes broadcast messages of Galileo as a u-blox receiver hands them on: UBX-RXM-SFRBX with I/NAV pages of E1-B.

Written from the interface documents alone, so that it is independent of leonav's decoder: Galileo OS SIS ICD issue 2.1
(4.3.2 page layout, 4.3.3 sub-frame layout, 4.3.5 word types, 5.1.9.4 CRC, table 84 SISA) and u-blox ZED-F9P interface
description UBX-22008968 (3.17.9 RXM-SFRBX: eight words, each half of a page in four).
"""
import math
import struct

import ubx_bytes  # finds those of test/support/python
import navigation_file
from crc24q import crc24q_of_bits
from galileo_accuracy import sisa_index
from ubx_bytes import bits

WEEK_ZERO = 1024  # GPS week in which Galileo's weeks begin
LEAP_SECONDS = 18
SUBFRAME_S = 30
# Seconds after the start of a sub-frame at which E1-B sends each word type.
SECONDS_OF_WORD = {2: 1, 4: 3, 6: 5, 1: 21, 3: 23, 5: 25, 0: 27}


def records(path):
    """The I/NAV records of a RINEX 3 navigation file: (satellite number, time of clock, clock terms, 28 numbers)."""
    for satellite, toc, clock, orbit in navigation_file.records(path):
        if satellite[0] == "E" and int(orbit[17]) & 1:  # bit 0: I/NAV of E1-B
            yield int(satellite[1:]), toc, clock, orbit


def words(satellite, toc, clock, orbit, sent):
    """Word types 0 to 6, of 128 bits each; `sent` (s since the GPS epoch) is the time of week in words 0, 5 and 6."""
    semicircle = math.pi
    (issue, crs, delta_n, m0, cuc, ecc, cus, sqrt_a, toe, cic, omega0, cis, i0, crc, omega, omega_dot, i_dot, _, _, _,
     accuracy, health, bgd_e5a, bgd_e5b) = orbit[:24]
    issue, health = bits(issue, 10), int(health)
    signal = lambda shift: (format(health >> shift + 1 & 3, "02b"), str(health >> shift & 1))
    (e1_status, e1_invalid), (e5b_status, e5b_invalid) = signal(0), signal(6)
    week, tow = bits(sent // 604800 - WEEK_ZERO, 12), bits(sent % 604800, 20)
    text = {
        0: "10" + "0" * 88 + week + tow,
        1: issue + bits(toe / 60, 14) + bits(m0, 32, -31, semicircle) + bits(ecc, 32, -33) + bits(sqrt_a, 32, -19) + "00",
        2: issue + bits(omega0, 32, -31, semicircle) + bits(i0, 32, -31, semicircle) + bits(omega, 32, -31, semicircle) +
        bits(i_dot, 14, -43, semicircle) + "00",
        3: issue + bits(omega_dot, 24, -43, semicircle) + bits(delta_n, 16, -43, semicircle) + bits(cuc, 16, -29) + bits(cus, 16, -29) +
        bits(crc, 16, -5) + bits(crs, 16, -5) + bits(sisa_index(accuracy), 8),
        4: issue + bits(satellite, 6) + bits(cic, 16, -29) + bits(cis, 16, -29) + bits(toc % 604800 / 60, 14) + bits(clock[0], 31, -34) +
        bits(clock[1], 21, -46) + bits(clock[2], 6, -59) + "00",
        5: "0" * (11 + 11 + 14) + "0" * 5 + bits(bgd_e5a, 10, -32) + bits(bgd_e5b, 10, -32) + e5b_status + e1_status + e5b_invalid +
        e1_invalid + week + tow + "0" * 23,
        6: "0" * (32 + 24) + bits(LEAP_SECONDS, 8) + "0" * (8 + 8 + 8 + 3) + bits(LEAP_SECONDS, 8) + tow + "000",
    }
    return {kind: bits(kind, 6) + content for kind, content in text.items()}


def page(word):
    """Both halves of a nominal page, 120 bits each, filled up to 128."""
    assert len(word) == 128
    even = "00" + word[:112]
    odd = "10" + word[112:] + "0" * 40 + "0" * 22 + "00"
    odd += format(crc24q_of_bits(even + odd), "024b") + "0" * 8
    return [half.ljust(128, "0") for half in (even, odd)]


def sfrbx(satellite, word):
    text = "".join(page(word))
    values = [int(text[i:i + 32], 2) for i in range(0, 256, 32)]
    return ubx_bytes.frame(0x02, 0x13, struct.pack("<BBBBBBBx", 2, satellite, 1, 0, 8, 0, 2) + struct.pack("<8I", *values))


def broadcasts(newest, start):
    """(time of reception, message) of one sub-frame of each of {satellite: (toc, clock terms, numbers)}, which begins at `start`."""
    assert start % SUBFRAME_S == 0
    for satellite, (toc, clock, orbit) in newest.items():
        for kind, second in SECONDS_OF_WORD.items():
            word = words(satellite, toc, clock, orbit, start + second)[kind]
            yield start + second + 2, sfrbx(satellite, word)
