#!/usr/bin/env python3
"""RINEX 4 navigation files written by the PyPI package cssrlib, as an oracle for drivers/rinex.

  rinex4.py convert NAV OUT  the GPS, Galileo and BeiDou ephemerides that cssrlib reads in a RINEX 3 file
  rinex4.py cnav UBX OUT     what cssrlib decodes of GPS CNAV and BeiDou B-CNAV1 in the UBX-RXM-SFRBX of a recording
  rinex4.py --have           exits 0 if cssrlib is there

Of I/NAV records cssrlib takes the two group delays for one another when it reads RINEX 3 and not when it writes RINEX 4. It
cuts accuracies to whole metres, writes BeiDou's times of transmission 14 s late, and a satellite's set once for each issue that
differs from the one before.
"""
import struct
import sys

import bcnav1


def ephemerides_of_bits(path):
    from cssrlib.gnss import prn2sat, uGNSS
    from cssrlib.rawnav import RawNav

    decoder = RawNav()
    for satellite, week, second, bits in bcnav1.messages(path):
        yield decoder.decode_bds_b1c(week, second, prn2sat(uGNSS.BDS, satellite), bcnav1.frame_of(bits))
    for satellite, week, second, words in bcnav1.subframes(path, 0, (3, 4), 10):  # CNAV on L2C
        yield decoder.decode_gps_cnav(week, second, prn2sat(uGNSS.GPS, satellite), struct.pack(">10I", *words))


def ephemerides_of_rinex(path):
    from cssrlib.gnss import Nav
    from cssrlib.rinex import rnxdec

    return rnxdec().decode_nav(path, Nav()).eph


def main():
    if sys.argv[1:] == ["--have"]:
        import cssrlib.rawnav  # noqa: F401
        return
    from cssrlib.gnss import sat2prn, uGNSS
    from cssrlib.rinex import rnxenc

    read = {"convert": ephemerides_of_rinex, "cnav": ephemerides_of_bits}[sys.argv[1]]
    with open(sys.argv[3], "w") as out:
        out.write(f"{'     4.01':20s}{'NAVIGATION DATA':20s}{'M':20s}RINEX VERSION / TYPE\n{'':60s}END OF HEADER\n")
        writer = rnxenc()
        for eph in read(sys.argv[2]):
            if eph is not None and sat2prn(eph.sat)[0] in (uGNSS.GPS, uGNSS.GAL, uGNSS.BDS):
                writer.rnx_nav_body(eph, out)


if __name__ == "__main__":
    main()
