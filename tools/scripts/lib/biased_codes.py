#!/usr/bin/env python3
"""Adds a known bias of each satellite to codes of a RINEX 3 observation file, and writes what was added.

  biased_codes.py OBSERVATIONS SIGMA_M OUT.obs OUT.biases [SYSTEM:CODE...]

Of each signal (G:1W as it is named; default G:1W G:2W E:1C E:5Q) every satellite gets one number, drawn with SIGMA_M, which
stays for the file. OUT.biases has a line for each: satellite, signal, metres that were added to the code. Nothing else changes.
"""
import random
import sys

DEFAULT = ("G:1W", "G:2W", "E:1C", "E:5Q")


def types_of(lines):
    """{system: [observation, ...]} of the header, and the number of its lines."""
    types, system = {}, None
    for number, line in enumerate(lines):
        label = line[60:].strip()
        if label == "SYS / # / OBS TYPES":
            system = line[0] if line[0] != " " else system
            types.setdefault(system, []).extend(line[7:58].split())
        if label == "END OF HEADER":
            return types, number + 1
    sys.exit("biased_codes.py: the header of the observations does not end")


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    source, sigma, out, table = sys.argv[1], float(sys.argv[2]), sys.argv[3], sys.argv[4]
    signals = [word.split(":") for word in sys.argv[5:] or DEFAULT]
    with open(source, encoding="ascii") as file:
        lines = file.read().splitlines()
    types, first = types_of(lines)
    columns = {system: {types[system].index("C" + code): code for of, code in signals if of == system and "C" + code in types[system]}
               for system in types}
    biases = {}

    def bias(satellite, code):
        # Of a generator of its own, so that another satellite changes nothing.
        return biases.setdefault((satellite, code), round(random.Random(f"{satellite} {code}").gauss(0.0, sigma), 2))

    for index in range(first, len(lines)):
        line = lines[index]
        for column, code in columns.get(line[:1], {}).items():
            at = 3 + 16 * column
            text = line[at:at + 14]
            if text.strip():
                line = f"{line[:at]}{float(text) + bias(line[:3], code):14.3f}{line[at + 14:]}"
        lines[index] = line
    with open(out, "w", encoding="ascii") as file:
        file.write("\n".join(lines) + "\n")
    with open(table, "w", encoding="ascii") as file:
        file.writelines(f"{satellite} {code} {metres:.2f}\n" for (satellite, code), metres in sorted(biases.items()))
    print(f"{out}: {len(biases)} biases of codes, 1 sigma {sigma} m")


if __name__ == "__main__":
    main()
