"""Reads sentences of leonav-serve with pynmeagps and pynmea2 (PyPI) and compares them with the truth of live_test.py.

  nmea.py CLIENT.nmea TRUTH.csv
"""
import collections
import csv
import datetime
import sys

import pynmea2
import pynmeagps


def close(what, got, wanted, margin):
    if abs(got - wanted) > margin:
        sys.exit(f"{what}: {got} instead of {wanted}")


def main():
    with open(sys.argv[2], encoding="ascii") as file:
        truth = {}
        for time, *numbers in csv.reader(file):
            source, *values = numbers
            truth[datetime.datetime.fromisoformat(time)] = int(source), [float(value) for value in values]
    counts, day = collections.Counter(), min(truth).date()
    with open(sys.argv[1], "rb") as file:
        for line in file.read().splitlines(keepends=True):
            one = pynmeagps.NMEAReader.parse(line, msgmode=pynmeagps.GET, validate=pynmeagps.VALCKSUM)
            two = pynmea2.parse(line.decode("ascii").strip(), check=True)
            counts[one.talker + one.msgID] += 1
            if one.msgID in ("RMC", "GGA"):
                moment = datetime.datetime.combine(one.date if one.msgID == "RMC" else day, one.time)
                if one.msgID == "GGA" and moment not in truth:
                    moment += datetime.timedelta(days=1)
                if moment not in truth:
                    continue  # the last instant, which is not in the file
                source, (latitude, longitude, height, *_) = truth[moment]
                if source == 0:
                    if one.lat != "" or two.lat != "":
                        sys.exit(f"a position of nothing: {line}")
                    continue
                for reader, got in (("pynmeagps", (one.lat, one.lon)), ("pynmea2", (two.latitude, two.longitude))):
                    close(reader, got[0], latitude, 1e-8)
                    close(reader, got[1], longitude, 1e-8)
                if one.msgID == "GGA":
                    close("height", one.alt + one.sep, height, 5.1e-4)
                    if one.quality != (6 if source == 2 else 1) or two.gps_qual != one.quality:
                        sys.exit(f"quality of source {source}: {line}")
                elif one.posMode != ("E" if source == 2 else "A") or two.mode_indicator != one.posMode:
                    sys.exit(f"mode of source {source}: {line}")
    print(", ".join(f"{name} {count}" for name, count in sorted(counts.items())))


if __name__ == "__main__":
    main()
