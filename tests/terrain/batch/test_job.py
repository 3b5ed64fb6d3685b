"""One run of many: done, kept, done again, or failed."""

from dataclasses import replace

import pytest

from odometry.outputs.manifest import Manifest, read_manifest
from terrain.batch.job import FAILED, KEPT, REPLAYED, run_job
from terrain.config import Config
from terrain.run_options import RunOptions


@pytest.fixture(autouse=True)
def without_page(monkeypatch):
    monkeypatch.setattr("terrain.report.page.write_report", lambda *_, **__: None)


@pytest.fixture
def done(job_of, curvy_run):
    """A job that was done once."""
    job = job_of(curvy_run)
    outcome = run_job(job)
    assert (outcome.state, outcome.said) == (REPLAYED, "")
    assert outcome.wall_s > 0
    assert outcome.cpu_s > 0
    return job


def written(job):
    return {path: path.stat().st_mtime_ns for path in job.out.rglob("*") if path.is_file()}


def test_what_is_done_is_kept(done):
    before = written(done)
    outcome = run_job(done)
    assert outcome.state == KEPT
    assert outcome.sums[0][2] == read_manifest(done.out).made["inputs"][0]["sha256"]
    assert written(done) == before


def test_a_result_without_a_file_is_not_whole(done):
    (done.out / "odometer.tum").unlink()
    assert run_job(done).state == REPLAYED
    assert (done.out / "odometer.tum").is_file()


@pytest.mark.parametrize(
    ("edit", "words"),
    [(lambda text: text[: len(text) // 2], "rows are lost"), (lambda text: text + "9\n", "edited")],
)
def test_a_result_that_was_cut_or_edited_is_made_again_and_it_is_said(done, edit, words):
    table = done.out / "estimate.csv"
    before = table.read_text()
    table.write_text(edit(before))
    outcome = run_job(done)
    assert outcome.state == REPLAYED
    assert words in outcome.said
    assert table.read_text() == before


def test_an_unfinished_result_is_not_whole(done):
    manifest = read_manifest(done.out)
    Manifest("run", "unfinished", manifest.files).write(done.out)
    assert run_job(done).state == REPLAYED
    assert read_manifest(done.out) == manifest


def test_other_settings_replace_the_result_and_say_so(done):
    asked = replace(done.asked, settings={"terrain": ["ice"]}, command="run --terrain ice")
    options = RunOptions(Config(), terrain="ice")
    outcome = run_job(replace(done, asked=asked, options=options))
    assert outcome.state == REPLAYED
    assert outcome.said == f"made by other settings: {done.asked.command}"
    assert 'terrain": "ice"' in (done.out / "result.json").read_text()


def test_another_recording_replaces_the_result_and_says_so(done, world, tmp_path):
    other = world.drive_curves(tmp_path / "other", truth=True)
    outcome = run_job(replace(done, folder=other, asked=replace(done.asked, where=tmp_path)))
    assert outcome.state == KEPT  # the asked run is the same
    asked = replace(done.asked, inputs=(("RUN", other),))
    assert run_job(replace(done, folder=other, asked=asked)).said == "another RUN"


def test_other_packages_replace_the_result_and_say_so(done, monkeypatch):
    monkeypatch.setattr("odometry.outputs.provenance.installed_packages", lambda: {"numpy": "9.9"})
    outcome = run_job(done)
    assert outcome.state == REPLAYED
    assert outcome.said.startswith("made with numpy ")
    assert outcome.said.endswith(", now 9.9")


def test_a_run_that_cannot_be_read_is_an_outcome(job_of, tmp_path):
    outcome = run_job(job_of(tmp_path / "absent"))
    assert outcome.state == FAILED
    assert "absent: there is no such folder" in outcome.said
    assert not (tmp_path / "out" / "absent").exists()


def test_a_fault_of_the_program_is_an_outcome_in_one_line(job_of, curvy_run, monkeypatch):
    def fail(*_, **__):
        raise ValueError("shapes\ndo not fit")

    monkeypatch.setattr(RunOptions, "replay", fail)
    outcome = run_job(job_of(curvy_run))
    assert (outcome.state, outcome.said) == (FAILED, "ValueError: shapes do not fit")


def test_a_folder_of_another_verb_is_refused(job_of, curvy_run):
    job = job_of(curvy_run)
    job.out.mkdir(parents=True)
    Manifest("gap", "finished", ()).write(job.out)
    outcome = run_job(job)
    assert outcome.state == FAILED
    assert "holds what `gap` made" in outcome.said
