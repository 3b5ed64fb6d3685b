"""Runs replayed on the cores of this machine."""

from collections.abc import Iterator, Sequence
from concurrent.futures import as_completed
from concurrent.futures.process import BrokenProcessPool

from terrain.batch.job import FAILED, Job, Outcome, run_job
from terrain.batch.processes import pool

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
                yield from _pooled([job], 1)
            except BrokenProcessPool:
                yield Outcome(job, FAILED, KILLED)


def _pooled(jobs: Sequence[Job], processes: int) -> Iterator[Outcome]:
    with pool(processes) as executor:
        for future in as_completed([executor.submit(run_job, job) for job in jobs]):
            yield future.result()
