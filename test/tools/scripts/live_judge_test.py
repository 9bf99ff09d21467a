#!/usr/bin/python3
"""live_judge_test.py: the judgement of a live drive tells what is wrong, and nothing where nothing is."""
import functools
import math
import operator
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / folder) for folder in ("tools/scripts/lib/live_drive", "tools/scripts/lib", "tools/python")]
try:
    import pandas as pd
    import judge
except ImportError as error:
    print(f"SKIPPED: {error}")
    sys.exit(77)

START_MS = (2446 * 604800 + 455000) * 1000
CASTER = type("Caster", (), {"refused": 1, "served": 3, "broken": 2})
SAID = """info: service: NTRIP localhost:1/SSR over TLS is open
warning: service: localhost:1: the server closed the connection; trying again in 0.5 s, then ever more rarely
info: service: NTRIP localhost:1/SSR over TLS is open
warning: service: localhost:1: the server closed the connection; trying again in 0.5 s, then ever more rarely
warning: service: localhost:1: the caster closed the connection without an answer; are 'version' and 'tls' right?; trying again in 1 s
info: service: NTRIP localhost:1/SSR over TLS is open
"""


def check(what, faults, expected):
    if bool(faults) != expected:
        sys.exit(f"FAILED: {what}: {faults or 'no fault is told'}")


def drive():
    """{GPS time in ms: SOLUTION} once a second, and what gpsd and the serial port make of it."""
    solutions, reports, data = {}, [], b""
    satellites = [{"used": True, "gnssid": number % 2 * 2} for number in range(10)]
    for second in range(60):
        row = {"latitude_deg": 39.9 + second * 1e-4, "longitude_deg": 116.4 - second * 1e-4, "height_m": 50.0, "v_north_m_s": 10.0,
               "v_east_m_s": -5.0}
        at = START_MS + second * 1000
        utc = judge.GPS_EPOCH + judge.datetime.timedelta(milliseconds=at - judge.LEAP_S * 1000)
        solutions[at] = row
        reports += [{"class": "TPV", "mode": 3, "time": utc.strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z", "lat": round(row["latitude_deg"], 9),
                     "lon": round(row["longitude_deg"], 9), "altHAE": 50.0, "speed": round(math.hypot(10, 5), 3)},
                    {"class": "SKY", "satellites": satellites}]
        place = lambda value, width: f"{int(value):0{width}d}{(value - int(value)) * 60:09.6f}"
        body = f"GNGGA,{utc.strftime('%H%M%S')}.00,{place(row['latitude_deg'], 2)},N,{place(row['longitude_deg'], 3)},E,1,10,0.90,50.000,M,0.0,M,,"
        data += f"${body}*{functools.reduce(operator.xor, body.encode()):02X}\r\n".encode()
    return solutions, reports, data


def main():
    solutions, reports, data = drive()
    faults_of = lambda changed: judge.gpsd_against(solutions, "test", changed)[0]
    check("gpsd as it must be", faults_of(reports), False)
    changed = lambda index, **fields: [{**one, **fields} if at == index else one for at, one in enumerate(reports)]
    check("a latitude off by 2 mm", faults_of(changed(20, lat=reports[20]["lat"] + 2e-8)), True)
    check("a height off by 2 mm", faults_of(changed(20, altHAE=50.002)), True)
    check("a speed off by 2 mm/s", faults_of(changed(20, speed=reports[20]["speed"] + 0.002)), True)
    check("a time without SOLUTION", faults_of(changed(20, time=reports[20]["time"].replace(".000", ".500"))), True)
    gps_alone = [{**one, "satellites": [{**each, "gnssid": 0} for each in one["satellites"]]} if one["class"] == "SKY" else one for one in reports]
    check("satellites of GPS alone", faults_of(gps_alone), True)
    check("a serial port as it must be", judge.nmea(solutions, data, 60), False)
    check("a wrong digit with its old checksum", judge.nmea(solutions, data.replace(b",N,", b",S,", 1), 60), True)
    check("half of the sentences", judge.nmea(solutions, data[:len(data) // 2], 60), True)
    check("another time of day", judge.nmea({at + 1: row for at, row in solutions.items()}, data, 60), True)
    check("connections as they must be", judge.connections(CASTER, SAID), False)
    check("a break that is not told", judge.connections(CASTER, SAID.replace("the server closed", "x", 1)), True)
    check("never open again", judge.connections(CASTER, SAID.rsplit("info", 1)[0]), True)
    table = pd.DataFrame({"gps_week": 2446, "gps_tow_s": range(10), "latitude_deg": 39.9, "longitude_deg": 116.4, "height_m": 50.0,
                          **{f"v_{axis}_m_s": 1.0 for axis in ("north", "east", "down")},
                          **{f"{angle}_deg": 359.9999 for angle in ("roll", "pitch", "yaw")}})
    moved = table.assign(latitude_deg=table["latitude_deg"] + 1e-7, v_east_m_s=1.5, yaw_deg=-0.0002)
    _, place, velocity, turn = judge.differences(table, moved)
    expected = (math.radians(1e-7) * judge.EARTH_M, 0.5, 0.0001)
    if any(abs(got.max() - wanted) > 1e-6 for got, wanted in zip((place, velocity, turn), expected)):
        sys.exit(f"FAILED: differences {place.max()}, {velocity.max()}, {turn.max()} instead of {expected}")
    print("live_judge_test: passed")


if __name__ == "__main__":
    main()
