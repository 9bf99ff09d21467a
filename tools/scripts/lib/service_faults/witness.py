"""Shows that datagrams have arrived, by a socket beside leonavd's."""
import socket
import threading

from service_faults.datagrams import GROUP

BUFFER_BYTES = 4 << 20


class Witness:
    """Counts what a plain socket of the group gets: that a fault has left its sender, and has come so far as leonavd's own socket.

    `kind_of` gives a datagram's kind, None where it does not count. Where this machine is too slow some are not seen.
    """

    def __init__(self, kind_of):
        self.kind_of, self.counts, self.is_over = kind_of, {}, False
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        self.socket.bind(GROUP)
        self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(GROUP[0]) + socket.inet_aton("0.0.0.0"))
        self.socket.settimeout(0.1)
        self.thread = threading.Thread(target=self.count, daemon=True)
        self.thread.start()

    def count(self):
        while True:
            try:
                kind = self.kind_of(self.socket.recv(1 << 16))
            except TimeoutError:
                if self.is_over:
                    return
                continue
            if kind:
                self.counts[kind] = self.counts.get(kind, 0) + 1

    def stop(self):
        """Returns the counts by kind, when nothing comes any more."""
        self.is_over = True
        self.thread.join()
        self.socket.close()
        return self.counts
