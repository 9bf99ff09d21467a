#!/usr/bin/env python3
"""Corrections of Galileo HAS and BeiDou PPP-B2b by the PyPI package cssrlib, as an oracle for drivers/has and drivers/b2b.

  correction_pages.py has PAGES NAVIGATION   decodes a file of pages (week, second, satellite, type, length, hex) with the
  correction_pages.py b2b PAGES NAVIGATION   ephemerides of a RINEX file and prints a line for each value, numbers with
                                             all their digits:
    O second satellite issue IODCORR radial along across URA   orbit, in the sign of SSR; nan where not available
    C second satellite IODCORR clock                           clock, in the sign of SSR; nan where not available
    B second satellite signal bias                             code bias as sent
    P second satellite signal cycles DISCONTINUITIES           phase bias as sent
    S second satellite X Y Z clock                             corrected state at the second, m, of messages with clocks
  correction_pages.py --have                 exits 0 if cssrlib is there

The second is GPS time of the week of the corrections. The generator matrix of the Reed-Solomon code is that of the
package galois, which cssrlib uses too.
"""
import sys
from binascii import unhexlify


def pages(path):
    """Yields the pages of a file in its order."""
    for line in open(path):
        week, second, satellite, _, _, text = line.split()
        yield int(week), int(second), int(satellite), text


def navigation(path):
    from cssrlib.gnss import Nav
    from cssrlib.rinex import rnxdec

    nav = Nav()
    return rnxdec().decode_nav(path, nav)


def number(value):
    return repr(float(value))


def tow_of(t):
    from cssrlib.gnss import time2gpst

    return f"{time2gpst(t)[1]:.0f}"


def print_states(decoder, nav, satellites):
    from cssrlib.ephemeris import eph2rel, findeph, satpos
    from cssrlib.gnss import rCST, sat2id, sat2prn

    t = decoder.time
    for satellite in satellites:
        try:
            p, _, clock, _ = satpos(satellite, t, nav, cs=decoder)
        except KeyError:  # a correction of it has not come
            continue
        if p[0][0] != p[0][0] or p[0][0] == 0.0:
            continue
        mode = decoder.nav_mode[sat2prn(satellite)[0]]
        broadcast = findeph(nav.eph, t, satellite, decoder.lc[0].iode[satellite], mode=mode)
        clock_m = rCST.CLIGHT * (clock[0] + eph2rel(t, broadcast))
        print("S", tow_of(t), sat2id(satellite), *(f"{x:.5f}" for x in (*p[0], clock_m)))


def print_has(decoder, flags):
    from cssrlib.gnss import sat2id

    tow, lc = tow_of(decoder.time), decoder.lc[0]
    for satellite in decoder.sat_n:
        name = sat2id(satellite)
        if flags & 16:
            print("O", tow, name, lc.iode[satellite], -1, *map(number, lc.dorb[satellite]), -1)
        if flags & 8:
            print("C", tow, name, -1, number(lc.dclk[satellite]))
        if flags & 2:
            for signal, bias in lc.cbias[satellite].items():
                print("B", tow, name, signal.str()[1:], number(bias))
        if flags & 1:
            for signal, bias in lc.pbias[satellite].items():
                print("P", tow, name, signal.str()[1:], number(bias), lc.di[satellite][signal])


def has(path, nav):
    import galois
    import numpy
    from cssrlib.cssr_has import cnav_msg, cssr_has

    decoder, collector = cssr_has(), cnav_msg()
    collector.gMat = numpy.array(galois.ReedSolomon(255, 32).G).T
    by_second = {}
    for week, second, satellite, text in pages(path):
        by_second.setdefault((week, second), []).append({"nav": text})
    for (week, second), of_second in by_second.items():
        message = collector.decode_cnav(second, of_second)
        if not message:
            continue
        decoder.week, decoder.tow0 = week, second // 3600 * 3600
        decoder.msgtype = 1
        decoder.decode_cssr(message)
        flags = message[1] << 8 | message[2]
        flags = flags >> 6 & 63
        print_has(decoder, flags)
        if flags & 8:
            print_states(decoder, nav, decoder.sat_n)


def b2b(path, nav):
    import bitstruct
    from cssrlib.cssr_bds import cssr_bds
    from cssrlib.gnss import prn2sat, sat2id

    decoder = cssr_bds()
    seen = set()
    for week, second, _, text in pages(path):
        if (second, text) in seen:
            continue
        seen.add((second, text))
        message = unhexlify(text)
        kind = bitstruct.unpack_from("u6", message, 0)[0]
        if kind not in (1, 2, 3, 4):
            continue
        # cssrlib takes the week in BeiDou's count.
        decoder.week, decoder.tow0 = week - 1356, second // 86400 * 86400
        decoder.decode_cssr(message)
        tow, lc = tow_of(decoder.time), decoder.lc[0]
        if kind == 2:
            for i in range(6):
                slot = bitstruct.unpack_from("u9", message, 29 + 69 * i)[0]
                satellite = prn2sat(*decoder.slot2prn(slot)) if slot else 0
                if satellite in lc.iode:
                    print("O", tow, sat2id(satellite), lc.iode[satellite], lc.iodc[satellite],
                          *map(number, lc.dorb[satellite]), number(decoder.ura[satellite]))
        if kind == 3:
            count, i = bitstruct.unpack_from("u5", message, 29)[0], 34
            for _ in range(count):
                slot, signals = bitstruct.unpack_from("u9u4", message, i)
                i += 13 + 16 * signals
                satellite = prn2sat(*decoder.slot2prn(slot))
                for signal, bias in lc.cbias.get(satellite, {}).items():
                    print("B", tow, sat2id(satellite), signal.str()[1:], number(bias))
        if kind == 4:
            first = 23 * bitstruct.unpack_from("u5", message, 33)[0]
            of_message = decoder.sat_n[first:first + 23]
            for satellite in of_message:
                print("C", tow, sat2id(satellite), lc.iodc_c[satellite], number(lc.dclk[satellite]))
            print_states(decoder, nav, [s for s in of_message if s in lc.iode])


def main():
    if sys.argv[1:] == ["--have"]:
        import cssrlib.cssr_bds  # noqa: F401
        import cssrlib.cssr_has  # noqa: F401
        return
    nav = navigation(sys.argv[3])
    {"has": has, "b2b": b2b}[sys.argv[1]](sys.argv[2], nav)


if __name__ == "__main__":
    main()
