"""Whether the workers of a cluster see the files of the jobs."""

import os
import secrets
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from terrain.batch.job import Job
from terrain.errors import BatchError

NAMED = 3  # of what is missing


def require_files(client: Any, jobs: Sequence[Job]) -> None:
    """Raise BatchError unless each worker reads the files of the jobs and writes where they do."""
    files = {file for job in jobs for file in (job.folder, *job.options.files) if file.exists()}
    with _token(jobs[0].out.parent) as (file, token):
        answers = client.run(look, sorted(files), file)
    for worker, (missing, read, writes) in answers.items():
        where = f"the worker {worker}"
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


def look(files: Sequence[Path], token: Path) -> tuple[list[Path], str, bool]:
    """What a worker sees: which files are missing, what the token says, whether it may write."""
    read = token.read_text(encoding="ascii") if token.is_file() else ""
    missing = [file for file in files if not file.exists()]
    return missing, read, os.access(token.parent, os.W_OK | os.X_OK)


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
