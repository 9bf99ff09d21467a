#!/usr/bin/env python3
"""Checks that docs/operations/health.md has the table of reasons which leonavd prints.

  reasons_document.py BIN_FOLDER
"""
import os
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)


def main(folder):
    table = subprocess.run([os.path.join(folder, "leonavd"), "--reasons"], check=True, capture_output=True, text=True).stdout
    with open(os.path.join(ROOT, "docs", "operations", "health.md"), encoding="utf-8") as document:
        if table.count("\n") > 30 and table in document.read():
            return 0
    print("docs/operations/health.md has another table of reasons than `leonavd --reasons`; put this there:\n" + table)
    return 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
