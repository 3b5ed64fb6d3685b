"""Many runs replayed into one folder: a folder each, one table and one page over all of them."""

import csv
import os
import signal
import threading
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import active_children, forkserver, get_all_start_methods, get_context
from multiprocessing import parent_process as parent_of_this
from pathlib import Path

from tqdm import tqdm

from odometry.io.csv_columns import quoted_text
from odometry.outputs.leftovers import stage_name
from odometry.outputs.manifest import FINISHED, UNFINISHED, Manifest
from odometry.outputs.output_folder import claim_folder
from odometry.outputs.provenance import Asked, Made, installed_packages
from odometry.parameters import ParameterSet
from terrain.batch.cluster import cluster_outcomes
from terrain.batch.job import FAILED, KEPT, Job, Outcome, run_job
from terrain.batch.page import write_batch_page
from terrain.batch.row import LEARNED, Learned, Row, merge, row_of, write_learned, write_rows

TABLE, PAGE, TIMES = "batch.csv", "report.html", "times.csv"
FILES = (TABLE, LEARNED, PAGE, TIMES)


@dataclass(frozen=True)
class Batch:
    """What came of many runs.

    Attributes
    ----------
    rows : tuple of Row
        In the order in which the runs were given.
    outcomes : tuple of Outcome
        In the same order.
    learned : Learned
    wall_s : float
        What the jobs took together, all processes at once.
    """

    rows: tuple[Row, ...]
    outcomes: tuple[Outcome, ...]
    learned: Learned
    wall_s: float


def run_batch(
    jobs: Sequence[Job],
    asked: Asked,
    out: Path,
    before: ParameterSet,
    *,
    processes: int,
    scheduler: str | None = None,
    show_progress: bool = False,
) -> Batch:
    """Replay many runs, and write batch.csv, report.html, learned.toml and times.csv beside them.

    A run whose folder already holds the same results is not replayed again: a stopped batch
    continues where it was. All files but times.csv are the same on any process.

    Parameters
    ----------
    jobs : sequence of Job
        Their `out` are folders in `out`.
    asked : Asked
        The command that starts all of them.
    out : Path
    before : ParameterSet
        With which every run begins.
    processes : int
        Of this machine, where there is no scheduler.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers do the jobs.
    show_progress : bool

    Raises
    ------
    OutputError
        If `out` cannot be written to, or holds what another command made.
    BatchError
        If the cluster cannot do the jobs.
    """
    claim_folder(out, Made(asked.verb, "", {}, (), {}))
    with _held(out) as found:
        began_s = time.monotonic()
        outcomes = (
            local_outcomes(jobs, processes)
            if scheduler is None
            else cluster_outcomes(jobs, scheduler)
        )
        bar = tqdm(total=len(jobs), unit="run", disable=None if show_progress else True)
        with bar, (out / TIMES).open("a", newline="", encoding="utf-8") as times:
            writer = csv.writer(times, lineterminator="\n")
            if not times.tell():
                writer.writerow(("run", "state", "wall_s", "cpu_s"))
            for outcome in outcomes:
                found[outcome.job.name] = outcome
                if outcome.state != KEPT:
                    writer.writerow(_times(outcome))
                    times.flush()
                bar.update()
        wall_s = time.monotonic() - began_s
        ordered = [found[job.name] for job in jobs]
        rows = [row_of(outcome) for outcome in ordered]
        learned = merge(out, rows, before)
        made = _made(asked, ordered)
        write_rows(rows, out / TABLE)
        has_learned = write_learned(learned, out / LEARNED, made.to_comment())
        write_batch_page(rows, learned, out / PAGE)
        files = tuple(name for name in FILES if name != LEARNED or has_learned)
        Manifest(asked.verb, FINISHED, files, made.to_table()).write(out)
    return Batch(tuple(rows), tuple(ordered), learned, wall_s)


@contextmanager
def _held(out: Path) -> Iterator[dict[str, Outcome]]:
    """Mark a folder as unfinished and as ours while the runs are replayed; gives a place for them.

    What is left by a failure says so, and the runs that are whole stay.
    """
    stage = out / stage_name()
    stage.mkdir(parents=True)
    found: dict[str, Outcome] = {}
    try:
        Manifest("batch", UNFINISHED, FILES).write(out)
        yield found
    except BaseException as error:
        whole = sum(outcome.state != FAILED for outcome in found.values())
        error.add_note(f"{whole} runs are whole in {out}; the same command does the others")
        raise
    finally:
        stage.rmdir()


def _made(asked: Asked, outcomes: Sequence[Outcome]) -> Made:
    """What made the batch; the sums are those that the jobs found."""
    sums = {(role, path): sha256 for of in outcomes for role, path, sha256 in of.sums}
    inputs = tuple(
        (role, str(path), sums.get((role, str(path)), "")) for role, path in asked.inputs
    )
    return Made(asked.verb, asked.command, asked.settings, inputs, installed_packages())


def _times(of: Outcome) -> tuple[str, ...]:
    return quoted_text(of.job.name), of.state, f"{of.wall_s:.3f}", f"{of.cpu_s:.3f}"


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


METHOD = "forkserver" if "forkserver" in get_all_start_methods() else "spawn"
NEEDED = "terrain.batch.job"
ONE_THREAD = dict.fromkeys(("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def prepare() -> None:
    """Let a process import what a replay needs, while this one does other things.

    Processes forked from it need not: importing takes as long as a short run. It has one thread,
    as a process must that is forked.
    """
    if METHOD != "forkserver":
        return
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        forkserver.set_forkserver_preload([NEEDED])
        forkserver.ensure_running()
    finally:
        os.environ.clear()
        os.environ.update(before)


@contextmanager
def pool(processes: int) -> Iterator[ProcessPoolExecutor]:
    """So many processes that end with this one; at once where the work is broken off."""
    prepare()
    others = set(active_children())
    executor = ProcessPoolExecutor(processes, get_context(METHOD), end_with_parent)
    try:
        yield executor
    except BaseException:
        executor.shutdown(wait=False, cancel_futures=True)
        for process in set(active_children()) - others:
            process.kill()
        raise
    executor.shutdown()


def end_with_parent() -> None:
    """Let this process end soon after its parent, which alone hears of Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_watch, daemon=True).start()


def _watch() -> None:
    if parent := parent_of_this():
        parent.join()
    os._exit(1)
