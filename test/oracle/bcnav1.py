#!/usr/bin/env python3
"""Elements in BeiDou's B-CNAV1 by the PyPI package cssrlib, as an oracle for drivers/navigation_bits.

  bcnav1.py FILE   one line for each subframe 2 in the UBX-RXM-SFRBX of a u-blox recording: satellite, IODE, IODC, seconds
                   of BeiDou's week of toe and toc, 20 elements, position (m) and clock (s) at toe + 1000 s
  bcnav1.py sbf FILE >OUT   the same subframes as blocks BDSRawB1C of a Septentrio receiver, of the week and time of the
                   last UBX-RXM-RAWX; needs no cssrlib
  bcnav1.py --have exits 0 if cssrlib is there

cssrlib takes a frame with subframe 3, of which u-blox gives nothing: one of page type 1 with zeros stands in for it.
"""
import struct
import sys

ELEMENTS = "A e M0 deln OMG0 OMGd i0 idot omg cuc cus crc crs cic cis af0 af1 af2 Adot delnd"


def subframes(path, system, signals, words):
    """Yields satellite, week, seconds and the words of each UBX-RXM-SFRBX of these, behind the first UBX-RXM-RAWX."""
    data = open(path, "rb").read()
    at, week, second = 0, None, None
    while (at := data.find(b"\xb5\x62\x02", at)) >= 0:
        size, = struct.unpack_from("<H", data, at + 4)
        if data[at + 3] == 0x15:
            second, week = struct.unpack_from("<dH", data, at + 6)
        elif data[at + 3] == 0x13 and size == 8 + 4 * words and data[at + 6] == system and data[at + 8] in signals and week:
            yield data[at + 7], week, second, struct.unpack_from(f"<{words}I", data, at + 14)
        at += 3


def messages(path):
    """Yields satellite, week, seconds and the 600 bits of each subframe 2."""
    for satellite, week, second, words in subframes(path, 3, (5, 6), 19):
        yield satellite, week, second, "".join(f"{word:032b}" for word in words)[:600]


def frame_of(bits):
    """The frame that cssrlib takes."""
    frame = bits + "00000011" + "000001" + "0" * 258 + "00000000"
    return int(frame.ljust(912, "0"), 2).to_bytes(114, "big")


def decoded(path):
    from cssrlib.ephemeris import eph2pos
    from cssrlib.gnss import bdt2gpst, bdt2time, prn2sat, timeadd, uGNSS
    from cssrlib.rawnav import RawNav

    decoder = RawNav()
    for satellite, week, second, bits in messages(path):
        eph = decoder.decode_bds_b1c(week, second, prn2sat(uGNSS.BDS, satellite), frame_of(bits))
        if eph is None:
            continue
        position, clock = eph2pos(timeadd(eph.toe, 1000.0), eph)
        numbers = [getattr(eph, name) for name in ELEMENTS.split()]
        toc = int(bits[39 + 203 + 222:39 + 203 + 222 + 11], 2) * 300
        print(f"C{satellite:02d}", eph.iode, eph.iodc, int(eph.toes), toc,
              *(repr(float(x)) for x in (*numbers, *position, clock)))


def as_sbf(path):
    from sbf import block, words_of

    for satellite, week, second, bits in messages(path):
        frame = f"{satellite:06b}" + "0" * 66 + bits + "1" * (1800 - 672)
        head = struct.pack("<BBBBBB", satellite + (140 if satellite <= 40 else 182), 1, 1, 13, 0, 3)
        sys.stdout.buffer.write(block(4218, head + words_of(frame, 57), round(second * 1000), week=week))


def main():
    if sys.argv[1:] == ["--have"]:
        import cssrlib.rawnav  # noqa: F401
    elif sys.argv[1] == "sbf":
        as_sbf(sys.argv[2])
    else:
        decoded(sys.argv[1])


if __name__ == "__main__":
    main()
