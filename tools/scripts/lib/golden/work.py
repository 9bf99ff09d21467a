"""Makes inputs, runs cases and takes digests of everything they write."""
import contextlib
import fcntl
import gzip
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time

import lcm_log

from golden import inputs as recipes

TIME_LIMIT_S = 900
KEPT_BYTES = 24_000_000  # a larger text is not kept, only its digest
# The only texts in which two runs of one program may differ: the time leonav-sim took, and the clock time of leonavd's messages.
TIMES = [(re.compile(rb"(?m)^(\d+ s simulated in )[0-9.]+ s$"), rb"\1# s"),
         (re.compile(rb"(?m)^(leonavd )\d\d:\d\d:\d\d\.\d\d\d "), rb"\1# ")]


class Stopped(Exception):
    pass


def sha256_of(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def files_below(folder):
    """Paths relative to the folder, sorted."""
    return sorted(os.path.relpath(os.path.join(at, name), folder) for at, _, names in os.walk(folder) for name in names)


def end(process):
    """Kills a program and everything that it has started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


class Processes:
    """The programs that run at the moment, so that all can be ended."""

    def __init__(self):
        self.lock, self.running, self.stopped = threading.Lock(), set(), False

    def call(self, words, cwd, stdout, stderr, env=None):
        with self.lock:
            if self.stopped:
                raise Stopped()
            process = subprocess.Popen(words, cwd=cwd, stdin=subprocess.DEVNULL, stdout=stdout, stderr=stderr, env=env,
                                       start_new_session=True)
            self.running.add(process)
        try:
            code = process.wait(TIME_LIMIT_S)
        except subprocess.TimeoutExpired:
            end(process)
            code = f"ended after {TIME_LIMIT_S} s"
        except BaseException:
            end(process)
            raise
        finally:
            with self.lock:
                self.running.discard(process)
        if self.stopped:
            raise Stopped()
        return code

    def stop(self):
        with self.lock:
            self.stopped = True
            for process in self.running:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGTERM)


class Place:
    """A scratch folder with `in`, `data` and `dataset`: programs run in it, so that no other path enters their outputs."""

    def __init__(self, bin_folder, inputs_folder, data_folder):
        self.bin = os.path.abspath(bin_folder)
        self.inputs, self.data = os.path.abspath(inputs_folder), os.path.abspath(data_folder)
        self.scratch = tempfile.mkdtemp(prefix="leonav-golden-")
        self.processes = Processes()
        os.symlink(self.inputs, os.path.join(self.scratch, "in"))
        os.symlink(self.data, os.path.join(self.scratch, "data"))
        os.mkdir(os.path.join(self.scratch, "out"))
        os.mkdir(os.path.join(self.scratch, "dataset"))
        for name, text in recipes.DATASETS.items():
            with open(os.path.join(self.scratch, "dataset", name + ".yaml"), "w") as file:
                file.write(text)

    def remove(self):
        shutil.rmtree(self.scratch, ignore_errors=True)

    def program(self, name):
        return os.path.join(self.bin, name)

    def has_program(self, name):
        return os.access(self.program(name), os.X_OK)

    def has_data(self, name):
        return os.path.isdir(os.path.join(self.data, name))


class Maker:
    """The functions that the recipes of golden/inputs.py call."""

    def __init__(self, place, root, tell):
        self.place, self.root, self.scratch, self.tell = place, root, place.scratch, tell
        self.lib = os.path.join(root, "tools", "scripts", "lib")

    def path(self, name, file):
        return os.path.join(self.place.inputs, name, file)

    def call(self, words):
        """The program's standard output."""
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            code = self.place.processes.call([self.place.program(words[0]), *words[1:]], self.scratch, out, err)
            out.seek(0), err.seek(0)
            if code != 0:
                raise recipes.InputError(f"{' '.join(words)}: ended with {code}: {err.read().decode(errors='replace')[-600:]}")
            return out.read().decode(errors="replace")

    def live(self, config, log, journal, speed, options):
        """Plays a log to leonavd in a network namespace of its own."""
        script = f"source {self.lib}/setup.sh; in_namespace {self.lib}/live-run \"$@\""
        words = ["bash", "-c", script, "golden", self.place.bin, f"in/config/{config}.yaml", log, journal, str(speed), *options]
        with tempfile.TemporaryFile() as text:
            code = self.place.processes.call(words, self.scratch, text, subprocess.STDOUT)
            text.seek(0)
            words = text.read().decode(errors="replace")
        if code != 0:
            self.tell(f"    live run at speed {speed:g} failed: {words.strip().splitlines()[-1] if words.strip() else code}")

    def make(self, name, recipe):
        """Makes an input in another folder and renames it at the end, so that an interrupted call leaves nothing behind."""
        out = f"out/making-{name}"
        folder = os.path.join(self.scratch, out)
        os.makedirs(folder)
        recipe.make(self, out)
        if not files_below(folder):
            raise recipes.InputError(f"{name}: nothing was made")
        part = os.path.join(self.place.inputs, f".{name}.part")
        shutil.rmtree(part, ignore_errors=True)
        shutil.move(folder, part)
        os.rename(part, os.path.join(self.place.inputs, name))


class Inputs:
    """The folder of inputs and its list, inputs.json."""

    def __init__(self, place):
        self.place, self.list_path = place, os.path.join(place.inputs, "inputs.json")
        self.listed = {}
        if os.path.exists(self.list_path):
            with open(self.list_path) as file:
                self.listed = json.load(file)
        self.verified = {}

    def has(self, name):
        return name in self.listed and os.path.isdir(os.path.join(self.place.inputs, name))

    def fault(self):
        """Why nothing should be recorded or compared with these inputs; empty: they are good."""
        folder = os.path.join(self.place.inputs, "config")
        return recipes.fault_of_configs(folder) if self.has("config") else ""

    def why_not(self, name):
        """The reason why an input cannot be made here; empty: it exists or can be made."""
        if self.has(name):
            return ""
        recipe = recipes.INPUTS[name]
        for data in recipe.data:
            if not self.place.has_data(data):
                return f"{self.place.data}/{data} is not there (../shared/data or $LEONAV_DATA)"
        for program in recipe.programs:
            if not self.place.has_program(program):
                return f"{self.place.program(program)} is not built"
        if recipe.live and not shutil.which("lcm-logplayer"):
            return "lcm-logplayer is not installed (Debian package liblcm-bin)"
        return next((why for why in map(self.why_not, recipe.needs) if why), "")

    def wanted(self, names):
        """These inputs and those they are made from, as far as missing, in an order in which they can be made."""
        chosen = set()

        def choose(name):
            if name not in chosen and not self.has(name):
                chosen.add(name)
                for need in recipes.INPUTS[name].needs:
                    choose(need)
        for name in names:
            choose(name)
        return [name for name in recipes.INPUTS if name in chosen]

    def make(self, names, root, compiler, tell):
        """Makes the missing ones. Returns {name: why it failed}."""
        os.makedirs(self.place.inputs, exist_ok=True)
        failed = {}
        with open(os.path.join(self.place.inputs, ".lock"), "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)  # another call may be making the same
            self.__init__(self.place)
            missing = self.wanted(names)
            maker = Maker(self.place, root, tell)
            for number, name in enumerate(missing, 1):
                tell(f"input {number} of {len(missing)}: {name}")
                broken = next((need for need in recipes.INPUTS[name].needs if need in failed), None)
                try:
                    if broken:
                        raise recipes.InputError(f"{broken} could not be made")
                    maker.make(name, recipes.INPUTS[name])
                except (recipes.InputError, OSError, subprocess.SubprocessError, lcm_log.DamagedLog) as error:
                    failed[name] = str(error)
                    tell(f"    FAILED: {error}")
                    continue
                folder = os.path.join(self.place.inputs, name)
                self.listed[name] = {"made_by": compiler, "files": {f: sha256_of(os.path.join(folder, f)) for f in files_below(folder)}}
                with open(self.list_path + ".part", "w") as file:
                    json.dump(self.listed, file, indent=1, sort_keys=True)
                os.replace(self.list_path + ".part", self.list_path)
        return failed

    def digest(self, name):
        """One digest over all files of an input, as they are on the disk now."""
        if name not in self.verified:
            folder = os.path.join(self.place.inputs, name)
            digest = hashlib.sha256()
            for file in files_below(folder):
                digest.update(f"{file} {sha256_of(os.path.join(folder, file))}\n".encode())
            self.verified[name] = digest.hexdigest()
        return self.verified[name]


def channels_of(path):
    """{channel: number of messages and digest of them with their times} of an LCM log."""
    digests, counts = {}, {}
    try:
        for wall_s, channel, data in lcm_log.messages(path):
            digest = digests.setdefault(channel, hashlib.sha256())
            digest.update(f"{wall_s:.6f} {len(data)} ".encode() + data)
            counts[channel] = counts.get(channel, 0) + 1
    except lcm_log.DamagedLog:
        return {}
    return {channel: f"{counts[channel]} {digest.hexdigest()[:16]}" for channel, digest in sorted(digests.items())}


def settled(text):
    for pattern, replacement in TIMES:
        text = pattern.sub(replacement, text)
    return text


def run_case(case, place):
    """Runs the commands of a case. Returns the folder with their files, standard output, standard error and exit codes."""
    out = f"out/{case.name}"
    folder = os.path.join(place.scratch, out)
    os.makedirs(folder)
    for number, words in enumerate(case.commands, 1):
        words = [word.replace("{out}", out) for word in words]
        texts = [os.path.join(folder, f"{number}-{words[0]}.{kind}") for kind in ("stdout", "stderr", "exit")]
        with open(texts[0], "wb") as stdout, open(texts[1], "wb") as stderr:
            code = place.processes.call([place.program(words[0]), *words[1:]], place.scratch, stdout, stderr)
        with open(texts[2], "w") as file:
            file.write(f"{code}\n")
        for path in texts[:2]:
            with open(path, "rb") as file:
                text = file.read()
            with open(path, "wb") as file:
                file.write(settled(text))
    return folder


def digest_case(folder):
    """{file: its digest and size, for logs also its channels}"""
    result = {}
    for name in files_below(folder):
        path = os.path.join(folder, name)
        entry = {"sha256": sha256_of(path), "bytes": os.path.getsize(path)}
        if name.endswith(".lcmlog"):
            entry["channels"] = channels_of(path)
        result[name] = entry
    return result


def output_hash(folder):
    """The hash over all messages that leonav-replay prints; None: the case has none."""
    try:
        with open(os.path.join(folder, "summary.txt")) as file:
            found = re.search(r"^output hash: (\S+)$", file.read(), re.M)
            return found[1] if found else None
    except OSError:
        return None


def keep(folder, target):
    """Writes compressed copies of the texts, from which a comparison shows the first line that differs."""
    for name in files_below(folder):
        path = os.path.join(folder, name)
        if name.endswith(".lcmlog") or os.path.getsize(path) > KEPT_BYTES:
            continue
        copy = os.path.join(target, name + ".gz")
        os.makedirs(os.path.dirname(copy), exist_ok=True)
        with open(path, "rb") as source, open(copy, "wb") as raw, gzip.GzipFile("", "wb", 4, raw, 0) as packed:
            shutil.copyfileobj(source, packed)


class Timer:
    def __init__(self):
        self.begun = time.monotonic()

    def s(self):
        return time.monotonic() - self.begun
