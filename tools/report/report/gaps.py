"""Gaps of a series that should come at regular times."""
import numpy as np

GAP_INTERVALS = 2.5  # of the usual interval; one lost message of a series without jitter is 2


def usual_interval(time):
    """The median interval of a series in s; NaN of fewer than three times."""
    return float(np.median(np.diff(time))) if len(time) > 2 else float("nan")


def was_answered(table):
    """Which rows of a solution rest on something: a prediction without GNSS and without an IMU is the course of before."""
    return table["source"] != "prediction"


def solution_gaps(table):
    """The gaps of a solution, in which there was no answer or only a prediction."""
    return gaps(table.time[was_answered(table)])


def gaps(time, shortest_s=0.0):
    """Returns the rows [begin, end] of times between which the series pauses: for longer than 2.5 usual intervals and `shortest_s`."""
    if len(time) < 3:
        return np.zeros((0, 2))
    step = np.diff(time)
    index = np.flatnonzero((step > GAP_INTERVALS * usual_interval(time)) & (step > shortest_s))
    return np.stack([time[index], time[index + 1]], axis=1)
