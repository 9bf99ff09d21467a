"""The self-test of tools/golden: one small case that is recorded, compared, and compared with something changed."""
import contextlib
import io
import json
import os
import re
import subprocess
import tempfile

from golden import cases, inputs
from golden.cases import Case

LOG = inputs.Simulation("urban", "duration_s=60", "route.standing_s=5", "satellites.beidou.enabled=false", "satellites.leo.enabled=false")
WORDS = ["leonav-replay", "--config", "in/config/urban.yaml", "--set", "vehicle.kind=car", "in/tiny/run.lcmlog", "--out", "{out}"]
CHECK = ["leonavd", "--check", "--preset", "urban"]
PROGRAMS = ("leonavd", "leonav-sim", "leonav-replay")


class Failed(Exception):
    pass


class Bench:
    """A folder for records and inputs. `golden(words)` is the program's main()."""

    def __init__(self, golden, bin_folder, folder):
        self.golden, self.bin, self.folder = golden, os.path.abspath(bin_folder), folder

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def call(self, what, *words, bin_folder=None):
        """Exit code and everything that is printed."""
        text = io.StringIO()
        record = {"record": "--out", "compare": "--against"}[what]
        with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
            code = self.golden([what, "--bin", bin_folder or self.bin, "--inputs", self.path("inputs"), record, self.path("record.json"),
                                *words])
        return code, text.getvalue()

    def expect(self, holds, result, code, *texts):
        found, printed = result
        missing = [text for text in texts if text not in printed]
        if found != code or missing:
            raise Failed(f"not true: {holds}\nexit code {found} instead of {code}; missing: {missing}; printed:\n{printed}")
        print(f"self-test: {holds}", flush=True)

    def changed_programs(self, setting):
        """A folder of programs of which leonav-replay has another setting."""
        folder = self.path("changed")
        os.makedirs(folder)
        for name in PROGRAMS:
            if name != "leonav-replay":
                os.symlink(os.path.join(self.bin, name), os.path.join(folder, name))
        script = os.path.join(folder, "leonav-replay")
        with open(script, "w") as file:
            file.write(f"#!/bin/sh\nexec '{self.bin}/leonav-replay' \"$@\" --set '{setting}'\n")
        os.chmod(script, 0o755)
        return folder


def check_that_a_car_is_driven(bench):
    """vehicle.kind=car must act on the recorded configuration: the program says so, and the case has constraints."""
    config = bench.path("inputs", "config", "urban.yaml")
    text = subprocess.run([os.path.join(bench.bin, "leonavd"), "--check", config, "--set", "vehicle.kind=car"], check=True,
                          capture_output=True, text=True).stdout
    if not re.search(r"(?m)^  non_holonomic: (true|by_kind +# true,)", text):
        raise Failed(f"vehicle.kind=car does not constrain the motion with {config}:\n{text}")
    with open(bench.path("record.json")) as file:
        if "constraints.csv" not in json.load(file)["cases"]["tiny"]["files"]:
            raise Failed("the case of a car wrote no constraints.csv")
    print("self-test: a case of a car has the constraints of a car", flush=True)


def steps(bench):
    bench.expect("a case is recorded", bench.call("record"), 0, "tiny", "1 cases of ", "0 skipped")
    check_that_a_car_is_driven(bench)
    bench.expect("the same programs are equal", bench.call("compare"), 0, "equal   tiny", "1 of 1 cases equal")
    changed = bench.changed_programs("robust.k1=3")
    bench.expect("a program that answers otherwise differs, with hash, file and line", bench.call("compare", bin_folder=changed), 1,
                 "DIFFERS tiny", "output hash: ", "solution.csv", "was: ", "now: ", "DIFFERENT: tiny")
    cases.CASES[:] = [Case("tiny", [CHECK, WORDS + ["--set", "robust.k1=3"]], ["tiny", "config"])]
    bench.expect("a case with another command differs", bench.call("compare"), 2, "DIFFERS tiny: its commands are others")
    cases.CASES[:] = [Case("tiny", [CHECK, WORDS], ["tiny", "config"]), Case("other", [CHECK, WORDS], ["tiny", "config"])]
    bench.expect("a case that was not recorded is skipped", bench.call("compare"), 0, "it is not in the record", "1 of 1 cases equal")
    bench.expect("--strict does not pass over it", bench.call("compare", "--strict"), 1, "1 skipped")
    config = bench.path("inputs", "config", "urban.yaml")
    with open(config, "a") as file:
        file.write("# changed\n")
    bench.expect("an input that has changed is refused", bench.call("compare"), 2, "is not what tiny was recorded with")
    with open(config, "a") as file:
        file.write("vehicle:\n  non_holonomic: false\n")
    bench.expect("configurations in which no car can be driven are refused", bench.call("record"), 2, "fixes non_holonomic: false")


def run(golden, bin_folder):
    if missing := [name for name in PROGRAMS if not os.access(os.path.join(bin_folder, name), os.X_OK)]:
        print(f"self-test: not built in {bin_folder}: {', '.join(missing)}")
        return 1
    inputs.INPUTS["tiny"] = inputs.command_input(LOG.words, LOG.needs())
    cases.CASES[:] = [Case("tiny", [CHECK, WORDS], ["tiny", "config"])]
    with tempfile.TemporaryDirectory(prefix="leonav-golden-self-test-") as folder:
        try:
            steps(Bench(golden, bin_folder, folder))
        except Failed as error:
            print(f"self-test: {error}")
            return 1
    print("self-test: passed")
    return 0
