"""Finds the files that one log consists of: the pieces of a journal, by what stands at their beginning."""
import os
import re
import struct
from typing import NamedTuple

from .errors import LeonavError

HEADER = struct.Struct(">4sqqII")
SYNC = b"\xed\xa1\xda\x01"
MOST_CHANNEL_BYTES = 999
PIECE = struct.Struct(">8xqqiqqb")  # piece_t behind its fingerprint: time, number, schema, run, first event, outputs
GREATEST_RUN = 7_258_118_400_000_000  # the year 2200, as in drivers/lcm/journal_marks.h
# As parse_piece_name of drivers/lcm: a number is 2 or more, and what is no ending belongs to the journal's name.
NAME = re.compile(r"(?P<journal>.+?)(\.part(?P<number>(?!0*[01](?![0-9]))[0-9]{4,9}))?(?P<kept>\.kept)?", re.DOTALL)


class Piece(NamedTuple):
    """One file of a journal."""

    number: int  # from 1
    path: str
    run: int  # the same in all pieces of a run
    first: int  # number of the first event behind its mark


def piece_of(path):
    """Returns the piece that a file holds; None where it holds none, as a log or a journal of an older version."""
    if not os.path.isfile(path):
        return None
    try:
        with open(path, "rb") as file:
            for _ in range(2):  # the configuration stands before it
                header = file.read(HEADER.size)
                if len(header) < HEADER.size or not header.startswith(SYNC):
                    return None
                channel_bytes, data_bytes = HEADER.unpack(header)[3:]
                if not 0 < channel_bytes <= MOST_CHANNEL_BYTES:
                    return None
                channel = file.read(channel_bytes)
                if channel.endswith(b"PIECE"):
                    data = file.read(data_bytes) if data_bytes == PIECE.size else b""
                    if len(data) != PIECE.size:
                        return None
                    _, number, _, run, first, _ = PIECE.unpack(data)
                    good = number > 0 and first >= 0 and 0 <= run <= GREATEST_RUN
                    return Piece(number, os.fspath(path), run, first) if good else None
                if not channel.endswith(b"CONFIG"):
                    return None
                file.seek(data_bytes, os.SEEK_CUR)
    except OSError:
        return None
    return None


def name_of(path):
    """Returns the path under which a log is: a piece that is kept after a fault has been renamed."""
    kept = os.fspath(path) + ".kept"
    return kept if not os.path.exists(path) and os.path.exists(kept) else os.fspath(path)


def files_of(path):
    """Returns the pieces that are read as one log, in order; an empty list where `path` is a log without pieces.

    A folder stands for the pieces of one run in it, a piece for itself and the later ones of its run beside it.
    """
    path = name_of(path)
    if os.path.isdir(path):
        found = _in(path, None)
        if not found:
            raise LeonavError(f"{path}: the folder holds no piece of a journal; give the log itself")
        if found[0].run != found[-1].run or len({one.run for one in found}) > 1:
            raise LeonavError(f"{path}: the folder holds journals of several runs; give the first piece of one of them")
    else:
        first = piece_of(path)
        if first is None:
            return []
        folder, name = os.path.split(os.fspath(path))
        beside = _in(folder or ".", NAME.fullmatch(name)["journal"])
        found = [first] + [one for one in beside if one.run == first.run and one.number > first.number]
    for one, other in zip(found, found[1:]):
        if one.number == other.number:
            raise LeonavError(f"{one.path}: is the same piece of a journal as {other.path}; move one of them away")
    return found


def _in(folder, journal):
    names = [name for name in os.listdir(folder) if journal is None or NAME.fullmatch(name)["journal"] == journal]
    found = [piece_of(os.path.join(folder, name)) for name in names]
    return sorted(one for one in found if one is not None)
