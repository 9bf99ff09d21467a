"""What happened when: rows of spans and ticks from health, answers, misses, inputs and events."""
from typing import NamedTuple

import numpy as np

from . import style
from .gaps import GAP_INTERVALS, gaps, solution_gaps, usual_interval

INPUT_NAMES = {
    "IMU": "IMU",
    "GNSS_EPOCH": "GNSS",
    "ODOMETER": "odometer",
    "CORRECTED_STATES": "corrections",
    "ORBIT_CLOCK": "precise orbits",
     "EPHEMERIS": "ephemerides"}
PERIODIC = ("IMU", "GNSS_EPOCH", "ODOMETER", "CORRECTED_STATES")  # others come as they change
MISSES = {"filter": "filter late", "smoother": "smoother late"}
GAP_COLOR = style.BLACK
NOT_KNOWN = "not known: no journal"


class Row(NamedTuple):
    """One line of the picture."""

    name: str
    spans: list  # of (begin, end, colour)
    ticks: np.ndarray  # times
    color: str  # of the ticks
    note: str


def spans_of(time, values, colors, longest_s):
    """Spans (begin, end, colour) over which a value stays the same; the last row of a value lasts until the next one, at most longest_s."""
    if not len(time):
        return []
    until = np.minimum(np.concatenate([time[1:], [time[-1]]]), time + longest_s)
    new = np.concatenate([[True], (values[1:] != values[:-1]) | (time[1:] - time[:-1] > longest_s)])
    first = np.flatnonzero(new)
    last = np.concatenate([first[1:], [len(time)]]) - 1
    return [(time[a], max(until[b], time[a]), colors.get(values[a], style.GREY)) for a, b in zip(first, last)]


def gap_note(found):
    """"no gap", or how many there are and the longest."""
    if not len(found):
        return "no gap"
    longest = style.duration(float((found[:, 1] - found[:, 0]).max()))
    return f"1 gap, {longest}" if len(found) == 1 else f"{len(found)} gaps, longest {longest}"


def shares(values, names):
    """"smoother 89 %, filter 11 %" of an array of values."""
    parts = [(float(np.mean(values == value)), name) for value, name in names.items()]
    return ", ".join(f"{name} {style.percent(share)}" for share, name in parts if share > 0)


def health_row(run):
    if run.health is None:
        return Row("health", [], np.zeros(0), style.GREY, NOT_KNOWN)
    status = run.health["status"]
    # Of a log that was played fast, its seconds are longer.
    longest = max(3.0, GAP_INTERVALS * usual_interval(run.health.time)) if len(status) > 2 else 3.0
    return Row("health", spans_of(run.health.time, status, style.STATUS_COLORS, longest), np.zeros(0), style.GREY,
               shares(status, {one: one for one in style.STATUS_COLORS}))


def answer_rows(run):
    """Who answered, and the gaps of the solution."""
    table = run.solution
    found = run.solution_gaps if run.continuous else solution_gaps(table)
    longest = GAP_INTERVALS * usual_interval(table.time) if len(table) > 2 else 1.0
    source = table["source"]
    note = shares(source, style.SOURCE_NAMES) or "source not known"
    solution = [(table.time[0], table.time[-1], style.LIGHT)]
    return [Row("answer from", spans_of(table.time, source, style.SOURCE_COLORS, longest), np.zeros(0), style.GREY, note),
            Row("solution", solution + [(begin, end, GAP_COLOR) for begin, end in found], np.zeros(0), style.GREY, gap_note(found))]


def miss_rows(run):
    """Deadlines that were missed, of both estimators: by their decisions, else by the events, which are thinned."""
    if run.decisions is not None:
        rows = []
        for mailbox, name in MISSES.items():
            mine = run.decisions["mailbox"] == mailbox
            if not mine.any():
                continue
            late = run.decisions.time[mine & (run.decisions["committed"] == 0)]
            rows.append(Row(name, [], late, style.VERMILLION, f"{len(late)} of {int(mine.sum())} missed the deadline"))
        return rows
    if run.events is not None:
        late = run.events.time[run.events["event"] == "deadline_miss"]
        return [Row("late results", [], late, style.VERMILLION, f"{len(late)} events, which are thinned")]
    return [Row("late results", [], np.zeros(0), style.GREY, NOT_KNOWN)]


def input_rows(run):
    if run.inputs is None:
        return [Row("inputs", [], np.zeros(0), style.GREY, NOT_KNOWN)]
    rows = []
    for channel, time in run.inputs.items():
        name = INPUT_NAMES[channel]
        if channel not in PERIODIC or len(time) < 3:
            rows.append(Row(name, [], time, style.BLUE, f"{len(time)} times"))
            continue
        found = gaps(time)
        rate = 1.0 / max(usual_interval(time), 1e-9)
        rows.append(Row(name, [(time[0], time[-1], style.SKY)] + [(begin, end, GAP_COLOR) for begin, end in found], np.zeros(0),
                        style.GREY, f"{f'{rate:.3g} Hz' if rate > 0.5 else f'each {style.duration(1.0 / rate)}'}, {gap_note(found)}"))
    return rows


def event_rows(run, most=12):
    """A row for each kind of event, the most frequent last."""
    if run.events is None:
        return []
    told = ("deadline_miss",) if run.decisions is None else ()  # miss_rows shows them
    kinds, number = np.unique([*run.events["event"], ""], return_counts=True)
    some = sorted((count, kind) for kind, count in zip(kinds, number) if kind and kind not in told)[:most]
    return [Row(str(kind).replace("_", " "), [], run.events.time[run.events["event"] == kind],
                style.BLACK, f"{count} events" if count > 1 else "1 event") for count, kind in some]
