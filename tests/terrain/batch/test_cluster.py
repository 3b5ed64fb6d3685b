"""Runs replayed by a Dask cluster."""

import gc
import os
import weakref
from importlib.metadata import version

import pytest

pytest.importorskip("distributed", reason="the extra dask is not installed")

from terrain.batch.cluster import cluster_outcomes
from terrain.batch.job import FAILED, KEPT, REPLAYED, run_job
from terrain.errors import BatchError
from tests.terrain.dask_processes import started_scheduler, started_workers

WITHOUT_PAGE = "import terrain.report.page as page; page.write_report = lambda *_, **__: None"


@pytest.fixture(scope="module")
def scheduler():
    with started_scheduler() as address:
        yield address


@pytest.fixture(scope="module")
def workers(scheduler):
    """The address of a scheduler, and its two workers; the last test that has them kills one."""
    with started_workers(scheduler, 2, WITHOUT_PAGE) as started:
        yield scheduler, started


def refused(jobs, address):
    with pytest.raises(BatchError) as caught:
        list(cluster_outcomes(jobs, address))
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_a_scheduler_without_workers_is_reported_in_one_line(
    scheduler, curvy_run, job_of, monkeypatch
):
    monkeypatch.setattr("terrain.dask_connection.WAITS_S", 0.3)
    message = refused([job_of(curvy_run)], scheduler)
    assert "has no workers; start some with: dask worker" in message


@pytest.mark.slow
def test_a_worker_that_cannot_do_the_jobs_is_reported_in_one_line(
    workers, curvy_run, job_of, tmp_path, monkeypatch
):
    scheduler, _ = workers
    with monkeypatch.context() as older:
        older.setattr("odometry.outputs.provenance.version", lambda _: "0.1")
        message = refused([job_of(curvy_run)], scheduler)
    assert f"terrain-odometry {version('terrain-odometry')} (here 0.1)" in message
    opened = os.open(tmp_path, os.O_RDONLY)
    mine = job_of(curvy_run, out=type(tmp_path)(f"/proc/self/fd/{opened}/out"))
    message = refused([mine], scheduler)
    assert f"cannot read /proc/self/fd/{opened}/out" in message
    seen = job_of(type(tmp_path)(f"/proc/self/fd/{opened}/out"))
    assert f"cannot read {seen.folder}" in refused([seen], scheduler)
    os.close(opened)


def contents(folder):
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.slow
def test_all_results_arrive_though_a_worker_is_killed(
    workers, four_runs, job_of, tmp_path, monkeypatch
):
    scheduler, (first, _) = workers
    jobs = [job_of(folder) for folder in sorted(four_runs.iterdir())]
    jobs.append(job_of(four_runs / "absent"))
    monkeypatch.setattr("terrain.report.page.write_report", lambda *_, **__: None)
    states = {}
    for outcome in cluster_outcomes(jobs, scheduler):
        states[outcome.job.name] = outcome.state
        first.kill()  # with the first outcome that comes: there is more to do
    assert states.pop("absent") == FAILED
    assert set(states) == set("abcd")  # what its worker did not report any more is found done
    assert set(states.values()) <= {REPLAYED, KEPT}
    again = list(cluster_outcomes(jobs[:2], scheduler))
    assert [outcome.state for outcome in again] == [KEPT, KEPT]
    here = [job_of(folder, out=tmp_path / "here") for folder in sorted(four_runs.iterdir())]
    assert {run_job(job).state for job in here} == {REPLAYED}
    assert contents(tmp_path / "out") == contents(tmp_path / "here")


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "host:1:2", "nonsense"])
def test_a_scheduler_that_does_not_answer_is_reported_in_one_line(
    job_of, curvy_run, address, monkeypatch
):
    monkeypatch.setattr("terrain.dask_connection.CONNECTS_S", 0.5)
    message = refused([job_of(curvy_run)], address)
    assert message.startswith(f"--scheduler {address}: no scheduler answers there")
    assert "dask scheduler" in message


def test_a_client_that_failed_is_gone_before_the_next_one(job_of, curvy_run, monkeypatch):
    distributed = pytest.importorskip("distributed")
    made, left = [], []

    class Watched(distributed.Client):
        def __init__(self, *arguments, **options):
            left.append(sum(one() is not None for one in made))
            made.append(weakref.ref(self))
            super().__init__(*arguments, **options)

    monkeypatch.setattr(distributed, "Client", Watched)
    monkeypatch.setattr("terrain.dask_connection.CONNECTS_S", 0.2)
    gc.disable()
    try:
        for _ in range(2):
            refused([job_of(curvy_run)], "tcp://127.0.0.1:9")
    finally:
        gc.enable()
    assert left == [0, 0]
