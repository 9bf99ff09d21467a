"""Runs rows: one simulated log for each scene and seed, replayed and judged once for each row that uses it."""
import contextlib
import hashlib
import json
import os
import shutil
import sys
import tempfile

from fleet import engine, programs, progress

import judge
import scenes

HERE = os.path.dirname(os.path.abspath(__file__))


class RunError(Exception):
    pass


class Site:
    """Where programs, files and results are, and the commands of each run. Workers get a copy of it."""

    def __init__(self, root, bin_folder, out, keep_logs):
        self.root, self.bin, self.out, self.keep_logs = root, bin_folder, out, keep_logs
        self.work = self.caller = None  # while an engine runs
        self.fingerprint = self.digest_files([os.path.join(bin_folder, p) for p in
                                              ("leonav-sim", "leonav-replay", "leonav-smooth", "leonav-eval")])

    @staticmethod
    def digest_files(paths):
        digest = hashlib.sha256()
        for path in paths:
            try:
                with open(path, "rb") as file:
                    digest.update(file.read())
            except OSError as error:
                raise RunError(f"{path}: {error.strerror}; build it, or name its folder with --bin")
        return digest.hexdigest()

    # Commands, in the words with which they can be given alone.
    def scene_file(self, scene, seed):
        shells = scene.leo_shells(seed)
        if shells is None:
            return os.path.join(self.root, scene.file)
        path = os.path.join(self.out, "scenarios", f"{scene.name}-seed{seed}.yaml")
        text = f"# leonav-sim: an open sky; all else is its defaults or said with --set.\nsatellites:\n  leo:\n    shells: {shells}\n"
        programs.write_atomically(path, text)
        return path

    def sim_commands(self, scene, seed, folder):
        program, log = os.path.join(self.bin, "leonav-sim"), os.path.join(folder, "run.lcmlog")
        settings = scene.settings(seed)
        if not scene.open_leo:
            return [[program, self.scene_file(scene, seed), *programs.with_settings(settings), "-o", log]]
        drive = os.path.join(folder, "drive.lcmlog")
        leo = [*settings[:2], "receiver.lever_arm_b_m=[0, 0, -1.2]", "places=none"]
        return [[program, self.scene_file(scene, seed), *programs.with_settings([*settings, "satellites.leo.enabled=false"]), "-o", drive],
                [program, os.path.join(self.root, "config/scenario/open_sky.yaml"), *programs.with_settings(leo), "--overlay", drive,
                 "--truth", os.path.join(folder, "truth.csv"), "-o", log]]

    def replay_command(self, row, folder, out):
        # The chain: Ceres needs gigabytes for logs as long as these.
        solver = ["--solver", "chain"] if row.is_whole_log() else []
        return [os.path.join(self.bin, row.program), "--preset", "urban", *programs.with_settings(row.settings), *solver,
                os.path.join(folder, "run.lcmlog"), "--out", out]

    def eval_command(self, row, folder, out):
        judged_from = []
        if row.settle_epochs:
            judged_from = ["--from", f"{scenes.START_WEEK}:{scenes.START_TOW + row.settle_epochs + 0.5}"]
        return [os.path.join(self.bin, "leonav-eval"), "--truth", os.path.join(folder, "truth.csv"), *judged_from,
                "--convergence-bound", f"{row.bound_m:g}", "--json", os.path.join(out, "errors.json"),
                os.path.join(out, "solution.csv")]

    def alone(self, row, seed):
        folder = "alone"
        lines = [programs.shell_line(["mkdir", "-p", folder])]
        for command in (*self.sim_commands(row.scene, seed, folder), self.replay_command(row, folder, folder),
                        self.eval_command(row, folder, folder)):
            lines.append(programs.shell_line([os.path.relpath(w, self.root) if os.path.isabs(w) and w.startswith(self.root + "/")
                                              else w for w in command]))
        return lines

    def result_path(self, row, seed):
        return os.path.join(self.out, "runs", row.name, f"seed{seed}.json")

    def definition(self, row, seed):
        files = [self.scene_file(row.scene, seed)]  # presets are in the programs
        if row.scene.open_leo:
            files.append(os.path.join(self.root, "config/scenario/open_sky.yaml"))
        return "\n".join(self.alone(row, seed) + [self.fingerprint, self.digest_files(files)])

    def finished(self, row, seed):
        """The result of an earlier run of the very same commands, programs and files; None: there is none."""
        try:
            with open(self.result_path(row, seed)) as file:
                result = json.load(file)
        except (OSError, ValueError):
            return None
        ours = isinstance(result, dict) and result.get("definition") == self.definition(row, seed)
        return result if ours else None

    def log_folder(self, scene, seed):
        return os.path.join(self.out, "work", f"{scene.name}-seed{seed}")

    @contextlib.contextmanager
    def own_folder(self, target, keep):
        """A new one for every attempt of every worker; it becomes `target` in the end, if that is not there and `keep`."""
        folder = tempfile.mkdtemp(prefix="run-", dir=self.work)
        try:
            yield folder
            if keep and not os.path.isdir(target):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                try:
                    os.rename(folder, target)
                except OSError:
                    if not os.path.isdir(target):  # by another worker meanwhile
                        raise
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def store(self, row, seed, result, folder=None):
        path = self.result_path(row, seed)
        if folder is not None:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            judge.save_series(os.path.join(folder, "series.npz"), path[:-5] + ".npz")
        result.update(definition=self.definition(row, seed), row=row.name, seed=seed)
        programs.write_atomically(path, json.dumps(result, indent=1))
        return result


