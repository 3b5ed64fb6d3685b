"""Runs replayed by the workers of a Dask cluster."""

import os
import secrets
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from odometry.outputs.leftovers import remove_foreign_stages
from terrain.batch.job import FAILED, Job, Outcome, run_job
from terrain.dask_connection import ONE_AT_A_TIME, answers, connected, failure
from terrain.errors import BatchError

NAMED = 3  # of what is missing


def cluster_outcomes(jobs: Sequence[Job], address: str) -> Iterator[Outcome]:
    """Do the jobs on the workers of a scheduler; outcomes come as they are there.

    A job whose worker is lost is done by another one; one that loses several (by default 4, the
    scheduler's `allowed-failures` and one more) is taken for their end, and fails.

    Parameters
    ----------
    jobs : sequence of Job
        Their folders and files lie on a path that all workers can read.
    address : str
        Of the scheduler, such as tcp://host:8786.

    Raises
    ------
    ExtraError
        If Dask is not installed.
    BatchError
        If the scheduler cannot be reached, has no workers, or workers of other versions, or some
        that cannot read the files.
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


def require_files(client: Any, jobs: Sequence[Job]) -> None:
    """Raise BatchError unless each worker reads the files of the jobs and writes where they do."""
    files = {file for job in jobs for file in (job.folder, *job.options.files) if file.exists()}
    with _token(jobs[0].out.parent) as (file, token):
        answers = client.run(look, sorted(files), file)
    for worker, (missing, read, writes) in answers.items():
        where = f"the worker {worker}"
        if read != token or not writes:
            seen = "may not write to" if read == token else "cannot read"
            raise BatchError(
                f"{where} {seen} {file.parent}: runs and results have to lie on a path that all "
                "workers can read"
            )
        if missing:
            raise BatchError(
                f"{where} cannot read {_some(missing)}: runs, models and parameter sets have to "
                "lie on a path that all workers can read"
            )


def look(files: Sequence[Path], token: Path) -> tuple[list[Path], str, bool]:
    """What a worker finds: missing files, the content of the token file, whether it may write."""
    read = token.read_text(encoding="ascii") if token.is_file() else ""
    missing = [file for file in files if not file.exists()]
    return missing, read, os.access(token.parent, os.W_OK | os.X_OK)


@contextmanager
def _token(folder: Path) -> Iterator[tuple[Path, str]]:
    """A file of random content: a worker that reads it has the same folder."""
    file, token = folder / f".token.{os.getpid()}.part", secrets.token_hex(8)
    folder.mkdir(parents=True, exist_ok=True)
    file.write_text(token, encoding="ascii")
    try:
        yield file, token
    finally:
        file.unlink(missing_ok=True)


def _some(missing: Iterable[Path]) -> str:
    names = [str(file) for file in missing]
    more = len(names) - NAMED
    return ", ".join(names[:NAMED]) + (f" and {more} more" if more > 0 else "")
