#!/usr/bin/env python3
"""name_server_test.py BIN_DIR WORK_DIR: a name server that takes questions and never answers.

A stream that waits for it must hold up no other one, whatever its place in the list, and neither the end of the program;
and it is told what is wrong. Runs in namespaces of network and mounts of its own; exit 77: none can be made here.
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from live_program import enter_namespace, fail  # noqa: E402

UBX = bytes.fromhex("b562010700000819")


def enter_mounts():
    """Starts this script again with mounts of its own, so that /etc/resolv.conf can be another file."""
    if os.environ.get("LEONAV_IN_MOUNTS") != "yes":
        if subprocess.run(["unshare", "-m", "true"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
            print("SKIPPED: no namespace of mounts can be made here")
            sys.exit(77)
        os.environ["LEONAV_IN_MOUNTS"] = "yes"
        os.execvp("unshare", ["unshare", "-m", sys.executable, *sys.argv])


def serve(server, accepted):
    """A receiver that breaks its connection off after a second, again and again."""
    while True:
        client, _ = server.accept()
        accepted.append(time.monotonic())
        try:
            client.sendall(UBX)
            time.sleep(1)
            client.close()
        except OSError:
            pass


def main():
    enter_mounts()
    enter_namespace()
    programs, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    work.mkdir(parents=True, exist_ok=True)
    (work / "resolv.conf").write_text("nameserver 127.0.0.1\n")
    if subprocess.run(["mount", "--bind", work / "resolv.conf", "/etc/resolv.conf"], check=False).returncode != 0:
        print("SKIPPED: /etc/resolv.conf cannot be another file here")
        sys.exit(77)
    mute = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    mute.bind(("127.0.0.1", 53))
    server = socket.create_server(("127.0.0.1", 0))
    accepted = []
    threading.Thread(target=serve, args=(server, accepted), daemon=True).start()
    (work / "streams.yaml").write_text(f"""streams:
  - {{name: service, source: ntrip, host: caster.example, mountpoint: X, format: rtcm3, corrections: true}}
  - {{name: other, source: tcp, host: sensor.example, port: 9, format: imu_line, rate_hz: 100, line: {{columns: [gyro_x, gyro_y, gyro_z, accel_x, accel_y, accel_z]}}}}
  - {{name: receiver, source: tcp, host: 127.0.0.1, port: {server.getsockname()[1]}, format: ubx}}
""")
    text = work / "said.txt"
    started = time.monotonic()
    with open(text, "wb") as said:
        program = subprocess.Popen([programs / "leonav-connect", work / "streams.yaml"], stderr=said)
    deadline = started + 40
    while text.read_text(encoding="utf-8").count("name server does not answer") < 2 and time.monotonic() < deadline:
        time.sleep(0.2)
    asked = time.monotonic()
    program.send_signal(signal.SIGTERM)
    code = program.wait(timeout=20)
    ended = time.monotonic() - asked
    print(text.read_text(encoding="utf-8"))
    if text.read_text(encoding="utf-8").count("name server does not answer") < 2:
        fail("it is not told that the name server does not answer")
    if len(accepted) < 3 or accepted[0] - started > 3:
        fail(f"the receiver was connected to {[round(at - started, 1) for at in accepted]} s after the start")
    if code != 0 or ended > 3:
        fail(f"the end came {ended:.1f} s after SIGTERM, with {code}")
    print(f"connected after {accepted[0] - started:.1f} s and {len(accepted)} times; ended after {ended:.1f} s")


if __name__ == "__main__":
    main()
