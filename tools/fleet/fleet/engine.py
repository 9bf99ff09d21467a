"""Spreads work over the workers of a Dask cluster: one that it starts on this machine, or one that is there.

Work comes in groups. A group may begin with a preparation (a log that is simulated) whose result each of its jobs is
given; it is finished off when its last job has ended. Only so many groups are begun that every worker is busy, so that
what preparations leave on the disk stays small. What a lost worker had in hand is done again by another.
"""
import itertools
import math
import os
import shutil
import sys
import tempfile
import time
import uuid

from . import programs

LOST_SO_OFTEN = 4  # then the work is taken for what ends the workers
LOCAL, CONNECT = "127.0.0.1", "20s"


class EngineError(Exception):
    """There are no workers; the text says why."""


class Failed:
    """In the place of a result: the work never came to an end of its own."""

    def __init__(self, text):
        self.text = text


class Job:
    def __init__(self, name, function, *arguments):
        self.name, self.function, self.arguments = name, function, arguments


class Group:
    """`prepare` and the jobs are picklable functions; `finish` runs here."""

    def __init__(self, name, jobs, prepare=None, finish=None):
        self.name, self.jobs, self.prepare, self.finish = name, jobs, prepare, finish


def packages():
    """Dask, which takes a second or two to import: not for a line of help."""
    try:
        import dask
        import distributed
    except ImportError as missing:
        raise EngineError(f"{missing}; install python3-distributed and python3-cryptography") from None
    return dask, distributed


def equip(distributed, folders, ours):
    """What each worker is told when it starts, also one that comes later."""

    class Equipment(distributed.WorkerPlugin):  # local, so that it travels by value
        def setup(self, worker):
            import signal
            import sys as there
            there.path[:0] = [folder for folder in folders if folder not in there.path]
            if not ours:
                return
            worker.http_server.stop()
            try:
                # Ctrl-C: who started the worker ends it. Not ignored, or its programs would ignore it too.
                signal.signal(signal.SIGINT, lambda *_: None)
            except ValueError:
                pass  # not in its main thread

    return Equipment()


class Engine:
    """Use it in a `with` statement; it makes `work` in the folder `shared`, which all workers see, and removes it again."""

    def __init__(self, shared, workers=None, scheduler=None, dashboard=None, folders=()):
        self.scheduler, self.dashboard = scheduler, dashboard
        self.workers = workers or len(os.sched_getaffinity(0))
        self.folders = [os.path.dirname(os.path.dirname(os.path.abspath(__file__))), *folders]
        self.cluster = self.client = self.scratch = None
        self.counted, self.counted_s = 1, -math.inf
        self.work = os.path.join(os.path.abspath(shared), "work", uuid.uuid4().hex)
        self.running = os.path.join(self.work, "running")
        self.caller = programs.Caller(self.running)

    def __enter__(self):
        os.makedirs(self.work)
        with open(self.running, "w") as file:
            file.write("Deleting this file ends the runs.\n")
        try:
            self.connect()
        except BaseException:
            self.__exit__(*sys.exc_info())
            raise
        return self

    def connect(self):
        dask, distributed = packages()
        dask.config.set({"distributed.scheduler.allowed-failures": LOST_SO_OFTEN - 1, "distributed.worker.profile.enabled": False,
                         "distributed.admin.log-format": "%(message)s"})
        if self.scheduler is None:
            self.scratch = tempfile.TemporaryDirectory(prefix="leonav-fleet-", ignore_cleanup_errors=True)
            port = 0 if self.dashboard is None else self.dashboard
            # Certificates of its own: who may use 127.0.0.1 may not thereby use the workers.
            self.cluster = distributed.LocalCluster(
                n_workers=self.workers, threads_per_worker=1, processes=True, host=LOCAL, security=True, memory_limit=0,
                dashboard_address=f"{LOCAL}:{port}", worker_dashboard_address=f"{LOCAL}:0", local_directory=self.scratch.name,
                silence_logs="CRITICAL")
            if self.dashboard is None:
                self.cluster.scheduler.http_server.stop()
        try:
            self.client = distributed.Client(self.cluster or self.scheduler, timeout=CONNECT)
        except (OSError, ValueError) as error:
            raise EngineError(f"{self.scheduler or 'the workers'}: {error}") from None
        self.client.register_worker_plugin(equip(distributed, self.folders, self.cluster is not None), name="leonav-fleet")

    def __exit__(self, kind, error, trace):
        if os.path.exists(self.running):
            os.remove(self.running)  # programs that still run end
        for thing in (self.client, self.cluster):
            if thing is not None:
                try:
                    thing.close()
                except Exception as trouble:  # it is going away in any case
                    print(f"leonav-fleet: while closing: {trouble}", file=sys.stderr)
        if self.scratch is not None:
            self.scratch.cleanup()
        shutil.rmtree(self.work, ignore_errors=True)
        try:
            os.rmdir(os.path.dirname(self.work))
        except OSError:
            pass  # another call works there too

    def worker_count(self):
        """As of a second ago at most: to ask takes longer than a short run."""
        now = time.monotonic()
        if now > self.counted_s + 1.0:
            self.counted, self.counted_s = max(1, len(self.client.scheduler_info()["workers"])), now
        return self.counted

    def run(self, groups):
        """Yields (group, job, result or Failed) as jobs end."""
        _, distributed = packages()
        waiting, open_jobs, owners, kept = iter(groups), {}, {}, {}
        ended = distributed.as_completed(with_results=False, raise_errors=False)
        order = itertools.count()

        def begin(group):
            first = -next(order)  # groups in their order, whatever becomes ready
            open_jobs[group] = len(group.jobs)
            prepared = []
            if group.prepare is not None:
                function, *arguments = group.prepare
                prepared = [self.client.submit(function, *arguments, pure=False, priority=first)]
            kept[group] = prepared
            for job in group.jobs:
                future = self.client.submit(job.function, *prepared, *job.arguments, pure=False, priority=first)
                owners[future] = group, job
                ended.add(future)

        def begin_some():
            # So many that no worker waits, and of those with a preparation one more than there are workers.
            workers = self.worker_count()
            while sum(map(bool, kept.values())) <= workers and (sum(open_jobs.values()) < 4 * workers or len(open_jobs) <= workers):
                group = next(waiting, None)
                if group is None:
                    return
                if group.jobs:
                    begin(group)

        begin_some()
        while owners:
            future = next(ended)
            group, job = owners.pop(future)
            yield group, job, self.result_of(future)
            future.release()
            open_jobs[group] -= 1
            if open_jobs[group] == 0:
                del open_jobs[group], kept[group]
                if group.finish is not None:
                    group.finish()
            begin_some()

    @staticmethod
    def result_of(future):
        _, distributed = packages()
        try:
            return future.result()
        except distributed.scheduler.KilledWorker:
            return Failed(f"the worker was lost {LOST_SO_OFTEN} times with this run")
        except programs.Stopped:
            raise KeyboardInterrupt from None
        except Exception as error:
            return Failed(f"{type(error).__name__}: {error}")
