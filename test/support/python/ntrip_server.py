"""What NTRIP casters of tests have in common: requests, answers, TLS."""
import base64
import ssl
import subprocess

STREAM_1 = b"ICY 200 OK\r\n\r\n"
STREAM_2 = b"HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nContent-Type: gnss/data\r\nTransfer-Encoding: chunked\r\n\r\n"
NOT_FOUND = b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n"


def authorization(user, password):
    """The line of a request that lets this user in."""
    return "Authorization: Basic " + base64.b64encode(f"{user}:{password}".encode()).decode()


def read_request(peer):
    """The lines of a request; none where the client goes before its end."""
    request = b""
    while b"\r\n\r\n" not in request:
        piece = peer.recv(4096)
        if not piece:
            return []
        request += piece
    return request.decode("latin-1").split("\r\n")


def mountpoint_of(lines):
    return lines[0].split()[1].lstrip("/")


def chunk(data):
    """A part of a stream of version 2."""
    return b"%x\r\n%s\r\n" % (len(data), data)


def _openssl(*arguments):
    subprocess.run(["openssl", *map(str, arguments)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def tls_context(work):
    """A context with a new certificate for "localhost", whose authority is work/ca.pem; work/other.pem is another one."""
    work.mkdir(parents=True, exist_ok=True)
    key = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
    for name in ("ca", "other"):
        _openssl("req", "-x509", *key, "-keyout", work / f"{name}.key", "-out", work / f"{name}.pem", "-days", 2, "-subj", f"/CN={name}")
    _openssl("req", *key, "-keyout", work / "caster.key", "-out", work / "caster.csr", "-subj", "/CN=localhost")
    (work / "names").write_text("subjectAltName=DNS:localhost\n")
    _openssl("x509", "-req", "-in", work / "caster.csr", "-CA", work / "ca.pem", "-CAkey", work / "ca.key", "-CAcreateserial",
             "-days", 2, "-extfile", work / "names", "-out", work / "caster.pem")
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(work / "caster.pem", work / "caster.key")
    return context
