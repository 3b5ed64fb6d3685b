"""Jobs on the workers of a Dask cluster."""

import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from odometry.extras import extra_module
from odometry.outputs.leftovers import remove_foreign_stages
from terrain.batch.job import FAILED, Job, Outcome, run_job
from terrain.batch.workers import require_workers
from terrain.errors import BatchError

CONNECTS_S = 10.0
ONE_AT_A_TIME = threading.Lock()  # in one process: figures and OpenCV have settings of a process


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
    distributed = extra_module("distributed", "dask", "--scheduler")
    with _client(distributed, address) as client:
        require_workers(client, address, jobs)
        job_of = {client.submit(on_worker, job): job for job in jobs}
        for future in distributed.as_completed(list(job_of), loop=client.loop):
            job = job_of.pop(future)
            if future.status not in {"finished", "error"}:
                raise BatchError(f"the scheduler {address} is gone")
            yield future.result() if future.status == "finished" else _lost(job, future)


def on_worker(job: Job) -> Outcome:
    """Do a job; what a lost worker left of it goes first, wherever that worker was."""
    with ONE_AT_A_TIME:
        remove_foreign_stages(job.out)
        return run_job(job)


@contextmanager
def _client(distributed: Any, address: str) -> Iterator[Any]:
    """A connection; what Dask warns of, other versions, is looked at by `require_workers`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            client = distributed.Client(address, timeout=CONNECTS_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise BatchError(
                f"--scheduler {address}: no scheduler answers there within {CONNECTS_S:g} s "
                f"({_first_line(error)}); start one with: dask scheduler"
            ) from error
    with client:
        yield client


def _lost(job: Job, future: Any) -> Outcome:
    error = future.exception()
    if type(error).__name__ == "KilledWorker":
        said = f"every worker that replayed it was lost, {error.last_worker.address} last"
    else:
        said = f"{type(error).__name__}: {_first_line(error)}"
    return Outcome(job, FAILED, said)


def _first_line(error: BaseException) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
