#!/usr/bin/env python3
"""What a Bias-SINEX file says at given instants, as an oracle for drivers/bias_sinex.

  bias_sinex.py FILE SECONDS...   one line for each satellite, code and instant with a bias: instant, satellite, code, metres

SECONDS count from 1980-01-06 in GPS time. The columns of a record are taken from the heading of its block, differences are
solved with all equations at once (least squares, rational numbers), and nothing is shared with the reader. The files of the
test are in GPS time.
"""
import datetime
import re
import sys
from fractions import Fraction

LIGHT = 299792458
# Carriers as multiples of 5.115 MHz.
CARRIERS = {"G": {"1": 308, "2": 240, "5": 230}, "E": {"1": 308, "5": 230, "6": 250, "7": 236, "8": 233},
            "C": {"1": 308, "2": Fraction(1526, 5), "5": 230, "6": 248, "7": 236, "8": 233}}
PAIRS = {"G": [("C1W", "C2W")], "E": [("C1C", "C5Q"), ("C1X", "C5X")], "C": [("C2I", "C6I")]}
EPOCH = datetime.datetime(1980, 1, 6)


def instant(text, open_value):
    year, day, second = (int(part) for part in text.split(":"))
    if year == day == second == 0:
        return open_value
    return (datetime.datetime(year, 1, 1) + datetime.timedelta(days=day - 1, seconds=second) - EPOCH).total_seconds()


def rows(path):
    block, fields = "", {}
    pairs = {system: list(pair) for system, pair in PAIRS.items()}
    records = []
    for line in open(path):
        line = line.rstrip("\n")
        if line.startswith("+"):
            block = line[1:]
        elif line.startswith("*BIAS ") and block == "BIAS/SOLUTION":
            spans = [match.span() for match in re.finditer(r"\S+", " " + line[1:])]
            names = ["kind", "svn", "prn", "station", "one", "two", "from", "until", "unit", "value", "sigma"]
            fields = dict(zip(names, spans))
        elif block == "BIAS/DESCRIPTION" and line.split()[:1] == ["SATELLITE_CLOCK_REFERENCE_OBSERVABLES"]:
            word = line.split()
            pairs[word[1]] = [tuple(word[2:4])]
        elif block == "BIAS/SOLUTION" and line.startswith(" ") and fields:
            row = {name: line[a:b].strip() for name, (a, b) in fields.items()}
            usable = row["kind"] in ("OSB", "DSB") and not row["station"] and re.fullmatch(r"[GEC]\d\d", row["prn"])
            if not usable or not row["one"].startswith("C") or row["unit"] != "ns":
                continue
            try:
                row["value"] = Fraction(row["value"])
                row["from"] = instant(row["from"], float("-inf"))
                row["until"] = instant(row["until"], float("inf"))
            except ValueError:
                continue
            records.append(row)
    return records, pairs


def solve(equations, count):
    """Least squares of rows (coefficients, right side); None where the unknowns are not determined."""
    normal = [[sum(c[i] * c[j] for c, _ in equations) for j in range(count)] + [sum(c[i] * b for c, b in equations)]
              for i in range(count)]
    for i in range(count):
        pivot = next((k for k in range(i, count) if normal[k][i] != 0), None)
        if pivot is None:
            return None
        normal[i], normal[pivot] = normal[pivot], normal[i]
        normal[i] = [value / normal[i][i] for value in normal[i]]
        for k in range(count):
            if k != i:
                factor = normal[k][i]
                normal[k] = [a - factor * b for a, b in zip(normal[k], normal[i])]
    return [row[count] for row in normal]


def islands(differences):
    groups = []
    for row in differences:
        touching = [group for group in groups if row["one"] in group or row["two"] in group]
        merged = {row["one"], row["two"]}.union(*touching)
        groups = [group for group in groups if group not in touching] + [merged]
    return groups


def of_satellite(system, records, pairs):
    absolute = {row["one"]: row["value"] for row in records if row["kind"] == "OSB"}
    differences = [row for row in records if row["kind"] == "DSB"]
    for group in islands(differences):
        pair = next((pair for pair in pairs[system] if set(pair) <= group), None)
        if pair is None:
            continue
        codes = sorted(group)
        equations = []
        for row in differences:
            if row["one"] in group:
                equations.append(([(code == row["one"]) - (code == row["two"]) for code in codes], row["value"]))
        squares = [Fraction(CARRIERS[system][code[1]]) ** 2 for code in pair]
        equations.append(([squares[0] * (code == pair[0]) - squares[1] * (code == pair[1]) for code in codes], Fraction(0)))
        absolute.update(zip(codes, solve(equations, len(codes))))
    return absolute


def main():
    records, pairs = rows(sys.argv[1])
    for text in sys.argv[2:]:
        time = float(text)
        for satellite in sorted({row["prn"] for row in records}):
            held = [row for row in records if row["prn"] == satellite and row["from"] <= time < row["until"]]
            for code, value in sorted(of_satellite(satellite[0], held, pairs).items()):
                print(text, satellite, code[1:], repr(float(value * LIGHT / 10 ** 9)))


if __name__ == "__main__":
    main()
