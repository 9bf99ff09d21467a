"""Sorts residuals by kind and satellite."""
from typing import NamedTuple

import numpy as np

KINDS = {"code": ("code", "m"), "carrier": ("carrier", "m"), "doppler": ("Doppler", "m/s")}
REJECTED = ("outlier", "implausible", "faulty")
NOT_TRIED = ("no_position", "not_solved")


class Counts(NamedTuple):
    """How many measurements were used, of these down-weighted, and rejected."""

    used: int
    weakened: int
    rejected: int

    @property
    def total(self):
        return self.used + self.rejected


def tried(measurements):
    """Which measurements the estimator has weighed: those with a residual or rejected by their size."""
    reason = measurements["reason"]
    return np.isin(reason, ("used", "downweighted") + REJECTED) & np.isfinite(measurements["residual"])


def counts(reasons):
    """Counts of an array of reasons."""
    return Counts(int(np.isin(reasons, ("used", "downweighted")).sum()), int((reasons == "downweighted").sum()),
                  int(np.isin(reasons, REJECTED).sum()))


def kinds_of(measurements):
    """The kinds that there are, in their order."""
    there = set(measurements["observable"])
    return [kind for kind in KINDS if kind in there]


def over_time(time, values, bins, function):
    """A value for each bin of time between edges; NaN where there is none."""
    slot = np.searchsorted(bins, time, side="right") - 1
    out = np.full(len(bins) - 1, np.nan)
    good = np.flatnonzero((slot >= 0) & (slot < len(out)) & np.isfinite(values))
    if len(good):
        order = good[np.argsort(slot[good], kind="stable")]
        slots, first = np.unique(slot[order], return_index=True)
        for one, part in zip(slots, np.split(values[order], first[1:])):
            out[one] = function(part)
    return out


def largest(values):
    """The value that is farthest from zero, with its sign."""
    return values[np.argmax(np.abs(values))]
