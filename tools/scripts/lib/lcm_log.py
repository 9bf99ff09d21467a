"""Reads LCM event logs."""
import struct

HEADER = struct.Struct(">IqqII")  # sync word, number, microseconds, lengths of channel and data


class DamagedLog(Exception):
    pass


def messages(path):
    """(wall time in s, channel, payload) of each; one that is cut short at the end is left out."""
    with open(path, "rb") as log:
        while len(header := log.read(HEADER.size)) == HEADER.size:
            sync, _, stamp_us, channel_length, data_length = HEADER.unpack(header)
            if sync != 0xEDA1DA01:
                raise DamagedLog(f"{path}: damaged before byte {log.tell()}")
            channel = log.read(channel_length).decode(errors="replace")
            data = log.read(data_length)
            if len(data) < data_length:
                return
            yield stamp_us * 1e-6, channel, data


def write(path, messages):
    """A log of (wall time in s, channel, payload)."""
    with open(path, "wb") as log:
        for number, (wall_s, channel, data) in enumerate(messages):
            name = channel.encode()
            log.write(HEADER.pack(0xEDA1DA01, number, round(wall_s * 1e6), len(name), len(data)) + name + data)
