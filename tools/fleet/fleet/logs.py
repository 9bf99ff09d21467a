"""Finds logs, their names in the report, and their truths."""
import collections
import os

ENDING = ".lcmlog"


class LogError(Exception):
    """What was given on the command line holds no log."""


def logs_below(folder):
    found = []
    for place, folders, names in os.walk(folder):
        folders.sort()
        found += [os.path.join(place, name) for name in sorted(names) if name.endswith(ENDING)]
    return found


def without_ending(path):
    return path[:-len(ENDING)] if path.endswith(ENDING) else path


def named(places):
    """{name: absolute path} of every log in `places`, each once: its path in its folder, where that is unique."""
    names = {}
    for place in places:
        if os.path.isdir(place):
            found = logs_below(place)
            if not found:
                raise LogError(f"{place}: has no *{ENDING}")
            base = place
        elif os.path.isfile(place):
            found, base = [place], os.path.dirname(place) or "."
        else:
            raise LogError(f"{place}: no such file or folder")
        for path in found:
            names.setdefault(os.path.realpath(path), without_ending(os.path.relpath(path, base)))
    if any(count > 1 for count in collections.Counter(names.values()).values()):
        common = os.path.commonpath([os.path.dirname(path) for path in names])
        names = {path: without_ending(os.path.relpath(path, common)) for path in names}
    return {name: path for path, name in sorted(names.items(), key=lambda item: item[1])}


def truth_of(log):
    """NAME.truth.csv or truth.csv beside the log; None: there is neither."""
    for path in (without_ending(log) + ".truth.csv", os.path.join(os.path.dirname(log), "truth.csv")):
        if os.path.isfile(path):
            return path
    return None
