"""Jobs on the cores of this machine."""

import os
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool

from joblib import Parallel, delayed, parallel_config

from terrain.batch.job import FAILED, Job, Outcome, run_job

LOOKS_EVERY_S = 0.2
KILLED = "the process that replayed it was killed; was there too little memory?"


def local_outcomes(jobs: Sequence[Job], processes: int) -> Iterator[Outcome]:
    """Do the jobs, so many at a time; outcomes come as they are there.

    With one process they are done in this one. Where one of several processes is killed, the jobs
    that have no outcome yet are done one after another, so that the one to blame is known.
    """
    if processes == 1:
        yield from map(run_job, jobs)
        return
    waiting = {job.name: job for job in jobs}
    try:
        for outcome in _pooled(jobs, processes):
            del waiting[outcome.job.name]
            yield outcome
    except BrokenProcessPool:
        for job in waiting.values():
            try:
                yield from _pooled([job], processes)
            except BrokenProcessPool:
                yield Outcome(job, FAILED, KILLED)


def _pooled(jobs: Sequence[Job], processes: int) -> Iterator[Outcome]:
    with parallel_config(backend="loky", n_jobs=processes, inner_max_num_threads=1):
        pool = Parallel(return_as="generator_unordered", batch_size=1)
    yield from pool(delayed(_in_pool)(job, os.getpid()) for job in jobs)


def _in_pool(job: Job, parent: int) -> Outcome:
    _end_with(parent)
    return run_job(job)


def _end_with(parent: int) -> None:
    """Let this process end soon after its parent, which alone hears of Ctrl-C."""
    if any(thread.name == _end_with.__name__ for thread in threading.enumerate()):
        return
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_watch, args=(parent,), name=_end_with.__name__, daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(LOOKS_EVERY_S)
    os._exit(1)
