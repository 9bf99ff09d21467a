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
import base64
import pathlib
import socket
import ssl
import subprocess
import sys
import threading
import time

AUTHORIZATION = "Authorization: Basic " + base64.b64encode(b"me:open:sesame").decode()


def crc24q(data):
    crc = 0
    for byte in data:
        crc ^= byte << 16
        for _ in range(8):
            crc = crc << 1 ^ (0x1864CFB if crc & 0x800000 else 0)
    return crc & 0xFFFFFF


def message(number):
    """RTCM 3 with message 1029's number, and a counter in it."""
    payload = bytes([1029 >> 4, (1029 & 15) << 4]) + number.to_bytes(4, "big") + bytes(6)
    frame = bytes([0xD3, 0, len(payload)]) + payload
    return frame + crc24q(frame).to_bytes(3, "big")


def openssl(*arguments):
    subprocess.run(["openssl", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def make_certificates(work):
    key = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
    for name in ("ca", "other"):
        openssl("req", "-x509", *key, "-keyout", work / f"{name}.key", "-out", work / f"{name}.pem", "-days", 2, "-subj", f"/CN={name}")
    openssl("req", *key, "-keyout", work / "caster.key", "-out", work / "caster.csr", "-subj", "/CN=localhost")
    (work / "names").write_text("subjectAltName=DNS:localhost\n")
    openssl("x509", "-req", "-in", work / "caster.csr", "-CA", work / "ca.pem", "-CAkey", work / "ca.key", "-CAcreateserial",
            "-days", 2, "-extfile", work / "names", "-out", work / "caster.pem")


def say(text):
    print(text, flush=True)


def serve(peer):
    request = b""
    while b"\r\n\r\n" not in request:
        piece = peer.recv(4096)
        if not piece:
            return
        request += piece
    lines = request.decode("latin-1").split("\r\n")
    mountpoint, is_2 = lines[0].split()[1].lstrip("/"), "Ntrip-Version: Ntrip/2.0" in lines
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
        peer.sendall(b"ICY 200 OK\r\n\r\n")
        for number in range(1000):
            peer.sendall(message(number))
            time.sleep(0.02)
    elif mountpoint in ("CHUNKS", "DROP", "SILENT", "POSITION"):
        peer.sendall(b"HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nContent-Type: gnss/data\r\nTransfer-Encoding: chunked\r\n\r\n")
        if mountpoint == "SILENT":
            time.sleep(60)
        for number in range(1 if mountpoint == "DROP" else 1000):
            if mountpoint == "POSITION":
                say("position " + peer.recv(200).decode().strip())
            data = message(number)
            for part in (data[:5], data[5:]):
                peer.sendall(b"%x\r\n%s\r\n" % (len(part), part))
            time.sleep(0.02)
    elif is_2:
        peer.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n")
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
    work = pathlib.Path(sys.argv[1])
    work.mkdir(parents=True, exist_ok=True)
    make_certificates(work)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(work / "caster.pem", work / "caster.key")
    listen("plain", None)
    listen("tls", context)
    sys.stdin.read()


if __name__ == "__main__":
    main()
