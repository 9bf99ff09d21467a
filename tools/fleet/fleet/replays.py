"""The work of a worker: one log through leonav-replay and leonav-eval, its numbers into a file."""
import dataclasses
import hashlib
import json
import os
import shutil
import tempfile

from . import measure, programs

NO_LEVEL = "states no protection level"  # leonav-eval's words
FORMAT = 2  # of the results' files: one more where their content changes


@dataclasses.dataclass(frozen=True)
class Estimator:
    """How the logs are replayed."""
    preset: str | None = None
    config: str | None = None
    settings: tuple = ()

    def words(self):
        choice = ["--preset", self.preset] if self.preset else ["--config", self.config] if self.config else []
        return choice + programs.with_settings(self.settings)

    def text(self):
        """The words, with the file's content for its name."""
        content = programs.file_digest(self.config) if self.config else None
        return json.dumps([self.preset, content, list(self.settings)])


@dataclasses.dataclass(frozen=True)
class Bench:
    """What all runs of a call have in common."""
    bin: str
    out: str
    work: str  # folder for what is deleted in the end
    programs_digest: str
    integrity: bool = False  # leonav-eval has the option
    settle_s: float = 0.0  # epochs before it are not judged
    remove_offset: bool = False  # the truths' datum is unknown
    keep: bool = False
    resume: bool = False
    caller: programs.Caller = None

    def judged_by(self):
        """What decides about numbers, and is the same for all runs."""
        return [FORMAT, self.programs_digest, self.integrity, self.settle_s, self.remove_offset]

    def result_path(self, name):
        return os.path.join(self.out, "runs", name + ".json")

    def tables_folder(self, name):
        return os.path.join(self.out, "runs", name)

    def work_folder(self):
        """A new one for every attempt: two workers may have the same run in hand, one of them given up for lost."""
        return tempfile.mkdtemp(prefix="run-", dir=self.work)


def digest_of_programs(folder, names):
    """Of the programs and of this package, which computes some of the numbers."""
    here = os.path.dirname(os.path.abspath(__file__))
    paths = [os.path.join(folder, name) for name in names] + [os.path.join(here, name) for name in ("measure.py", "replays.py")]
    return hashlib.sha256("".join(programs.file_digest(path) for path in paths).encode()).hexdigest()


def definition(bench, estimator, log, truth):
    """Digest of all that decides about a run's numbers."""
    parts = [*bench.judged_by(), estimator.text(), programs.file_digest(log), programs.file_digest(truth) if truth else None]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def earlier(bench, name, digest):
    """The result of an earlier run of the very same programs, configuration and log; None: there is none, or it failed."""
    try:
        with open(bench.result_path(name)) as file:
            result = json.load(file)
    except (OSError, ValueError):
        return None
    good = isinstance(result, dict) and result.get("definition") == digest and result.get("failure") is None
    return result if good else None


def replay(bench, estimator, name, log, truth):
    """The result of one run; a failure is a result too. It is in its file before it is returned."""
    try:
        digest = definition(bench, estimator, log, truth)
    except OSError as error:
        return store(bench, name, {"failure": f"{error.filename}: {error.strerror}"}, None)
    done = earlier(bench, name, digest) if bench.resume else None
    return done or run(bench, estimator, name, log, truth, digest)


def run(bench, estimator, name, log, truth, digest):
    folder = bench.work_folder()
    try:
        try:
            result = {"failure": None, **measured(bench, estimator, folder, log, truth)}
        except (programs.ProgramError, measure.MeasureError) as error:
            result = {"failure": str(error).replace(folder, "OUT")}
        except OSError as error:
            result = {"failure": f"{str(error.filename).replace(folder, 'OUT')}: {error.strerror}"}
        result = store(bench, name, result, digest)
        if bench.keep:
            keep_tables(folder, bench.tables_folder(name))
        return result
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def keep_tables(folder, target):
    shutil.rmtree(target, ignore_errors=True)
    os.makedirs(os.path.dirname(target), exist_ok=True)
    try:
        os.replace(folder, target)
    except OSError:
        pass  # another attempt at the same run was first


def store(bench, name, result, digest):
    result = {"name": name, **result, "definition": digest}
    programs.write_atomically(bench.result_path(name), json.dumps(result, indent=1, sort_keys=True) + "\n")
    return result


def measured(bench, estimator, folder, log, truth):
    bench.caller.call([os.path.join(bench.bin, "leonav-replay"), *estimator.words(), log, "--out", folder], folder)
    with open(os.path.join(folder, "summary.txt"), errors="replace") as file:
        result = measure.counted(file.read())
    if truth is None:
        return {**result, "judged": False}
    words = ["--remove-offset"] if bench.remove_offset else []
    if bench.settle_s:
        week, tow = measure.start_of(truth)
        words += ["--from", f"{week}:{tow + bench.settle_s:.3f}"]
    solution, numbers = os.path.join(folder, "solution.csv"), os.path.join(folder, "errors.json")
    evaluate = [os.path.join(bench.bin, "leonav-eval"), "--truth", truth, *words, solution, "--json"]
    bench.caller.call([*evaluate, numbers], folder)
    result |= {"judged": True, **measure.evaluated(numbers)}
    if bench.integrity and result["integrity"] is None:
        result["integrity"] = integrity(bench, evaluate, folder, result["warnings"])
    result["integrity_model"] = measure.integrity_model_of(os.path.join(folder, "configuration.yaml")) if result["integrity"] else None
    errors, stated = measure.errors_of(solution, truth, bench.settle_s)
    if errors.shape[1] != result["epochs"]:
        result["warnings"].append(f"leonav-eval compares {result['epochs']} epochs, the sigmas are of {errors.shape[1]}")
    if bench.remove_offset and errors.shape[1]:
        errors = errors - errors.mean(axis=1, keepdims=True)
    return {**result, "sigmas": measure.sigmas(errors, stated)}


def integrity(bench, evaluate, folder, warnings):
    """The counts of leonav-eval --integrity; None: it made none, most often because the solution states no levels."""
    path = os.path.join(folder, "integrity.json")
    try:
        bench.caller.call([*evaluate, path, "--integrity"], folder)
        return measure.integrity_of(path)
    except (programs.ProgramError, measure.MeasureError) as error:
        if NO_LEVEL not in str(error):
            warnings.append(f"no integrity: {error}")
        return None
