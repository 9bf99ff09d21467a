"""An NTRIP caster with TLS that sends a drive's corrections, asks for a password, and breaks off."""
import pathlib
import socket
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.append(str(ROOT / "test/support/python"))
from ntrip_server import NOT_FOUND, STREAM_2, authorization, chunk, mountpoint_of, read_request, tls_context  # noqa: E402

MOUNTPOINT, USER, PASSWORD = "SSR", "me", "open:sesame"
LATENCY_S = 3.4  # from a correction's time to its sending; never close to an epoch of whole seconds


class CorrectionCaster:
    """`drops`: [(s from the drive's start, s without service)]. A connection ends there in the middle of a message."""

    def __init__(self, folder, drops):
        self.context = tls_context(folder)
        self.drops, self.messages, self.pace = drops, [], None
        self.refused = self.served = self.broken = 0
        self.server = socket.create_server(("127.0.0.1", 0))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self.accept, daemon=True).start()

    def play(self, messages, pace):
        self.messages, self.pace = messages, pace

    def accept(self):
        while True:
            peer, _ = self.server.accept()
            threading.Thread(target=self.client, args=(peer,), daemon=True).start()

    def client(self, peer):
        try:
            with self.context.wrap_socket(peer, server_side=True) as encrypted:
                self.answer(encrypted)
        except OSError:
            pass  # the client has gone

    def answer(self, peer):
        lines = read_request(peer)
        if not lines:
            return
        if authorization(USER, PASSWORD) not in lines:
            self.refused += 1
            peer.sendall(b"HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic\r\nContent-Length: 0\r\n\r\n")
        elif mountpoint_of(lines) != MOUNTPOINT:
            peer.sendall(NOT_FOUND)
        elif not self.is_down():
            self.served += 1
            peer.sendall(STREAM_2)
            self.stream(peer)

    def since_start(self):
        return time.monotonic() - self.pace.begin if self.pace else 0.0

    def is_down(self):
        return any(at <= self.since_start() < at + down for at, down in self.drops)

    def stream(self, peer):
        """Every message whose time of sending is still to come. It breaks off at the next drop."""
        while self.pace is None:
            time.sleep(0.05)
        drop = next((at for at, _ in self.drops if at > self.since_start()), None)
        for gps_ns, data in self.messages:
            at = (gps_ns - self.pace.first_ns) * 1e-9 + LATENCY_S
            if at < self.since_start():
                continue
            self.pace.wait_until(gps_ns, LATENCY_S)
            breaks = drop is not None and at >= drop
            part = data[:len(data) // 2] if breaks else data
            peer.sendall(chunk(part))
            if breaks:
                self.broken += 1
                return
        time.sleep(60)
