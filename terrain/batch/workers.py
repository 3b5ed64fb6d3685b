"""Whether the workers of a cluster can do the jobs: same versions, and they see the same files."""

import os
import platform
import secrets
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import Any

from odometry.outputs.made import installed_packages
from terrain.batch.job import Job
from terrain.errors import BatchError

WAITS_S = 10.0
ON_SCHEDULER = ("dask", "distributed")  # packages that a scheduler needs
NAMED = 3  # of what is missing


def require_workers(client: Any, address: str, jobs: Sequence[Job]) -> None:
    """Raise BatchError unless there are workers, and each of them can do the jobs."""
    try:
        client.wait_for_workers(1, timeout=WAITS_S)
    except TimeoutError:
        raise BatchError(
            f"{address} has no workers; start some with: dask worker {address} --nthreads 1"
        ) from None
    here = versions()
    scheduler = client.get_versions()["scheduler"]["packages"]
    _require_same(
        {name: here[name] for name in ON_SCHEDULER}, scheduler, f"the scheduler {address}"
    )
    files = {file for job in jobs for file in (job.folder, *job.options.files) if file.exists()}
    with _token(jobs[0].out.parent) as (file, token):
        answers = client.run(look, sorted(files), file, on_error="return")
    for worker, answer in answers.items():
        where = f"the worker {worker}"
        if isinstance(answer, BaseException):
            raise BatchError(
                f"{where} cannot run this program ({type(answer).__name__}: {answer}); install "
                f"terrain-odometry {here.get('terrain-odometry', '')} there"
            )
        found, missing, read, writes = answer
        _require_same(here, found, where)
        if read != token or not writes:
            seen = "may not write to" if read == token else "does not see"
            raise BatchError(
                f"{where} {seen} {file.parent}: runs and results have to lie on a path that all "
                "workers see"
            )
        if missing:
            raise BatchError(
                f"{where} does not see {_some(missing)}: runs, models and parameter sets have to "
                "lie on a path that all workers see"
            )


def look(files: Sequence[Path], token: Path) -> tuple[dict[str, str], list[Path], str, bool]:
    """What a worker has: versions, which files are missing, what the token says, may it write."""
    read = token.read_text(encoding="ascii") if token.is_file() else ""
    missing = [file for file in files if not file.exists()]
    return versions(), missing, read, os.access(token.parent, os.W_OK | os.X_OK)


def versions() -> dict[str, str]:
    """Versions on which it depends that the results are the same everywhere."""
    packages = {name: version(name) for name in ON_SCHEDULER}
    return {"python": platform.python_version(), **packages, **installed_packages()}


def _require_same(here: Mapping[str, str], there: Mapping[str, Any], where: str) -> None:
    differ = [
        f"{name} {there.get(name, 'absent')} (here {wanted})"
        for name, wanted in here.items()
        if there.get(name, "absent") != wanted
    ]
    if differ:
        raise BatchError(
            f"{where} has {', '.join(differ)}: expected the same versions on all machines"
        )


@contextmanager
def _token(folder: Path) -> Iterator[tuple[Path, str]]:
    """A file of random content, by which a worker shows that it sees this very folder."""
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
