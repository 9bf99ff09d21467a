#!/usr/bin/env python3
"""Corrected states of satellites by the PyPI package cssrlib, as an oracle for drivers/ssr.

  ssr_states.py FILE WEEK     decodes SSR messages and ephemerides of a file of RTCM 3 and prints, for every message of
                              orbits and clocks and each of its satellites: seconds of the week, satellite, X, Y, Z in m,
                              clock in m with the relativistic term, at the message's time
  ssr_states.py --have        exits 0 if cssrlib is there
"""
import sys


def states(path, week):
    from cssrlib.cssrlib import sCSSR
    from cssrlib.ephemeris import eph2rel, findeph, satpos
    from cssrlib.gnss import Nav, gpst2time, rCST, sat2id, sat2prn, time2gpst
    from cssrlib.rtcm import rtcm

    decoder, nav = rtcm(), Nav()
    decoder.monlevel = 0
    decoder.week = week
    decoder.time = gpst2time(week, 0)
    data = open(path, "rb").read()
    k = 0
    while k + 6 < len(data):
        if data[k] != 0xD3:
            k += 1
            continue
        length = (data[k + 1] & 3) << 8 | data[k + 2]
        message = data[k:k + length + 6]
        if not decoder.checksum(message, 0, len(message) + 1):
            k += 1
            continue
        k += length + 6
        decoder.len = length
        _, _, ephemeris, _, _ = decoder.decode(message)
        if ephemeris is not None:
            same = [e for e in nav.eph if e.sat == ephemeris.sat and e.iode == ephemeris.iode]
            for e in same:
                nav.eph.remove(e)
            nav.eph.append(ephemeris)
        if decoder.subtype != sCSSR.COMBINED:
            continue
        system = decoder.get_ssr_sys(decoder.msgtype)
        t = decoder.time
        for satellite, of in zip(decoder.sat_n, decoder.sys_n):
            if of != system:
                continue
            p, _, clock, _ = satpos(satellite, t, nav, cs=decoder)
            if p[0][0] != p[0][0]:
                continue
            mode = decoder.nav_mode[sat2prn(satellite)[0]]
            broadcast = findeph(nav.eph, t, satellite, decoder.lc[0].iode[satellite], mode=mode)
            clock_m = rCST.CLIGHT * (clock[0] + eph2rel(t, broadcast))
            print(f"{time2gpst(t)[1]:.0f} {sat2id(satellite)} {p[0][0]:.5f} {p[0][1]:.5f} {p[0][2]:.5f} {clock_m:.5f}")


def main():
    if sys.argv[1:] == ["--have"]:
        import cssrlib.rtcm  # noqa: F401
        return
    states(sys.argv[1], int(sys.argv[2]))


if __name__ == "__main__":
    main()
