"""Changes one constant of a copy of the tree, builds leonav-replay there, and compares its replays with unchanged ones.
For tools/validate constants, which makes the logs."""
import argparse
import csv
import hashlib
import math
import os
import re
import shutil
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
LIST = os.path.join(HERE, "constants.csv")
FAMILIES = ("city", "dense", "correlated", "recorded")
SYSTEMS = {"gps": "[gps]", "all": "[gps, galileo, beidou, leo]"}
# As in config/matrix/streets.yaml: the heading from the course alone, at the first chance.
STREETS = ("--preset", "urban", "--set", "alignment.max_gyrocompass_sigma_deg=0", "--set", "alignment.course_window_s=3",
           "--set", "alignment.max_course_sigma_deg=20", "--set", "vehicle.kind=car")
RECORDINGS = {"drive": ("--preset", "phone"), "walk": ("--preset", "walk"),
              "rover": ("--preset", "realtime", "--set", "ekf.motion=constant_velocity", "--set", "ekf.carrier=true",
                        "--set", "gnss.systems=[gps, galileo]")}
OFFSET_UNKNOWN = ("walk",)  # of the truth
SETTLE_S = 120.0
SOURCES = ("cmake/", "config/presets/", "core/", "daemon/", "drivers/", "lcmtypes/", "tools/common/", "tools/replay/")
# Members of a configuration are set where each replay makes its own: their headers would rebuild nearly everything.
MEMBERS_FILE = "daemon/config/load_config.cc"
MEMBERS_AFTER = "  navigator = default_navigator_config(navigator.vehicle.kind);\n"
# A constant is flat where neither value changes a case's horizontal or 3D RMSE, or its share within three sigma, by more.
FLAT_RMSE, FLAT_SHARE = 0.10, 0.01
RESULT = ("case", "seed", "estimator", "constant", "value", "digest", "epochs", "north", "east", "up", "within")


class Constant:
    def __init__(self, row):
        self.name, self.file, self.definition, self.unit = row["name"], row["file"], row["definition"], row["unit"]
        self.tried = (row["low"], row["high"])
        words = row["kind"].split()
        self.estimator = "smoother" if words[-1] == "smoother" else "ekf"
        self.kind = words[0]
        self.owner = words[2] if self.kind == "member" else None
        self.symbol, self.sign, self.value = re.fullmatch(r"(\w+)( = |: )(.*)", self.definition).groups()

    def found(self, text):
        """Where the definition stands in the text of its file."""
        return list(re.finditer(r"(?<!\w)" + re.escape(self.definition) + r"(?![\w.])", text))

    def patched(self, value):
        """(file, its text with another value)."""
        if self.kind == "member":
            text = read(MEMBERS_FILE)
            if text.count(MEMBERS_AFTER) != 1:
                sys.exit(f"constants: {MEMBERS_FILE} makes its configuration in another way than the script expects")
            return MEMBERS_FILE, text.replace(MEMBERS_AFTER, f"{MEMBERS_AFTER}  {self.owner}.{self.symbol} = {value};\n")
        text = read(self.file)
        place = self.found(text)[0]
        return self.file, text[:place.start()] + self.symbol + self.sign + value + text[place.end():]


def read(path):
    with open(os.path.join(ROOT, path)) as file:
        return file.read()


def constants_of(names):
    with open(LIST, newline="") as file:
        constants = [Constant(row) for row in csv.DictReader(file)]
    for constant in constants:
        places = len(constant.found(read(constant.file)))
        if places != 1:
            sys.exit(f"constants: {constant.name}: {constant.file} has {places} times \"{constant.definition}\"; "
                     "the list must follow the sources")
    chosen = [c for c in constants if not names or any(name in c.name for name in names)]
    if not chosen:
        sys.exit(f"constants: no constant of the list has {' or '.join(names)} in its name")
    return chosen


def say(text):
    print(text, file=sys.stderr, flush=True)


