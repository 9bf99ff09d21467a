"""Runs one of leonav's programs from a worker process, so that it ends when the worker or the whole call ends."""
import hashlib
import os
import select
import shlex
import shutil
import signal
import subprocess

POLL_S = 0.5


class ProgramError(Exception):
    """A program failed; the text says which, and its last words."""


class Stopped(Exception):
    """The call, or a program of it, was ended by the user, who will call again."""


def shell_line(words):
    return " ".join(shlex.quote(w) for w in words)


def with_settings(settings):
    return [w for s in settings for w in ("--set", s)]


def last_words(path):
    with open(path, errors="replace") as file:
        lines = [line for line in file.read().replace("\r", "\n").split("\n") if line.strip()]
    return lines[-1].strip() if lines else "no words"


def file_digest(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


class Caller:
    """Runs programs for as long as the file `running` exists: who deletes it ends them, on every machine that sees it."""

    def __init__(self, running):
        self.running = running

    def stopped(self):
        return not os.path.exists(self.running)

    def call(self, command, folder, shown="OUT"):
        """Returns what the program printed; its words are in folder/PROGRAM.log. An error's text has `shown` for `folder`."""
        log = os.path.join(folder, os.path.basename(command[0]) + ".log")
        # A terminal's Ctrl-C is for the caller alone, and the kernel ends a program whose worker has died.
        guarded = ["setpriv", "--pdeathsig", "KILL", "--", *command] if shutil.which("setpriv") else command
        with open(log, "w") as file:
            process = subprocess.Popen(guarded, stdin=subprocess.DEVNULL, stdout=file, stderr=subprocess.STDOUT, start_new_session=True)
        code = self.wait(process)
        if self.stopped() or code in (-signal.SIGINT, -signal.SIGTERM):
            raise Stopped()
        if code != 0:
            text = f"{shell_line(command)}: " + (f"ended by signal {-code}" if code < 0 else f"exit code {code}: {last_words(log)}")
            raise ProgramError(text.replace(folder, shown))
        with open(log, errors="replace") as file:
            return file.read()

    def wait(self, process):
        handle = os.pidfd_open(process.pid)
        try:
            ended = select.poll()
            ended.register(handle, select.POLLIN)
            while not ended.poll(POLL_S * 1000):
                if self.stopped():
                    process.kill()
                    break
        finally:
            os.close(handle)
        return process.wait()


def write_atomically(path, text):
    """Whole or not at all, whoever dies meanwhile and however many write it at a time."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    temporary = f"{path}.{os.uname().nodename}.{os.getpid()}.part"
    with open(temporary, "w") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)
