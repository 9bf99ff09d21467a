"""Reads LCM event logs, to which journals belong, event by event.

Format (LCM documentation, "Log file format"), big endian: sync word 0xEDA1DA01, event number (8 bytes), timestamp in
microseconds (8), length of the channel's name (4), length of the data (4), name, data.
"""
import os
import struct
import warnings
from typing import Iterator, NamedTuple

from .errors import LeonavError, LeonavWarning
from .pieces import files_of

SYNC = b"\xed\xa1\xda\x01"
HEADER = struct.Struct(">4sqqII")
MOST_CHANNEL_BYTES = 999  # as liblcm and leonav's own reader
MOST_DATA_BYTES = 64 << 20
FIRST_SEARCH_BYTES, MOST_SEARCH_BYTES = 1 << 10, 1 << 20


class Event(NamedTuple):
    """One message of a log."""

    offset: int  # byte of the file at which the event begins
    timestamp_us: int  # when it was logged, of a journal data time or wall clock, microseconds
    channel: str
    data: bytes


def events(path, damaged="raise") -> Iterator[Event]:
    """Yields the events of a log in the file's order, those of a journal's pieces as one log.

    `path` is a log, the first piece of a journal, or the folder with the pieces of one run.

    A log whose last event is cut short, as by a power failure, yields what is there, then warns with LeonavWarning. Where a
    log is damaged in between, LeonavError names the byte; with damaged="skip" reading goes on at the next event that is
    whole, and one LeonavWarning at the end says how many bytes were left out.
    """
    if damaged not in ("raise", "skip"):
        raise ValueError("damaged must be 'raise' or 'skip'")
    try:
        pieces = files_of(path)
    except OSError as error:
        raise LeonavError(f"{path}: {error.strerror}; check the path") from error
    if not pieces:
        for _, event in _events_of(path, damaged):
            yield event
        return
    if pieces[0].number > 1:
        warnings.warn(f"{path}: the log begins with piece {pieces[0].number} of its run; a replay of it is another run, because the state "
                      "in which it begins follows from the pieces before it. Give the first piece", LeonavWarning, stacklevel=2)
    following, missing = 0, 0
    for piece in pieces:
        for number, event in _numbered(piece, damaged, is_last=piece == pieces[-1]):
            if number < following:  # the beginning of a piece again, or what a failing disk had taken after all
                continue
            missing += number - following
            following = number + 1
            yield event
    if missing:
        warnings.warn(f"{path}: {missing} messages are missing with pieces that are gone", LeonavWarning, stacklevel=2)


def _numbered(piece, damaged, is_last):
    """Yields the events of a piece with their numbers, of which each follows on the one before; another number is damage.

    Behind the mark PIECE stands the number that it names, or where a program has copied the log, the next one. With damaged="skip" an event whose number cannot be is left out. Where bytes were left out before it, it can be a later one.
    """
    expected, copied, end, left_out, first_damage = 0, None, 0, 0, None
    for number, event in _events_of(piece.path, damaged, is_last):
        most = expected + max(0, event.offset - end) // (HEADER.size + 1)  # behind as many events as were left out
        end = event.offset + HEADER.size + len(event.channel.encode(errors="replace")) + len(event.data)
        if not expected <= number <= most and number != copied:
            if damaged == "raise":
                raise LeonavError(f"{piece.path}: byte {event.offset}: an event with the number {number} instead of {expected}; the log is "
                                  "damaged; read what is good with damaged='skip'")
            first_damage = event.offset if first_damage is None else first_damage
            left_out, expected, copied = left_out + 1, expected + 1, None
            continue
        is_mark = number <= 1 and event.channel.endswith("PIECE")
        expected, copied = (piece.first, number + 1) if is_mark else (number + 1, None)
        yield number, event
    if left_out:
        warnings.warn(f"{piece.path}: byte {first_damage}: the log is damaged; {left_out} events whose numbers are wrong are left out",
                      LeonavWarning, stacklevel=5)


def _events_of(path, damaged, is_last=True):
    """Yields the events of one file with their numbers."""
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size == 0:
                raise LeonavError(f"{path}: byte 0: the file is empty; give a log of leonav-import, leonavd or lcm-logger")
            yield from _events(path, file, size, damaged == "skip", is_last)
    except OSError as error:
        raise LeonavError(f"{path}: {error.strerror}; check the path") from error


def _events(path, file, size, skip, is_last):
    position, left_out, first_damage = 0, 0, None
    while position < size:
        header = file.read(HEADER.size)
        what = _why_bad(header, position, size)
        if what is None:
            _, number, stamp, channel_bytes, data_bytes = HEADER.unpack(header)
            end = position + HEADER.size + channel_bytes + data_bytes
            channel = file.read(channel_bytes).decode(errors="replace")
            data = file.read(data_bytes)
            if len(data) == data_bytes:
                yield number, Event(position, stamp, channel, data)
                position = end
                continue
            what = "cut"
        following = _next_event(file, position + 1, size) if skip else None
        if following is None and what == "cut" and not is_last:
            break  # the next piece has it
        if following is None and what == "cut":
            warnings.warn(f"{path}: byte {position}: the last event is cut short, {size - position} bytes are left out; all before "
                          "it was read. The log was not closed: stop the program that writes it, or keep what is there", LeonavWarning,
                          stacklevel=5)
            break
        if not skip:
            what = "an event begins here that is longer than the file" if what == "cut" else what
            raise LeonavError(f"{path}: byte {position}: {what}; read what is good with damaged='skip'" if position else
                              f"{path}: byte 0: {what}; give a log of leonav-import, leonavd or lcm-logger")
        first_damage = position if first_damage is None else first_damage
        following = size if following is None else following
        left_out += following - position
        position = following
        file.seek(position)
    if left_out:
        warnings.warn(f"{path}: byte {first_damage}: the log is damaged; {left_out} bytes are left out in all", LeonavWarning, stacklevel=5)


def _why_bad(header, position, size):
    """Returns what is wrong with the header of an event: "cut" where the file ends before the event does, None if nothing."""
    if not SYNC.startswith(header[:4]) and not header.startswith(SYNC):
        return "no event starts here; the log is damaged" if position else "this is not an LCM log (no sync word at its start)"
    if len(header) < HEADER.size:
        return "cut"
    _, _, _, channel_bytes, data_bytes = HEADER.unpack(header)
    if not 0 < channel_bytes <= MOST_CHANNEL_BYTES:
        return f"an event with a channel name of {channel_bytes} bytes; the log is damaged"
    if data_bytes > MOST_DATA_BYTES:
        return f"an event with {data_bytes} bytes of data; the log is damaged"
    return "cut" if position + HEADER.size + channel_bytes + data_bytes > size else None


def _next_event(file, start, size):
    """Returns where the next whole event begins, at `start` or behind it; None if there is none.

    No byte is read twice but at the blocks' borders, whatever false sync words come; the first blocks are small, as most damage is.
    """
    length = FIRST_SEARCH_BYTES
    while start < size:
        file.seek(start)
        block = file.read(length + HEADER.size - 1)
        at = block.find(SYNC)
        while 0 <= at < length:
            if _why_bad(block[at:at + HEADER.size], start + at, size) is None:
                return start + at
            at = block.find(SYNC, at + 1)
        start += length
        length = min(2 * length, MOST_SEARCH_BYTES)
    return None