def tracked_files():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, capture_output=True).stdout.decode()
    return [name for name in sorted(listed.split("\0")) if name and os.path.isfile(os.path.join(ROOT, name))]


def digest_of_sources():
    """Of what decides about a replay. The program's own would change with the order in which it was linked."""
    digest = hashlib.sha256()
    for name in tracked_files():
        if name.startswith(SOURCES):
            digest.update(name.encode() + read(name).encode())
    return digest.hexdigest()[:12]


class Tree:
    """A copy of the repository with a build folder of its own. Only here sources are changed."""

    def __init__(self, out, jobs):
        self.path, self.jobs = os.path.join(out, "tree"), jobs
        self.build = os.path.join(self.path, "build", "release")

    def write(self, path, text):
        target = os.path.join(self.path, path)
        with open(target, "r+") as file:
            if file.read() == text:
                return
            file.seek(0)
            file.truncate()
            file.write(text)

    def follow_root(self):
        for name in tracked_files():
            source, target = os.path.join(ROOT, name), os.path.join(self.path, name)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            with open(source, "rb") as file:
                content = file.read()
            if os.path.exists(target):
                with open(target, "rb") as file:
                    if file.read() == content:
                        continue
            shutil.copyfile(source, target)
            shutil.copymode(source, target)

    def make(self, *targets):
        if not os.path.exists(os.path.join(self.build, "build.ninja")):
            say("configuring the copy")
            self.call(["cmake", "-S", self.path, "--preset", "release", "-B", self.build, "-DBUILD_TESTING=OFF"])
        self.call(["ninja", "-C", self.build, *(["-j", str(self.jobs)] if self.jobs else []), *targets])

    def call(self, words):
        log = os.path.join(os.path.dirname(self.path), "build.log")
        with open(log, "w") as file:
            if subprocess.run(words, cwd=self.path, stdout=file, stderr=subprocess.STDOUT, check=False).returncode:
                sys.exit(f"constants: {' '.join(words[:2])} failed; its words are in {log}")

    def program(self, name):
        return os.path.join(self.build, "bin", name)


class Case:
    """Logs that are judged together, and how they are replayed."""

    def __init__(self, name, options, runs, settle_s, offset_unknown):
        self.name, self.options, self.runs = name, options, runs  # runs: (seed, log, truth)
        self.settle_s, self.offset_unknown = settle_s, offset_unknown


def cases_of(logs, seeds, systems):
    cases = []
    for name in systems:
        for family in FAMILIES:
            runs = [(seed, *(os.path.join(logs, f"{family}{seed}{end}") for end in (".lcmlog", ".csv")))
                    for seed in range(1, seeds + 1)]
            runs = [run for run in runs if os.path.exists(run[1])]
            if runs:
                cases.append(Case(f"{family} {name}", (*STREETS, "--set", "gnss.systems=" + SYSTEMS[name]), runs, SETTLE_S, False))
    for name, options in RECORDINGS.items():
        run = (0, *(os.path.join(logs, name + end) for end in (".lcmlog", ".csv")))
        if os.path.exists(run[1]):
            cases.append(Case(name, options, [run], 0.0, name in OFFSET_UNKNOWN))
    return cases


