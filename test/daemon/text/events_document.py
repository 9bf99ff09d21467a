#!/usr/bin/env python3
"""Checks that docs/operations/events.md has the tables which leonavd prints, and a heading for each kind of event.

  events_document.py BIN_FOLDER
"""
import os
import re
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)
LEAST_KINDS = 27


def faults(printed, document):
    """What is wrong with the document."""
    tables = [table.strip() + "\n" for table in printed.split("\n\n")]
    for table in tables:
        if table not in document:
            yield "docs/operations/events.md has another table than `leonavd --events`; put this there:\n" + table
    kinds = re.findall(r"^\| (\d+) \| `(\w+)` \|", tables[0], re.M)
    if len(tables) != 3 or len(kinds) < LEAST_KINDS:
        yield f"leonavd --events prints {len(tables)} tables and {len(kinds)} kinds"
    headings = ", ".join(line[4:] for line in document.splitlines() if line.startswith("### "))
    for number, name in kinds:
        if f"{name} ({number})" not in headings.split(", "):
            yield f"docs/operations/events.md has no heading `{name} ({number})`"


def main(folder):
    printed = subprocess.run([os.path.join(folder, "leonavd"), "--events"], check=True, capture_output=True, text=True).stdout
    with open(os.path.join(ROOT, "docs", "operations", "events.md"), encoding="utf-8") as file:
        found = list(faults(printed, file.read()))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
