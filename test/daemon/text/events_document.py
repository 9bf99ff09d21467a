#!/usr/bin/env python3
"""Checks that docs/operations/events.md has the tables which leonavd prints, that these have a row for each constant of
lcmtypes/event_t.lcm, and that the document has a heading for each kind of event.

  events_document.py BIN_FOLDER
"""
import os
import re
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)
# Of the constants that the rows of each table are, with those that it leaves out.
PREFIXES = (("KIND", ()), ("FAULT", ("FAULT_NONE",)), ("RESET", ()))


def numbers_of(message, prefix, left_out):
    return {int(number) for name, number in re.findall(rf"\b({prefix}_\w+) = (\d+)", message) if name not in left_out}


def faults(printed, document, message):
    """What is wrong with the document or with the tables."""
    tables = [table.strip() + "\n" for table in printed.split("\n\n")]
    for table in tables:
        if table not in document:
            yield "docs/operations/events.md has another table than `leonavd --events`; put this there:\n" + table
    kinds = re.findall(r"^\| (\d+) \| `(\w+)` \|", tables[0], re.M)
    if len(tables) != len(PREFIXES):
        yield f"leonavd --events prints {len(tables)} tables"
    for table, (prefix, left_out) in zip(tables, PREFIXES):
        rows = {int(number) for number in re.findall(r"^\| (\d+) \|", table, re.M)}
        wanted = numbers_of(message, prefix, left_out)
        if rows != wanted or not rows:
            yield f"leonavd --events and {prefix}_* of lcmtypes/event_t.lcm differ in {sorted(rows ^ wanted)}"
    headings = ", ".join(line[4:] for line in document.splitlines() if line.startswith("### "))
    for number, name in kinds:
        if f"{name} ({number})" not in headings.split(", "):
            yield f"docs/operations/events.md has no heading `{name} ({number})`"


def main(folder):
    printed = subprocess.run([os.path.join(folder, "leonavd"), "--events"], check=True, capture_output=True, text=True).stdout
    with open(os.path.join(ROOT, "docs", "operations", "events.md"), encoding="utf-8") as document, \
            open(os.path.join(ROOT, "lcmtypes", "event_t.lcm"), encoding="utf-8") as message:
        found = list(faults(printed, document.read(), message.read()))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
