"""Where in the sky signals were used, left out and lost.

Lost are epochs in which a satellite that was there before and after is missing, at the direction between its neighbours in time, and
those in which it came without a usable signal or too weak. Epochs without any satellite are not counted: no input may have come.
"""
from typing import NamedTuple

import numpy as np

USED = ("used",)
WEAKENED = ("downweighted",)
REJECTED = ("outlier", "implausible", "faulty")
LOST = ("no_usable_signal", "low_cn0")
AZIMUTH_STEP, ELEVATION_STEP = 10.0, 7.5  # degrees, of the cells of the share that is lost
FEWEST_EPOCHS = 5  # of a cell that says anything


class SkyTrack(NamedTuple):
    """One satellite over time: direction in degrees and what became of it, epoch by epoch."""

    satellite: str
    time: np.ndarray
    azimuth: np.ndarray  # continuous, beyond 360 where it turns on
    elevation: np.ndarray
    kind: np.ndarray  # "used", "weakened", "rejected", "lost", "left out"


def kind_of(reasons):
    """What became of a satellite, by its reason."""
    kinds = np.full(len(reasons), "left out", dtype=object)
    for kind, some in (("used", USED), ("weakened", WEAKENED), ("rejected", REJECTED), ("lost", LOST)):
        kinds[np.isin(reasons, some)] = kind
    return kinds


def sky_tracks(satellites):
    """The tracks of all satellites of a table, by name. A direction that is not known, or 0 and 0, lies between its neighbours in time."""
    epochs = np.unique(satellites.time)
    azimuth, elevation = satellites["azimuth_deg"], satellites["elevation_deg"]
    known = np.isfinite(azimuth + elevation) & ((azimuth != 0.0) | (elevation != 0.0))
    tracks = []
    for name in sorted(set(satellites["satellite"][known])):
        mine = satellites["satellite"] == name
        time, first = np.unique(satellites.time[mine & known], return_index=True)
        rows = np.flatnonzero(mine & known)[first]
        every = epochs[(epochs >= time[0]) & (epochs <= time[-1])]
        kinds = np.full(len(every), "lost", dtype=object)
        told = np.flatnonzero(mine & (satellites.time >= time[0]) & (satellites.time <= time[-1]))
        kinds[np.searchsorted(every, satellites.time[told])] = kind_of(satellites["reason"][told])
        turned = np.degrees(np.unwrap(np.radians(azimuth[rows])))
        tracks.append(SkyTrack(name, every, np.interp(every, time, turned), np.interp(every, time, elevation[rows]), kinds))
    return tracks


def lost_share(tracks):
    """Returns edges of azimuth and elevation in degrees and the share of lost epochs in each cell, NaN where there are too few."""
    azimuth_edges = np.arange(0.0, 360.0 + AZIMUTH_STEP, AZIMUTH_STEP)
    elevation_edges = np.arange(0.0, 90.0 + ELEVATION_STEP, ELEVATION_STEP)
    counted, lost = (np.zeros((len(azimuth_edges) - 1, len(elevation_edges) - 1)) for _ in range(2))
    for track in tracks:
        for counts, mask in ((counted, slice(None)), (lost, track.kind == "lost")):  # a signal that is left out has been received
            counts += np.histogram2d(track.azimuth[mask] % 360.0, track.elevation[mask], (azimuth_edges, elevation_edges))[0]
    share = np.where(counted >= FEWEST_EPOCHS, lost / np.maximum(counted, 1), np.nan)
    return azimuth_edges, elevation_edges, share


def horizon(azimuth_edges, elevation_edges, share):
    """The upper edge of the highest cell of each azimuth in which half of the epochs or more were lost; NaN where there is none."""
    blocked = np.nan_to_num(share) >= 0.5
    top = [elevation_edges[1:][row].max() if row.any() else np.nan for row in blocked]
    return np.array(top)
