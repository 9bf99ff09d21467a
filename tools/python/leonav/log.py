"""Reads event logs and journals into tables."""
import collections
import os
import warnings

import numpy as np
import pandas as pd

from . import tables
from .errors import LeonavError, LeonavWarning
from .event_log import events
from .lcm_types import TYPES, MessageError, type_of


class _Channel:
    """Collects the messages of one channel, and counts those that cannot be read by reason."""

    def __init__(self, name):
        self.name, self.refused, self.first = name, collections.Counter(), None
        type_names, self.make = tables.CHANNELS[name]
        self.types = [TYPES[one] for one in type_names]
        self.is_fixed = self.types[0].dtype is not None
        self.messages = collections.defaultdict(list)  # by type, whose tables are joined at the end

    def add(self, event):
        kind = type_of(event.data)
        if kind not in self.types:
            self.refuse(event, "of a type that is not the channel's" if kind else "of a type that is not known")
        elif self.is_fixed:
            if len(event.data) == kind.dtype.itemsize + 8:
                self.messages[kind].append(event.data)
            else:
                self.refuse(event, f"{kind.name} of a wrong length")
        else:
            try:
                self.messages[kind].append(kind.decode(event.data))
            except MessageError as error:
                self.refuse(event, f"{kind.name} that {error}")

    def refuse(self, event, why):
        self.refused[why] += 1
        if self.first is None:
            self.first = event.offset

    def tables(self):
        parts = collections.defaultdict(list)
        for kind in self.types[::-1]:
            if not self.messages[kind]:
                continue
            messages = self.messages.pop(kind)
            if self.is_fixed:
                whole = np.dtype([("fingerprint", "S8"), ("message", kind.dtype)])
                messages = np.frombuffer(b"".join(messages), whole)["message"]
            with np.errstate(over="ignore", invalid="ignore"):  # a damaged message may hold any number
                made = self.make(messages)
            for suffix, table in made.items():
                parts[self.name + suffix].append(table)
        return {name: some[0] if len(some) == 1 else pd.concat(some, ignore_index=True) for name, some in parts.items()}


def read_log(path, channels=None, prefix="LEONAV_", damaged="raise"):
    """Returns the messages of an event log or journal as a dict of DataFrames by channel: "SOLUTION", "IMU", "GNSS_EPOCH", ...

    `channels` names those to read, without prefix; None reads all. EPOCH has two more tables, EPOCH_SATELLITES and
    EPOCH_MEASUREMENTS, and HEALTH has HEALTH_COUNTS. Each table begins with gps_week, gps_tow_s and utc; units are in the columns'
    names. `prefix` is lcm.prefix of the configuration. Messages that cannot be read are left out, with a LeonavWarning that says
    how many, why, and at which byte the first is. A log that is cut short yields what is there, with a LeonavWarning. LeonavError
    names file, byte and remedy where the file is no log, is damaged (damaged="skip" reads on behind the damage), or has no
    message on the channels.
    """
    path = os.fspath(path)
    wanted = set(tables.CHANNELS if channels is None else [channels] if isinstance(channels, str) else channels)
    unknown = sorted(wanted - set(tables.CHANNELS))
    if unknown:
        raise ValueError(f"there is no channel {unknown[0]}; channels are {', '.join(tables.CHANNELS)}")
    found, others = {}, collections.Counter()
    for event in events(path, damaged):
        name = event.channel[len(prefix):] if event.channel.startswith(prefix) else None
        if name in wanted:
            found.setdefault(name, _Channel(name)).add(event)
        else:
            others[event.channel] += 1
    result = {}
    for channel in found.values():
        result.update(channel.tables())
        if channel.refused:
            reasons = "; ".join(f"{count} {why}" for why, count in channel.refused.most_common(5))
            warnings.warn(f"{path}: byte {channel.first}: messages of {prefix}{channel.name} are left out, the first is here: {reasons}. "
                          "They are damaged or of another version of leonav", LeonavWarning, stacklevel=2)
    if not result:
        there = ", ".join(f"{name} {count}" for name, count in others.most_common(8)) or "nothing"
        raise LeonavError(f"{path}: no message that can be read on {prefix}{'|'.join(sorted(wanted)) if channels else '*'}; the log holds "
                          f"{there}. Give channels= or prefix= as it has them")
    return result
