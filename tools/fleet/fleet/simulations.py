"""The work of a worker for a matrix: a scene is simulated, and each estimator replays it."""
import hashlib
import json
import os
import shutil

from . import matrix, programs, replays


def simulate(bench, scene, seed, per_seed, target):
    """Makes the folder `target` with the log and its truth, whole or not at all. Returns a failure's text; None: it is there."""
    if os.path.isdir(target):
        return None  # by a worker that was lost afterwards
    folder = bench.work_folder()
    try:
        command = [os.path.join(bench.bin, "leonav-sim"), scene.scenario, *programs.with_settings(scene.settings_of(seed, per_seed)), "-o",
                   os.path.join(folder, "run.lcmlog")]
        bench.caller.call(command, folder)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.rename(folder, target)
    except programs.ProgramError as error:
        return f"not simulated: {error}"
    except OSError as error:
        if not os.path.isdir(target):
            return f"not simulated: {str(error.filename).replace(folder, 'OUT')}: {error.strerror}"
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return None


def definition(bench, estimator, scene, seed, per_seed):
    """Digest of all that decides about the numbers of a simulated run."""
    files = [programs.file_digest(path) for path in matrix.files_of(scene.scenario)]
    parts = [*bench.judged_by(), estimator.text(), files, scene.settings_of(seed, per_seed)]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def replay(not_simulated, bench, estimator, name, folder, digest):
    """The result of one run of a simulated log; a failure is a result too."""
    if not_simulated is not None:
        return replays.store(bench, name, {"failure": not_simulated}, digest)
    return replays.run(bench, estimator, name, os.path.join(folder, "run.lcmlog"), os.path.join(folder, "truth.csv"), digest)
