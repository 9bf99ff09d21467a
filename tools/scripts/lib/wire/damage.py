"""What is done to the bytes of a stream, which is a list of (s, bytes)."""
import itertools


def between(begin, end, change):
    """The stream with `change` of each message from `begin` up to `end`, s; what it makes empty is left out."""
    def changed(stream):
        for t, data in stream:
            data = change(data) if begin <= t < end else data
            if data:
                yield t, data
    return lambda stream: list(changed(stream))


def flipped(rate, dice):
    """One bit of a byte is turned over, of `rate` of all bytes."""
    def change(data):
        return bytes(byte ^ 1 << dice.randrange(8) if dice.random() < rate else byte for byte in data)
    return change


def halved(share, dice):
    """Of `share` of all messages nothing comes behind some place within."""
    return lambda data: data[:dice.randrange(len(data))] if dice.random() < share else data


# The bit of the length field that makes of an epoch's message one of 512 (RTCM 3), 4096 (UBX) or 8192 bytes more, which the formats
# allow: its byte, from the first one of the message on, and its mask.
LENGTH_BITS = {"ubx": (5, 0x10), "rtcm3": (1, 0x02), "oem7": (9, 0x20), "sbf": (7, 0x20)}


def lengthened(kind):
    """Of every third message the length field is wrong by one bit."""
    place, mask = LENGTH_BITS[kind]
    seen = itertools.count()
    return lambda data: data[:place] + bytes([data[place] ^ mask]) + data[place + 1:] if next(seen) % 3 == 0 else data


def misread(sent_baud, read_baud):
    """What a port set to `read_baud` makes of bytes sent at `sent_baud`: 8 data bits, one stop bit, no parity.

    The line rests at 1. The port begins a byte at a falling edge and reads each bit in its middle; where the stop bit is not 1
    Linux gives a zero byte, and the port waits for the next falling edge. Each call is a piece sent without pause.
    """
    def change(data):
        line = [1]
        for byte in data:
            line += [0, *(byte >> bit & 1 for bit in range(8)), 1]
        step, out, at = sent_baud / read_baud, bytearray(), 0.0
        level = lambda time: line[int(time)] if time < len(line) else 1
        while at < len(line):
            if level(at) != 0:
                at = int(at) + 1.0
                continue
            byte = sum(level(at + step * (1.5 + bit)) << bit for bit in range(8))
            is_framed = level(at + step * 9.5) == 1
            out.append(byte if is_framed else 0)
            at += step * 9.5
            while at < len(line) and level(at) == 0:  # of a byte that is not framed, or just behind the stop bit's middle
                if is_framed:
                    break
                at = int(at) + 1.0
        return bytes(out)
    return change


def without(begin, end):
    return between(begin, end, lambda data: b"")


def merged(*streams):
    return sorted((item for stream in streams for item in stream), key=lambda item: item[0])