class Results:
    """Sums of squares of all replays so far, in a file, so that a call that was ended goes on."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        if not os.path.exists(path):
            with open(path, "w", newline="") as file:
                csv.writer(file).writerow(RESULT)
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                self.rows[self.key(row)] = row

    @staticmethod
    def key(row):
        return tuple(str(row[name]) for name in RESULT[:5])

    def has(self, *key):
        return tuple(str(part) for part in key) in self.rows

    def of(self, *key):
        return self.rows.get(tuple(str(part) for part in key))

    def add(self, row):
        with open(self.path, "a", newline="") as file:
            csv.DictWriter(file, RESULT).writerow(row)
        self.rows[self.key(row)] = {name: str(value) for name, value in row.items()}


def judged(program, case, run, settings, folder):
    """(digest of the answers, epochs, sums of squares north, east, up, share within three sigma)."""
    sys.path.insert(0, os.path.join(ROOT, "tools", "fleet"))
    import numpy as np  # here, because --list goes without
    from fleet import measure
    seed, log, truth = run
    shutil.rmtree(folder, ignore_errors=True)
    with open(folder + ".log", "w") as file:
        done = subprocess.run([program, *case.options, *settings, log, "--out", folder], stdout=file, stderr=subprocess.STDOUT,
                              check=False)
    solution = os.path.join(folder, "solution.csv")
    if done.returncode or not os.path.exists(solution):
        return "failed", 0, math.nan, math.nan, math.nan, math.nan
    with open(solution, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()[:16]
    errors, sigmas = measure.errors_of(solution, truth, case.settle_s)
    if case.offset_unknown:
        errors = errors - errors.mean(axis=1, keepdims=True)
    known = np.isfinite(sigmas)
    within = float((np.abs(errors) <= 3.0 * sigmas)[known].mean()) if known.any() else math.nan
    shutil.rmtree(folder, ignore_errors=True)
    return digest, errors.shape[1], *(float(x) for x in (errors ** 2).sum(axis=1)), within


class Figures:
    """Of one case with one value: RMSE horizontal and 3D, share within three sigma, digests of the answers."""

    def __init__(self, rows):
        count = sum(int(row["epochs"]) for row in rows)
        north, east, up = (sum(float(row[axis]) for row in rows) for axis in ("north", "east", "up"))
        self.horizontal = math.sqrt((north + east) / count) if count else math.nan
        self.all = math.sqrt((north + east + up) / count) if count else math.nan
        self.within = sum(int(r["epochs"]) * float(r["within"]) for r in rows) / count if count else math.nan
        self.digests = [row["digest"] for row in rows]


class Study:
    def __init__(self, out, seeds, systems, jobs=None):
        self.tree = Tree(out, jobs)
        self.out = out
        self.cases = cases_of(os.path.join(out, "logs"), seeds, systems)
        if not self.cases:
            sys.exit("constants: there is no log to replay")

    def begin(self):
        """Builds what is unchanged; results of other sources are another file."""
        self.tree.follow_root()
        say("building leonav-replay, unchanged")
        self.tree.make("leonav-replay")
        digest = digest_of_sources()
        self.programs = os.path.join(self.out, "programs-" + digest)
        os.makedirs(self.programs, exist_ok=True)
        self.unchanged = os.path.join(self.programs, "unchanged")
        shutil.copy(self.tree.program("leonav-replay"), self.unchanged)
        self.results = Results(os.path.join(self.out, f"results-{digest}.csv"))

    def missing(self, estimator, name, value):
        return [(case, run) for case in self.cases for run in case.runs
                if not self.results.has(case.name, run[0], estimator, name, value)]

    def replay(self, estimator, name, value, program, settings, what):
        todo = self.missing(estimator, name, value)
        for count, (case, run) in enumerate(todo, 1):
            say(f"{what}: {case.name}, replay {count} of {len(todo)}")
            choice = ["--set", f"estimator={estimator}"]
            figures = judged(program, case, run, [*choice, *settings], os.path.join(self.out, "replay"))
            self.results.add(dict(zip(RESULT, (case.name, run[0], estimator, name, value, *figures))))

    def measure(self, constant, what):
        self.replay(constant.estimator, "", "", self.unchanged, [], "unchanged")
        for value in constant.tried:
            if not self.missing(constant.estimator, constant.name, value):
                continue
            label = f"{what}: {value} for {constant.value}"
            program, settings = self.unchanged, []
            if constant.kind == "key":
                settings = ["--set", f"{constant.name}={value}"]
            else:
                program = self.build(constant, value, label)
            self.replay(constant.estimator, constant.name, value, program, settings, label)

    def build(self, constant, value, label):
        program = os.path.join(self.programs, f"{constant.name}={re.sub(r'[^0-9.-]+', '_', value)}")
        if not os.path.exists(program):
            say(f"{label}: building")
            path, text = constant.patched(value)
            self.tree.write(path, text)
            try:
                self.tree.make("leonav-replay")
            finally:
                self.tree.write(path, read(path))
            shutil.copy(self.tree.program("leonav-replay"), program)
        return program

    def figures(self, case, estimator, name, value):
        return Figures([self.results.of(case.name, run[0], estimator, name, value) for run in case.runs])

    def row(self, constant):
        same, changes = True, []
        columns = {"horizontal": [], "3d": [], "largest": [], "within": []}
        for value in constant.tried:
            horizontal, whole, within = [], [], []
            for case in self.cases:
                before = self.figures(case, constant.estimator, "", "")
                after = self.figures(case, constant.estimator, constant.name, value)
                same = same and before.digests == after.digests
                horizontal.append(math.log(after.horizontal / before.horizontal))
                whole.append(math.log(after.all / before.all))
                within.append((after.within, before.within))
            of_cases = [(change, case.name + kind) for kind, logs in ((" horizontal", horizontal), (" 3D", whole))
                        for change, case in zip(logs, self.cases)]
            worst, where = max(of_cases, key=lambda c: abs(math.exp(c[0]) - 1.0) if math.isfinite(c[0]) else math.inf)
            columns["horizontal"].append(percent(statistics.fmean(horizontal)))
            columns["3d"].append(percent(statistics.fmean(whole)))
            columns["largest"].append(f"{percent(worst)} {where}" if worst else "0")
            columns["within"].append(f"{100.0 * statistics.fmean(a for a, _ in within):.1f}")
            changes.append((abs(math.exp(worst) - 1.0), max(abs(a - b) for a, b in within)))
        flat = all(rmse <= FLAT_RMSE and share <= FLAT_SHARE for rmse, share in changes)
        unchanged = statistics.fmean(self.figures(case, constant.estimator, "", "").within for case in self.cases)
        verdict = "no effect" if same else "flat" if flat else "not flat"
        unit = f" {constant.unit}" if constant.unit else ""
        return (f"| `{constant.name}` | {constant.value}{unit} | {' / '.join(constant.tried)} | {' / '.join(columns['horizontal'])} | "
                f"{' / '.join(columns['3d'])} | {' / '.join(columns['largest'])} | "
                f"{100.0 * unchanged:.1f}: {' / '.join(columns['within'])} | {verdict} |")

    def complete(self, constant):
        return not any(self.missing(constant.estimator, constant.name, value) for value in constant.tried) and not \
            self.missing(constant.estimator, "", "")


def percent(log_ratio):
    return f"{100.0 * (math.exp(log_ratio) - 1.0):+.1f}" if math.isfinite(log_ratio) else "failed"


HEAD = ("| constant | value | tried | horizontal RMSE, % | 3D RMSE, % | largest change of a case, % | within three sigma, % | |\n"
        "|---|---|---|---|---|---|---|---|")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--systems", choices=(*SYSTEMS, "both"), default="both")
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--make", action="append")
    parser.add_argument("--done", action="store_true")
    options = parser.parse_args()
    chosen = constants_of(options.only)
    if options.list:
        for constant in chosen:
            print(f"{constant.name:50} {constant.value} {constant.unit}".rstrip())
        return
    if options.make:
        tree = Tree(options.out, options.jobs)
        tree.follow_root()
        tree.make(*options.make)
        return
    systems = tuple(SYSTEMS) if options.systems == "both" else (options.systems,)
    study = Study(options.out, options.seeds, systems, options.jobs)
    study.begin()
    print(HEAD, flush=True)
    for count, constant in enumerate(chosen, 1):
        if not options.done:
            study.measure(constant, f"{count} of {len(chosen)}, {constant.name}")
        if study.complete(constant):
            print(study.row(constant), flush=True)


if __name__ == "__main__":
    main()
