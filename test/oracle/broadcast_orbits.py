#!/usr/bin/env python3
"""What RTKLIB computes from broadcast elements, as an oracle for core/gnss/orbits/satellite_state.

Needs the PyPI package pyrtklib (RTKLIB's own functions, callable from Python), in a virtual
environment; nothing else in the project does. Use:

  broadcast_orbits.py literals NAV > test/core/gnss/orbits/broadcast_oracle.h
      A few ephemerides of each kind with RTKLIB's positions and clocks, as C++.
  broadcast_orbits.py table NAV > states.txt
      Every GPS, Galileo and BeiDou ephemeris of the file at several instants around its toe. Then
      LEONAV_ORBIT_ORACLE_NAV=NAV LEONAV_ORBIT_ORACLE=states.txt test_core_gnss "[oracle]"
"""
import sys

import pyrtklib as rtk

LITERALS = ("G05", "G24", "E01 F", "E24 I", "E18 I", "C05", "C08", "C29")
LITERAL_OFFSETS = (-7200.0, 0.0, 5400.7)
TABLE_OFFSETS = (-7200.0, -3599.9, -0.07, 0.0, 1800.25, 3600.0, 7200.0)
LETTERS = {rtk.SYS_GPS: "G", rtk.SYS_GAL: "E", rtk.SYS_CMP: "C"}
SYSTEMS = {"G": "kGps", "E": "kGalileo", "C": "kBeidou"}


def read_ephemerides(path):
    navigation, observations, station = rtk.nav_t(), rtk.obs_t(), rtk.sta_t()
    if rtk.readrnx(path, 1, "", observations, navigation, station) != 1 or navigation.n == 0:
        sys.exit(f"{path}: RTKLIB reads no ephemeris in it")
    for i in range(navigation.n):
        eph = navigation.eph[i]
        number = rtk.Arr1Dint(1)
        system = rtk.satsys(eph.sat, number)
        if system in LETTERS:
            yield f"{LETTERS[system]}{number[0]:02d}", eph, navigation


def message_of(name, eph):
    if name[0] == "G":
        return "kGpsLnav"
    if name[0] == "C":
        return "kBeidouD2" if int(name[1:]) <= 5 or int(name[1:]) >= 59 else "kBeidouD1"
    return "kGalileoFnav" if eph.code & 0b10 else "kGalileoInav"


def state_at(eph, time):
    position, clock, variance = rtk.Arr1Ddouble(3), rtk.Arr1Ddouble(1), rtk.Arr1Ddouble(1)
    rtk.eph2pos(time, eph, position, clock, variance)
    return [position[i] for i in range(3)] + [clock[0]]


def week_and_tow(time):
    week = rtk.Arr1Dint(1)
    tow = rtk.time2gpst(time, week)
    return week[0], tow


def print_table(path):
    for name, eph, _ in read_ephemerides(path):
        toe_week, toe_tow = week_and_tow(eph.toe)
        for offset in TABLE_OFFSETS:
            x, y, z, clock = state_at(eph, rtk.timeadd(eph.toe, offset))
            print(name, message_of(name, eph), eph.iode, toe_week, toe_tow, offset,
                  f"{x:.6f} {y:.6f} {z:.6f} {clock:.16e}")


def print_ephemeris(name, eph):
    f = repr
    toe_week, toe_tow = week_and_tow(eph.toe)
    toc_week, toc_tow = week_and_tow(eph.toc)
    print("  {")
    print("    Ephemeris e;")
    print(f"    e.satellite = {{System::{SYSTEMS[name[0]]}, {int(name[1:])}}};")
    print(f"    e.message = NavigationMessage::{message_of(name, eph)};")
    print(f"    e.toe = GpsTime::from_week_and_tow({toe_week}, {toe_tow});")
    print(f"    e.toc = GpsTime::from_week_and_tow({toc_week}, {toc_tow});")
    print(f"    e.sqrt_a = std::sqrt({f(eph.A)});")
    for ours, theirs in (("eccentricity", "e"), ("m0", "M0"), ("delta_n", "deln"),
                         ("omega0", "OMG0"), ("omega_dot", "OMGd"), ("i0", "i0"),
                         ("i_dot", "idot"), ("omega", "omg"), ("cuc", "cuc"), ("cus", "cus"),
                         ("crc", "crc"), ("crs", "crs"), ("cic", "cic"), ("cis", "cis"),
                         ("af0", "f0"), ("af1", "f1"), ("af2", "f2")):
        print(f"    e.{ours} = {f(getattr(eph, theirs))};")
    for offset in LITERAL_OFFSETS:
        x, y, z, clock = state_at(eph, rtk.timeadd(eph.toe, offset))
        print(f"    cases.push_back({{e, {offset}, {{{x:.4f}, {y:.4f}, {z:.4f}}}, {clock:.13e}}});")
    print("  }")


def print_literals(path):
    print("// Made by test/oracle/broadcast_orbits.py: broadcast elements of 2020-06-25 and what")
    print("// RTKLIB's eph2pos makes of them.")
    print("#pragma once")
    print("#include <cmath>\n#include <vector>\n")
    print('#include "core/gnss/orbits/satellite_state.h"\n')
    print("namespace leonav::test {\n")
    print("struct BroadcastCase {")
    print("  Ephemeris ephemeris;\n  double since_toe_s;\n  Eigen::Vector3d p_e;\n  double clock_s;")
    print("};\n")
    print("inline std::vector<BroadcastCase> rtklib_broadcast_cases() {")
    print("  std::vector<BroadcastCase> cases;")
    wanted = list(LITERALS)
    for name, eph, _ in read_ephemerides(path):
        key = name + (" " + message_of(name, eph)[8] if name[0] == "E" else "")
        if key in wanted:
            wanted.remove(key)
            print_ephemeris(name, eph)
    print("  return cases;\n}\n")
    print("}  // namespace leonav::test")
    if wanted:
        sys.exit(f"{path}: no ephemeris of {', '.join(wanted)}")


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("literals", "table"):
        sys.exit(__doc__)
    {"literals": print_literals, "table": print_table}[sys.argv[1]](sys.argv[2])
