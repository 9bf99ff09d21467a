#!/usr/bin/env python3
"""caster.py WORK_DIR: an NTRIP caster for tests, on ports that the kernel chooses; ends when standard input does.

Prints "NAME PORT" for each of them: plain, and tls with a certificate for "localhost" whose authority is WORK_DIR/ca.pem
(WORK_DIR/other.pem is another one). What a client gets is decided by the mountpoint:

  CHUNKS  version 2 in chunks    ICY    version 1      V1ONLY  version 1, and nothing for requests of version 2
  DROP    version 2, ends after each message           MUTE    no answer      ENDLESS  a header without end
  SILENT  version 2 without a byte of stream           POSITION  a message for each line with a position
Everything else is 404, or the source table for version 1. User and password are me and open:sesame. Each request is
printed as "asked MOUNTPOINT VERSION".
"""
import pathlib
import socket
import sys
import threading
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "support/python"))
from crc24q import crc24q  # noqa: E402
from ntrip_server import NOT_FOUND, STREAM_1, STREAM_2, authorization, chunk, mountpoint_of, read_request, tls_context  # noqa: E402

AUTHORIZATION = authorization("me", "open:sesame")


def message(number):
    """RTCM 3 with message 1029's number, and a counter in it."""
    payload = bytes([1029 >> 4, (1029 & 15) << 4]) + number.to_bytes(4, "big") + bytes(6)
    frame = bytes([0xD3, 0, len(payload)]) + payload
    return frame + crc24q(frame).to_bytes(3, "big")


def say(text):
    print(text, flush=True)


def serve(peer):
    lines = read_request(peer)
    if not lines:
        return
    mountpoint, is_2 = mountpoint_of(lines), "Ntrip-Version: Ntrip/2.0" in lines
    say(f"asked {mountpoint} {2 if is_2 else 1}")
    if mountpoint == "V1ONLY" and is_2:
        return
    if AUTHORIZATION not in lines:
        return peer.sendall(b"HTTP/1.1 401 Unauthorized\r\nWWW-Authenticate: Basic\r\nX: %s\r\n\r\n" % lines[-3].encode())
    if mountpoint in ("MUTE",):
        time.sleep(60)
    elif mountpoint == "ENDLESS":
        peer.sendall(b"HTTP/1.1 200 OK\r\n")
        while True:
            peer.sendall(b"X-Garbage: " + b"z" * 90 + b"\r\n")
    elif mountpoint in ("ICY", "V1ONLY"):
        peer.sendall(STREAM_1)
        for number in range(1000):
            peer.sendall(message(number))
            time.sleep(0.02)
    elif mountpoint in ("CHUNKS", "DROP", "SILENT", "POSITION"):
        peer.sendall(STREAM_2)
        if mountpoint == "SILENT":
            time.sleep(60)
        for number in range(1 if mountpoint == "DROP" else 1000):
            if mountpoint == "POSITION":
                say("position " + peer.recv(200).decode().strip())
            data = message(number)
            for part in (data[:5], data[5:]):
                peer.sendall(chunk(part))
            time.sleep(0.02)
    elif is_2:
        peer.sendall(NOT_FOUND)
    else:
        peer.sendall(b"SOURCETABLE 200 OK\r\nContent-Type: text/plain\r\n\r\nSTR;ICY;here;RTCM 3\r\nENDSOURCETABLE\r\n")


def client(peer, context):
    try:
        peer = context.wrap_socket(peer, server_side=True) if context else peer
        serve(peer)
    except OSError:
        pass  # the client has gone, or does not trust the certificate
    finally:
        peer.close()


def listen(name, context):
    server = socket.create_server(("127.0.0.1", 0))
    say(f"{name} {server.getsockname()[1]}")

    def accept():
        while True:
            threading.Thread(target=client, args=(server.accept()[0], context), daemon=True).start()
    threading.Thread(target=accept, daemon=True).start()


def main():
    context = tls_context(pathlib.Path(sys.argv[1]))
    listen("plain", None)
    listen("tls", context)
    sys.stdin.read()


if __name__ == "__main__":
    main()
