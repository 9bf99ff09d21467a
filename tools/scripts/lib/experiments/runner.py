"""Runs rows: one simulated log for each scene and seed, replayed and judged once for each row that uses it."""
import concurrent.futures
import hashlib
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time

import judge
import scenes


class RunError(Exception):
    pass


class Stopped(Exception):
    """A program was ended by the user, who will call again."""


def shell_line(words):
    return " ".join(shlex.quote(w) for w in words)


def with_settings(settings):
    return [w for s in settings for w in ("--set", s)]


class Runner:
    def __init__(self, root, bin_folder, out, jobs, keep_logs):
        self.root, self.bin, self.out, self.jobs, self.keep_logs = root, bin_folder, out, jobs, keep_logs
        self.lock, self.done, self.total, self.failures = threading.Lock(), 0, 0, []
        self.stopped = False
        self.begun = time.monotonic()
        self.fingerprint = self.digest_files([os.path.join(bin_folder, p) for p in
                                              ("leonav-sim", "leonav-replay", "leonav-eval")])

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
        os.makedirs(os.path.dirname(path), exist_ok=True)
        temporary = f"{path}.{threading.get_ident()}"
        with open(temporary, "w") as file:
            file.write(text)
        os.replace(temporary, path)
        return path

    def sim_commands(self, scene, seed, folder):
        program, log = os.path.join(self.bin, "leonav-sim"), os.path.join(folder, "run.lcmlog")
        settings = scene.settings(seed)
        if not scene.open_leo:
            return [[program, self.scene_file(scene, seed), *with_settings(settings), "-o", log]]
        drive = os.path.join(folder, "drive.lcmlog")
        leo = [*settings[:2], "receiver.lever_arm_b_m=[0, 0, -1.2]", "places=none"]
        return [[program, self.scene_file(scene, seed), *with_settings([*settings, "satellites.leo.enabled=false"]), "-o", drive],
                [program, os.path.join(self.root, "config/scenario/open_sky.yaml"), *with_settings(leo), "--overlay", drive,
                 "--truth", os.path.join(folder, "truth.csv"), "-o", log]]

    def replay_command(self, row, folder, out):
        return [os.path.join(self.bin, "leonav-replay"), "--preset", "urban", *with_settings(row.settings), os.path.join(folder, "run.lcmlog"), "--out", out]

    def eval_command(self, row, folder, out):
        judged_from = []
        if row.settle_epochs:
            judged_from = ["--from", f"{scenes.START_WEEK}:{scenes.START_TOW + row.settle_epochs + 0.5}"]
        return [os.path.join(self.bin, "leonav-eval"), "--truth", os.path.join(folder, "truth.csv"), *judged_from,
                "--convergence-bound", f"{row.bound_m:g}", "--json", os.path.join(out, "errors.json"),
                os.path.join(out, "solution.csv")]

    def alone(self, row, seed):
        folder = "alone"
        lines = [shell_line(["mkdir", "-p", folder])]
        for command in (*self.sim_commands(row.scene, seed, folder), self.replay_command(row, folder, folder),
                        self.eval_command(row, folder, folder)):
            lines.append(shell_line([os.path.relpath(w, self.root) if os.path.isabs(w) and w.startswith(self.root + "/")
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

    def call(self, command, folder):
        log = os.path.join(folder, os.path.basename(command[0]) + ".log")
        with open(log, "w") as file:
            code = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                  cwd=self.root).returncode
        if self.stopped or code in (-signal.SIGINT, -signal.SIGTERM):
            raise Stopped()
        if code != 0:
            with open(log, errors="replace") as file:
                words = [line for line in file.read().replace("\r", "\n").split("\n") if line.strip()]
            raise RunError(f"{shell_line(command)}: exit code {code}: {words[-1] if words else 'no words'}")

    def store(self, row, seed, result, folder=None):
        path = self.result_path(row, seed)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        if folder is not None:
            judge.save_series(os.path.join(folder, "series.npz"), path[:-5] + ".npz")
        result.update(definition=self.definition(row, seed), row=row.name, seed=seed)
        with open(path + ".part", "w") as file:
            json.dump(result, file, indent=1)
        os.replace(path + ".part", path)

    def tell(self, text):
        with self.lock:
            self.done += 1
            seconds = time.monotonic() - self.begun
            left = seconds / self.done * (self.total - self.done)
            print(f"[{self.done}/{self.total}, {left / 60.0:.0f} min left] {text}", file=sys.stderr, flush=True)

    def one_log(self, scene, seed, rows):
        if self.stopped:
            return
        folder = os.path.join(self.out, "work", f"{scene.name}-seed{seed}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        try:
            self.rows_of_log(scene, seed, rows, folder)
        except Stopped:
            self.stopped = True
        if not self.keep_logs:
            shutil.rmtree(folder, ignore_errors=True)

    def rows_of_log(self, scene, seed, rows, folder):
        try:
            for command in self.sim_commands(scene, seed, folder):
                self.call(command, folder)
        except RunError as error:
            with self.lock:
                self.failures.append(str(error))
                self.done += len(rows) - 1
            for row in rows:
                self.store(row, seed, {"failure": f"not simulated: {error}"})
            self.tell(f"{scene.name}, seed {seed}: NOT SIMULATED")
            return
        for row in rows:
            out = os.path.join(folder, row.name)
            os.makedirs(out)
            try:
                self.call(self.replay_command(row, folder, out), out)
                self.call(self.eval_command(row, folder, out), out)
                result = judge.judge(row, folder, out)
                self.store(row, seed, result, out)
                self.tell(f"{row.name}, seed {seed}: " + judge.one_line(result))
            except (RunError, judge.JudgeError) as error:
                with self.lock:
                    self.failures.append(str(error))
                self.store(row, seed, {"failure": str(error)})
                self.tell(f"{row.name}, seed {seed}: FAILED")
            if not self.keep_logs:
                shutil.rmtree(out, ignore_errors=True)

    def run(self, rows, seeds_of):
        """Everything that is not there yet. Returns {row name: {seed: result}}."""
        tasks = {}
        for row in rows:
            for seed in seeds_of(row):
                # What failed is tried again: perhaps the disk was full.
                if "failure" in (self.finished(row, seed) or {"failure": "not run"}):
                    tasks.setdefault((row.scene.name, seed), (row.scene, seed, []))[2].append(row)
        self.total = sum(len(rows_) for _, _, rows_ in tasks.values())
        everything = sum(len(seeds_of(row)) for row in rows)
        print(f"{self.total} runs to do, {everything - self.total} already there", file=sys.stderr)
        with concurrent.futures.ThreadPoolExecutor(max_workers=self.jobs) as pool:
            try:
                for future in [pool.submit(self.one_log, *task) for task in tasks.values()]:
                    future.result()
            except BaseException:
                self.stopped = True  # what has begun ends, the rest does not begin
                raise
        if self.stopped:
            raise KeyboardInterrupt
        return {row.name: {seed: self.finished(row, seed) for seed in seeds_of(row)} for row in rows}