# The work of a worker.
def simulate(site, scene, seed):
    """Returns why the log is not there; None: it is."""
    target = site.log_folder(scene, seed)
    if os.path.isdir(target):
        return None  # by a worker that was lost afterwards
    try:
        with site.own_folder(target, keep=True) as folder:
            for command in site.sim_commands(scene, seed, folder):
                site.caller.call(command, folder, shown=target)
    except programs.ProgramError as error:
        return str(error)
    return None


def run_row(not_simulated, site, row, seed):
    """The result of one row of a log that is there; it is in its file before it is returned."""
    if not_simulated is not None:
        return site.store(row, seed, {"failure": f"not simulated: {not_simulated}"})
    log = site.log_folder(row.scene, seed)
    target = os.path.join(log, row.name)
    with site.own_folder(target, site.keep_logs) as out:
        try:
            site.caller.call(site.replay_command(row, log, out), out, shown=target)
            site.caller.call(site.eval_command(row, log, out), out, shown=target)
            return site.store(row, seed, judge.judge(row, log, out), out)
        except (programs.ProgramError, judge.JudgeError) as error:
            return site.store(row, seed, {"failure": str(error).replace(out, target)})


def groups_of(site, rows, seeds_of):
    """One for each log, of the rows that are not there yet."""
    jobs = {}
    for row in rows:
        for seed in seeds_of(row):
            # What failed is tried again: perhaps the disk was full.
            if "failure" in (site.finished(row, seed) or {"failure": "not run"}):
                jobs.setdefault((row.scene.name, seed), (row.scene, []))[1].append((row, engine.Job(f"{row.name}, seed {seed}", run_row, site, row, seed)))
    groups = []
    for (_, seed), (scene, rows_and_jobs) in jobs.items():
        folder = site.log_folder(scene, seed)
        shutil.rmtree(folder, ignore_errors=True)  # of an earlier call
        finish = None if site.keep_logs else lambda folder=folder: shutil.rmtree(folder, ignore_errors=True)
        for row, job in rows_and_jobs:
            job.row, job.seed = row, seed
        groups.append(engine.Group(scene.name, [job for _, job in rows_and_jobs], (simulate, site, scene, seed), finish))
    return groups


def run(site, rows, seeds_of, jobs, scheduler=None):
    """Everything that is not there yet. Returns {row name: {seed: result}} and what failed, in words."""
    failures = []
    with engine.Engine(site.out, jobs, scheduler, folders=[HERE]) as workers:
        site.work, site.caller = workers.work, workers.caller
        groups = groups_of(site, rows, seeds_of)
        total = sum(len(group.jobs) for group in groups)
        everything = sum(len(seeds_of(row)) for row in rows)
        print(f"{total} runs to do, {everything - total} already there", file=sys.stderr)
        shown = progress.Progress(total)
        for _, job, result in workers.run(groups):
            if isinstance(result, engine.Failed):
                result = site.store(job.row, job.seed, {"failure": result.text})
            failed = "failure" in result
            if failed and result["failure"] not in failures:
                failures.append(result["failure"])
            shown.tell(f"{job.name}: " + ("FAILED" if failed else judge.one_line(result)), failed)
        shown.end()
    return {row.name: {seed: site.finished(row, seed) for seed in seeds_of(row)} for row in rows}, failures
