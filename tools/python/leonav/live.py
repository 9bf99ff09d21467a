"""Receives LCM messages over UDP multicast.

Debian 12 has no LCM module for Python; this receives the datagrams by itself, which takes a socket and little more. Format of
a datagram, big endian (LCM documentation, "UDP Multicast Protocol"): a message that fits into one has the magic word "LC02", a
number, the channel with a zero byte, the data. A longer one comes in fragments: the magic word "LC03", a number, the size of the
data, the offset of the fragment, its index, how many there are; the first then has the channel with a zero byte.
"""
import re
import socket
import struct
import time
from typing import Any, Iterator, NamedTuple

from .errors import LeonavError
from .message import decode

SHORT, FRAGMENT = struct.Struct(">4sI"), struct.Struct(">4sIIIHH")
MOST_BYTES = 1 << 20  # of a message; leonav's longest has 40 KiB
MOST_UNFINISHED = 16  # messages of which fragments are missing
ROUTE = "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo"
BUFFER_BYTES = 2 << 20


class Message(NamedTuple):
    """A message as it came in."""

    channel: str  # without prefix
    type: str  # "solution_t", ...
    fields: Any  # dict of its members, with the names and units of lcmtypes/


class Assembler:
    """Puts datagrams together to messages; holds a bounded number of unfinished ones and drops the oldest."""

    def __init__(self):
        self._parts = {}
        self.dropped = 0  # datagrams that are no part of a message

    def add(self, datagram, sender):
        """Returns (channel, data) of the message that the datagram completes, else None."""
        if datagram[:4] == b"LC02" and len(datagram) > SHORT.size:
            return self._named(datagram[SHORT.size:])
        if datagram[:4] == b"LC03" and len(datagram) > FRAGMENT.size:
            return self._add_fragment(datagram, sender)
        self.dropped += 1
        return None

    def _named(self, rest):
        name, separator, data = rest.partition(b"\0")
        if not separator or not name:
            self.dropped += 1
            return None
        return name.decode(errors="replace"), data

    def _add_fragment(self, datagram, sender):
        _, number, size, offset, index, count = FRAGMENT.unpack_from(datagram)
        rest = datagram[FRAGMENT.size:]
        key = (sender, number)
        named = self._named(rest) if index == 0 else ("", rest)
        if named is None:
            return None
        channel, piece = named
        if size > MOST_BYTES or index >= count or offset + len(piece) > size:
            self.dropped += 1
            return None
        if key not in self._parts:
            while len(self._parts) >= MOST_UNFINISHED:
                self._parts.pop(next(iter(self._parts)))
                self.dropped += 1
            self._parts[key] = (size, count, {}, bytearray(size))
        known_size, known_count, seen, data = self._parts[key]
        if (known_size, known_count) != (size, count):
            del self._parts[key]
            self.dropped += 1
            return None
        seen[index] = channel
        data[offset:offset + len(piece)] = piece
        if len(seen) < count:
            return None
        del self._parts[key]
        return seen[0], bytes(data)


def subscribe(channels=None, prefix="LEONAV_", url="udpm://239.255.76.67:7667", timeout_s=None) -> Iterator[Message]:
    """Returns an iterator over messages as they come, which ends when none has come for `timeout_s`, None: never.

    It listens from the call on. `channels` names those to yield, without prefix; None yields all of leonav's. `url` and `prefix`
    are lcm.url and lcm.prefix of the configuration; only udpm is known. Messages that cannot be decoded are left out.
    LeonavError says what is in the way where the network cannot be joined.
    """
    match = re.fullmatch(r"udpm://([\d.]+):(\d+)(\?.*)?", url)
    if not match:
        raise LeonavError(f"{url}: must be like udpm://239.255.76.67:7667")
    group, port = match.group(1), int(match.group(2))
    wanted = None if channels is None else {channels} if isinstance(channels, str) else set(channels)
    return _receive(_join(url, group, port), wanted, prefix, timeout_s)


def _join(url, group, port):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        receiver.bind(("", port))
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + socket.inet_aton("0.0.0.0"))
    except (OSError, OverflowError) as error:
        receiver.close()
        raise LeonavError(f"{url}: {error}; LCM needs a multicast route; as root: {ROUTE}") from error
    return receiver


def _receive(receiver, wanted, prefix, timeout_s):
    with receiver:
        yield from _messages(receiver, wanted, prefix, timeout_s)


def _messages(receiver, wanted, prefix, timeout_s):
    assembler, last = Assembler(), time.monotonic()
    while True:
        left = None if timeout_s is None else last + timeout_s - time.monotonic()
        if left is not None and left <= 0:
            return
        receiver.settimeout(left)
        try:
            datagram, sender = receiver.recvfrom(65536)
        except socket.timeout:
            return
        whole = assembler.add(datagram, sender)
        if whole is None or not whole[0].startswith(prefix):
            continue
        channel = whole[0][len(prefix):]
        if wanted is not None and channel not in wanted:
            continue
        try:
            message = Message(channel, *decode(whole[1]))
        except LeonavError:
            continue
        last = time.monotonic()
        yield message
