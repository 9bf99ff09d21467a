"""Sends LCM messages over UDP multicast.

Format, big endian (LCM documentation, "UDP Multicast Protocol"): a message that fits into one datagram has the magic word
"LC02", a number, the channel with a zero byte, the data. A longer one comes in fragments: the magic word "LC03", a number, the
size of the data, the offset of the fragment, its index, how many there are; the first then has the channel with a zero byte.
"""
import socket
import struct

GROUP = ("239.255.76.67", 7667)
URL = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"
SHORT, FRAGMENT = struct.Struct(">4sI"), struct.Struct(">4sIIIHH")
MOST_BYTES = 65000  # of one datagram's data


def begun(number, channel, size):
    """The first datagram of a message that claims to have so many bytes and never goes on."""
    return FRAGMENT.pack(b"LC03", number, size, 0, 0, 5000) + channel.encode() + b"\0" + bytes(20)


def gone_on(number, size):
    """A later datagram of a message whose first one has never come."""
    return FRAGMENT.pack(b"LC03", number, size, 0, 1, 5000) + bytes(20)


def datagrams(number, channel, data):
    """The datagrams of a message."""
    name = channel.encode() + b"\0"
    if len(name) + len(data) <= MOST_BYTES:
        return [SHORT.pack(b"LC02", number) + name + data]
    first = MOST_BYTES - len(name)
    pieces = [data[:first], *(data[at:at + MOST_BYTES] for at in range(first, len(data), MOST_BYTES))]
    out, offset = [], 0
    for index, piece in enumerate(pieces):
        out.append(FRAGMENT.pack(b"LC03", number, len(data), offset, index, len(pieces)) + (name if index == 0 else b"") + piece)
        offset += len(piece)
    return out


class Sender:
    """Sends on this host. What the network refuses is counted: without a route nothing can leave."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.number = self.refused = 0

    def send(self, channel, data):
        for datagram in datagrams(self.number, channel, data):
            self.send_bytes(datagram)
        self.number = (self.number + 1) & 0xFFFFFFFF

    def begin(self, channel, size):
        self.send_bytes(begun(self.number, channel, size))
        self.number = (self.number + 1) & 0xFFFFFFFF

    def go_on(self, size):
        self.send_bytes(gone_on(self.number, size))
        self.number = (self.number + 1) & 0xFFFFFFFF

    def send_bytes(self, datagram):
        try:
            self.socket.sendto(datagram, GROUP)
        except OSError:
            self.refused += 1
