#!/usr/bin/python3
"""Makes the manual of a program out of what it says with --help: manual.py PROGRAM SUMMARY VERSION < HELP > PAGE

Indented lines of the text, such as examples and YAML, are kept as they are; other text is filled; options become items. (help2man
fills examples too.)
"""
import re
import sys

OPTION = re.compile(r"  (-\S+(?: \S+|, \S+)*)(?:  +(\S.*))?$")
ARGUMENT = re.compile(r"  (\S+(?: \S+)*)(?:  +(\S.*))?$")


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def body(text):
    item, kept, after_item = OPTION, False, False  # kept: within lines that are not filled
    for line in text.splitlines():
        indented = line.startswith("  ")
        heading = re.fullmatch(r"(\S[a-z ]*):", line)
        option = item.match(line) if not kept else None
        if kept and line and not indented:
            kept = False
            yield ".fi"
        if heading:
            item = ARGUMENT if heading[1] == "positional arguments" else OPTION
            yield ".SH " + heading[1].upper()
        elif option:
            yield from (".TP", escaped(option[1]), *([escaped(option[2])] if option[2] else []))
        elif after_item and indented:
            yield escaped(line.strip())
        elif not line:
            yield "" if kept else ".PP"
        else:
            if indented and not kept:
                yield ".nf"
            kept = indented
            yield escaped(line)
        after_item = bool(option) or (after_item and indented)
    if kept:
        yield ".fi"


def page(program, summary, version, text):
    usage, _, rest = text.partition("\n\n")
    usage = re.sub(r"^(usage: |       )", "", usage, flags=re.M)
    yield from (f'.TH {program.upper()} 1 "" "leonav {version}" leonav', ".SH NAME", rf"{program} \- {summary}", ".SH SYNOPSIS", ".nf",
                *map(escaped, usage.splitlines()), ".fi", ".SH DESCRIPTION", *body(rest),
                ".SH SEE ALSO", ".BR leonav (7)")


print("\n".join(page(*sys.argv[1:4], sys.stdin.read())))
