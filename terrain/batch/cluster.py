"""Runs replayed by the workers of a Dask cluster."""

from collections.abc import Iterator, Sequence

from odometry.outputs.leftovers import remove_foreign_stages
from terrain.batch.connection import ONE_AT_A_TIME, answers, connected, failure
from terrain.batch.job import FAILED, Job, Outcome, run_job
from terrain.batch.workers import require_files


def cluster_outcomes(jobs: Sequence[Job], address: str) -> Iterator[Outcome]:
    """Do the jobs on the workers of a scheduler; outcomes come as they are there.

    A job whose worker is lost is done by another one; one that loses several (by default 4, the
    scheduler's `allowed-failures` and one more) is taken for their end, and fails.

    Parameters
    ----------
    jobs : sequence of Job
        Their folders and files lie where all workers see them.
    address : str
        Of the scheduler, such as tcp://host:8786.

    Raises
    ------
    ExtraError
        If Dask is not installed.
    BatchError
        If the scheduler cannot be reached, has no workers, or workers of other versions, or some
        that do not see the files.
    """
    with connected(address) as client:
        require_files(client, jobs)
        for job, future in answers(client, address, on_worker, jobs, ahead=len(jobs)):
            if future.status == "finished":
                yield future.result()
            else:
                yield Outcome(job, FAILED, failure(future))


def on_worker(job: Job) -> Outcome:
    """Do a job; what a lost worker left of it goes first, wherever that worker was."""
    with ONE_AT_A_TIME:
        remove_foreign_stages(job.out)
        return run_job(job)
