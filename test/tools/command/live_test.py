#!/usr/bin/env python3
"""live_test.py BIN_DIR WORK_DIR: commands to leonavd with a key, without one, and with wrong ones.

leonav-command sends, and a sender of this script: it signs by Python's hmac and types that lcm-gen writes for Python, not by
leonav's code. What leonavd took must stand in its journal as COMMAND, and the journal must replay without the key. Runs in a
network namespace of its own; exit 77: none can be made here.
"""
import atexit
import hashlib
import hmac
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path.append(str(HERE.parent))
from generated_types import generated_types  # noqa: E402
from live_program import enter_namespace, fail  # noqa: E402

GROUP = ("239.255.76.67", 7667)
KEY, OTHER_KEY = "0123456789abcdef0123456789abcdef", "a-key-that-leonavd-does-not-have!"
PATIENCE_S = 60  # for what hangs: the machine may be busy
FAULTS_OF_TEST = 7  # messages that leonavd refuses, below


class Channels:
    """The short datagrams of LCM's udpm, both ways: magic word, number, channel, message."""

    def __init__(self):
        self.out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        self.listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        self.listener.bind(GROUP)
        self.listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                                 socket.inet_aton(GROUP[0]) + socket.inet_aton("127.0.0.1"))

    def send(self, channel, data):
        self.out.sendto(struct.pack(">II", 0x4C433032, 1) + b"LEONAV_" + channel.encode() + b"\0" + data, GROUP)

    def drop(self):
        """Forgets what came so far."""
        self.listener.settimeout(0.0)
        try:
            while True:
                self.listener.recv(65536)
        except BlockingIOError:
            pass

    def wait(self, channel, is_it=lambda data: True, seconds=PATIENCE_S):
        """The next message of the channel that is the one; None: it does not come."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.listener.settimeout(left)
            try:
                datagram = self.listener.recv(65536)
            except socket.timeout:
                break
            name, _, data = datagram[8:].partition(b"\0")
            if datagram[:4] == b"LC02" and name == b"LEONAV_" + channel.encode() and is_it(data):
                return data
        return None


class Daemon:
    def __init__(self, folder, name, *options):
        self.journal, self.text = folder / f"{name}.lcmlog", folder / f"{name}.txt"
        with open(self.text, "w") as text:
            self.process = subprocess.Popen([BIN / "leonavd", "--preset", "phone_imu", "--journal", self.journal, "--set",
                                             "realtime.lock_memory=false", *options], stderr=text)
        atexit.register(self.process.kill)
        end = time.monotonic() + PATIENCE_S
        while "running; LCM" not in self.text.read_text():
            if self.process.poll() is not None or time.monotonic() > end:
                fail(f"leonavd does not run: {self.text.read_text()}")
            time.sleep(0.05)

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        if self.process.wait(PATIENCE_S) != 0:
            fail(f"leonavd ended with {self.process.returncode}: {self.text.read_text()}")


def check(condition, text):
    if not condition:
        fail(text)


def command(*arguments):
    run = subprocess.run([BIN / "leonav-command", *arguments], capture_output=True, text=True, timeout=2 * PATIENCE_S, check=False)
    return run.returncode, run.stdout + run.stderr


def told(run, code, words):
    check(run[0] == code and words in run[1], f"leonav-command: expected {code} and '{words}', not {run}")


def restart(types, sequence):
    message = types.command_t()
    message.sequence, message.schema, message.kind = sequence, 1, types.command_t.KIND_RESTART
    return message.encode()


def signed(types, nonce, inner, key=KEY):
    message = types.signed_command_t()
    message.schema, message.nonce, message.command = 1, nonce, inner
    message.mac = hmac.new(key.encode(), b"leonav command 1" + nonce + inner, hashlib.sha256).digest()
    return message.encode()


def with_key(types, channels, work, key_file, other_file):
    options = ("--set", f"commands.key_file={key_file}")

    def is_event(kind, value=None):
        def judge(data):
            event = types.event_t.decode(data)
            return event.kind == kind and (value is None or event.value == value)
        return judge

    def is_done(sequence):
        return channels.wait("EVENT", is_event(types.event_t.KIND_COMMAND, sequence)) is not None

    def nonce():
        channels.drop()
        return bytes(types.command_nonce_t.decode(channels.wait("COMMAND_NONCE")).nonce)

    daemon = Daemon(work, "with_key", *options)
    told(command("restart", "--key-file", key_file, "--timeout", "30"), 0, "done")
    told(command("heading", "--degrees", "87", "--key-file", key_file, "--timeout", "30"), 0, "done")
    told(command("restart", "--key-file", other_file, "--timeout", "3"), 1, "no answer")
    told(command("restart", "--timeout", "3"), 1, "takes signed commands only")

    used = signed(types, nonce(), restart(types, 1001))
    channels.send("SIGNED_COMMAND", used)
    check(is_done(1001), "a command that Python signed is not answered")
    channels.send("SIGNED_COMMAND", used)                                                 # replayed
    channels.send("SIGNED_COMMAND", signed(types, nonce(), restart(types, 1002), OTHER_KEY))
    channels.send("SIGNED_COMMAND", bytes(200))                                           # junk
    channels.send("COMMAND", restart(types, 1003))                                        # plain
    channels.send("SIGNED_COMMAND", restart(types, 1004))                                 # plain, on the other channel
    channels.send("SIGNED_COMMAND", signed(types, nonce(), restart(types, 1005)))
    check(is_done(1005), "after wrong commands a right one is not answered")

    def counts(data):
        return {one.name: one.value for one in types.health_t.decode(data).counts}

    channels.drop()
    health = channels.wait("HEALTH", lambda data: counts(data).get("refused COMMAND", 0) >= FAULTS_OF_TEST)
    check(health is not None, "HEALTH does not count the refused commands")
    found = counts(health)
    check(found["refused COMMAND"] == FAULTS_OF_TEST and found["rejected unauthenticated"] == FAULTS_OF_TEST - 2 and
          found["rejected undecodable"] == 2 and found["received COMMAND"] == FAULTS_OF_TEST + 4, f"HEALTH counts {found}")
    daemon.stop()

    journal = daemon.journal.read_bytes()
    check(journal.count(b"LEONAV_COMMAND") == 4,
          "the journal has not the four commands that were taken")
    check(b"_NONCE" not in journal and KEY.encode() not in journal, "the journal has a nonce or the key")
    key_file.rename(work / "away")
    replay = subprocess.run([BIN / "leonav-replay", "--verify", "--out", work / "replay", daemon.journal],
                            capture_output=True, text=True, timeout=5 * PATIENCE_S, check=False)
    # It ends with 1, because there was no position.
    check(" outputs, 0 differences" in replay.stdout and "events command: 4\n" in replay.stdout,
          f"the journal does not replay: {replay.stdout}{replay.stderr}")
    (work / "away").rename(key_file)

    # The next run of leonavd takes nothing that was signed for the one before.
    daemon = Daemon(work, "after_restart", *options)
    nonce()
    channels.send("SIGNED_COMMAND", used)
    rejected = channels.wait("EVENT", is_event(types.event_t.KIND_REJECTED_INPUT))
    check(rejected is not None and types.event_t.decode(rejected).code == types.event_t.FAULT_UNAUTHENTICATED,
          "a command of the run before is not refused")
    another_key(daemon, key_file, other_file)
    daemon.stop()


def another_key(daemon, key_file, other_file):
    """SIGHUP reads the file of the key again; while it is wrong the key before goes on."""
    def reloads(words):
        daemon.process.send_signal(signal.SIGHUP)
        end = time.monotonic() + PATIENCE_S
        while words not in daemon.text.read_text():
            check(time.monotonic() < end, f"leonavd does not say '{words}': {daemon.text.read_text()}")
            time.sleep(0.05)

    before = key_file.read_text()
    old_file = key_file.with_name("old_key")
    shutil.copy(key_file, old_file)
    key_file.write_text(other_file.read_text())
    reloads(f"{key_file}: the key for commands is read again")
    told(command("restart", "--key-file", other_file, "--timeout", "30"), 0, "done")
    told(command("restart", "--key-file", old_file, "--timeout", "3"), 1, "no answer")
    key_file.write_text("short\n")
    reloads("the key that was read before is still in effect")
    told(command("restart", "--key-file", other_file, "--timeout", "30"), 0, "done")
    key_file.write_text(before)


def without_key(work, key_file):
    daemon = Daemon(work, "without_key")
    told(command("restart", "--timeout", "30"), 0, "done")
    told(command("restart", "--key-file", key_file, "--timeout", "3"), 1, "no leonavd that wants signed commands")
    daemon.stop()


def refused_files(key_file):
    key_file.chmod(0o640)
    told(command("restart", "--key-file", key_file), 1, "chmod 600")
    for words in (("--preset", "phone_imu"), ("--check", "--preset", "phone_imu")):
        run = subprocess.run([BIN / "leonavd", *words, "--set", f"commands.key_file={key_file}"],
                             capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        check(run.returncode == 3 and "--set commands.key_file" in run.stderr and "chmod 600" in run.stderr and KEY not in run.stderr,
              f"a key that others may read is not refused: {run}")
    key_file.chmod(0o600)


def main():
    enter_namespace()
    work = pathlib.Path(sys.argv[2])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    types = generated_types(ROOT, work)
    key_file, other_file = work / "key", work / "other_key"
    for file, key in ((key_file, KEY), (other_file, OTHER_KEY)):
        file.write_text(key + "\n")
        file.chmod(0o600)
    refused_files(key_file)
    with_key(types, Channels(), work, key_file, other_file)
    without_key(work, key_file)
    print("commands with a key and without: all as they should be")


BIN = pathlib.Path(os.path.abspath(sys.argv[1]))
main()
