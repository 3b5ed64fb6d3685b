"""`batch`: what `run` gives for each run, and the table, page and set over all of them."""

import csv
import json
import shutil
import signal
import subprocess
import sys
import time

import pytest
from click.testing import CliRunner

from odometry.outputs.manifest import read_manifest
from odometry.parameters import read_parameters
from terrain.batch import job as job_module
from terrain.cli.verbs.batch import batch
from terrain.cli.verbs.run import run

NAMES = ["a", "b", "c"]


@pytest.fixture
def here(tmp_path, world, monkeypatch):
    """Runs a, b and c, and one that cannot be read, in the current folder."""
    monkeypatch.chdir(tmp_path)
    for name in NAMES:
        world.drive_curves(tmp_path / name, truth=name == "b")
    shorter = (tmp_path / "c" / "odometry.csv").read_text().splitlines()[:-1]
    (tmp_path / "c" / "odometry.csv").write_text("\n".join(shorter) + "\n")  # no copy of a
    (tmp_path / "bad").mkdir()
    (tmp_path / "bad" / "run.toml").write_text("[robot]\n")
    return tmp_path


def call(verb, *words):
    return CliRunner().invoke(verb, [*words, "--out", "out"])


def contents(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name != "times.csv"
    }


def rows(folder, name="batch.csv"):
    with (folder / name).open() as stream:
        return list(csv.DictReader(stream))


def replayed(folder):
    return [row["run"] for row in rows(folder, "times.csv") if row["state"] == "replayed"]


@pytest.mark.slow
def test_each_folder_is_byte_for_byte_what_run_makes(here):
    answer = call(batch, "a", "b", "--processes", "1", "--terrain", "clay")
    assert answer.exit_code == 0, answer.output
    for name in ("a", "b"):
        alone = CliRunner().invoke(run, [name, "--terrain", "clay", "--out", f"alone/{name}"])
        assert alone.exit_code == 0, alone.output
    batched = contents(here / "out")
    assert {n: c for n, c in batched.items() if "/" in n} == contents(here / "alone")


@pytest.mark.usefixtures("no_report")
def test_a_failed_run_is_a_row_and_the_exit_code_says_so(here):
    (here / "notes.txt").write_text("a file that `*` brings along\n")
    answer = call(batch, "a", "bad", "b", "absent", "notes.txt", "--processes", "1")
    assert answer.exit_code == 1
    table = rows(here / "out")
    assert [row["run"] for row in table] == ["a", "bad", "b", "absent", "notes.txt"]
    assert [bool(row["error"]) for row in table] == [False, True, False, True, True]
    assert "this is a file; expected a run folder" in table[4]["error"]
    assert "[robot] with track_width [m] is required" in table[1]["error"]
    assert f"bad: failed: {table[1]['error']}" in answer.output
    assert "5 runs: 2 replayed in" in answer.output
    assert "3 failed" in answer.output
    assert table[2]["reference"] == "truth"
    result = json.loads((here / "out" / "b" / "result.json").read_text())
    mean = result["errors"]["odometer"]["translation_m_per_m"]["mean"]
    assert float(table[2]["odometer_m_per_m"]) == pytest.approx(mean, abs=1e-9)
    assert not (here / "out" / "bad").exists()


@pytest.mark.usefixtures("no_report")
def test_what_is_whole_is_not_replayed_again_and_the_bytes_are_the_same(here):
    assert call(batch, *NAMES, "--processes", "1").exit_code == 0
    before = contents(here / "out")
    assert replayed(here / "out") == NAMES
    (here / "out" / "b" / "odometer.csv").unlink()
    answer = call(batch, *NAMES, "--processes", "1")
    assert "1 replayed" in answer.output
    assert "2 done already" in answer.output
    assert contents(here / "out") == before
    assert replayed(here / "out") == [*NAMES, "b"]
    assert not list((here / "out").glob(".*"))


@pytest.mark.usefixtures("here", "no_report")
def test_other_settings_replace_and_say_so():
    assert call(batch, "a", "--processes", "1").exit_code == 0
    answer = call(batch, "a", "--processes", "1", "--terrain", "ice")
    said = "Note: a is replayed again: made by other settings: terrain-odometry run a\n"
    assert said in answer.output
    assert set(read_parameters("out/learned.toml").terrains) == {"ice"}


@pytest.mark.usefixtures("no_report")
def test_the_same_set_of_runs_is_learned_from_once(here):
    answer = call(batch, "a", "./a", str(here / "a"), "--processes", "1")
    assert answer.output.count("given twice") == 2
    assert [row["run"] for row in rows(here / "out")] == ["a"]
    assert "no spread between runs: 3 or more runs are needed" in answer.output


@pytest.mark.usefixtures("no_report")
def test_runs_of_one_name_get_folders_of_their_own(here):
    shutil.copytree("b", "other/a")
    assert call(batch, "a", "other/a", "--processes", "1").exit_code == 0
    assert [(row["run"], row["folder"]) for row in rows(here / "out")] == [
        ("a", "a"),
        ("a_2", "other/a"),
    ]


@pytest.mark.usefixtures("no_report")
def test_the_merged_set_is_one_to_start_from(here):
    answer = call(batch, *NAMES, "--processes", "1")
    merged = read_parameters("out/learned.toml")
    (table,) = merged.terrains.values()
    assert table.source == "merged by terrain-odometry from what 3 runs learned"
    assert "standard deviation between runs: y_left" in answer.output
    assert "# RUN a: sha256" in (here / "out" / "learned.toml").read_text()
    words = ["a", "--parameters", "out/learned.toml", "--out", "next"]
    assert CliRunner().invoke(run, words).exit_code == 0
    answer = call(batch, "a", "--parameters", "out/learned.toml", "--processes", "1")
    assert "is or holds the input" in str(answer.exception)


@pytest.mark.usefixtures("no_report")
def test_a_run_of_another_robot_is_not_merged(here):
    file = here / "b" / "run.toml"
    file.write_text(file.read_text().replace("0.3", "0.31"))
    answer = call(batch, "a", "b", "--processes", "1")
    assert "Nothing is merged, the runs are of several robots: a robot 0.3 m" in answer.output
    assert not (here / "out" / "learned.toml").exists()


@pytest.mark.usefixtures("no_report")
def test_a_misled_run_is_flagged_and_not_merged(here):
    lines = (here / "b" / "odometry.csv").read_text().splitlines()
    cells = lines[60].split(",")
    lines[60] = ",".join([cells[0], "50", *cells[2:]])
    (here / "b" / "odometry.csv").write_text("\n".join(lines) + "\n")
    answer = call(batch, *NAMES, "--processes", "1")
    assert "absurd_speed" in rows(here / "out")[1]["flags"]
    assert "Not merged, because something misled the filter: b (absurd_speed" in answer.output
    (table,) = read_parameters("out/learned.toml").terrains.values()
    assert "2 runs" in table.source


def test_a_folder_named_like_a_formula_is_a_text_in_every_table(here):
    """With a comma, which ends no cell."""
    name = "=1+1,2"
    (here / "bad").rename(here / name)
    assert call(batch, name, "--processes", "1").exit_code == 1
    for table in ("batch.csv", "times.csv"):
        (row,) = rows(here / "out", table)
        assert row["run"] == f"'{name}"
    assert row["state"] == "failed"


def test_the_page_shows_the_worst_first_and_links_to_each(here):
    assert call(batch, *NAMES, "bad", "--processes", "1").exit_code == 1
    page = (here / "out" / "report.html").read_text()
    table = [row for row in rows(here / "out") if not row["error"]]
    worst = sorted(table, key=lambda row: -float(row["odometer_m_per_m"]))
    places = [page.index(f'<a href="{row["run"]}/report.html">') for row in worst]
    assert places == sorted(places)
    assert "3 of 4 runs are done." in page
    assert "track_width [m] is required" in page
    for row in table:
        assert (here / "out" / row["run"] / "report.html").is_file()


@pytest.mark.usefixtures("no_report")
def test_an_interrupt_leaves_what_is_whole_and_goes_on_from_there(here, monkeypatch):
    kept, calls = job_module.run_job, []

    def stop(job):
        calls.append(job.name)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return kept(job)

    monkeypatch.setattr("terrain.batch.batch.run_job", stop)
    answer = call(batch, *NAMES, "--processes", "1")
    assert answer.exit_code != 0
    manifest = read_manifest(here / "out")
    assert (manifest.verb, manifest.state) == ("batch", "unfinished")
    assert not list((here / "out").glob(".*"))
    monkeypatch.setattr("terrain.batch.batch.run_job", kept)
    assert call(batch, *NAMES, "--processes", "1").exit_code == 0
    assert replayed(here / "out") == NAMES
    assert read_manifest(here / "out").state == "finished"


@pytest.mark.slow
@pytest.mark.usefixtures("no_report")
def test_a_killed_batch_goes_on_to_the_same_bytes(here):
    """SIGKILL of the batch at some moment: what was whole stays, and nothing is done twice."""
    program = (
        "import terrain.report.page; terrain.report.page.write_report = lambda *_, **__: None\n"
        "from terrain.cli.main import main; main()"
    )
    words = [sys.executable, "-c", program, "batch", *NAMES, "--processes", "1"]
    with subprocess.Popen([*words, "--out", "out"], stderr=subprocess.PIPE) as killed:
        while (
            not (times := here / "out" / "times.csv").is_file() or "\na," not in times.read_text()
        ):
            time.sleep(0.02)
            assert killed.poll() is None
        killed.send_signal(signal.SIGKILL)
        killed.communicate()
    counted = set(replayed(here / "out"))
    whole = {name for name in NAMES if (here / "out" / name / "result.json").is_file()}
    assert counted <= whole
    assert read_manifest(here / "out").state == "unfinished"
    subprocess.run([*words, "--out", "out"], check=True, capture_output=True)
    done = replayed(here / "out")
    assert len(done) == len(set(done))
    assert set(NAMES) - set(done) == whole - counted  # whole, and killed before it was counted
    undisturbed = [*NAMES, "--processes", "1", "--out", "undisturbed"]
    assert CliRunner().invoke(batch, undisturbed).exit_code == 0
    assert contents(here / "out") == contents(here / "undisturbed")


@pytest.mark.usefixtures("here", "no_report")
def test_what_an_earlier_call_left_is_said():
    assert call(batch, "a", "b", "--processes", "1").exit_code == 0
    answer = call(batch, "a", "--processes", "1")
    assert "Note: out also holds runs of an earlier call, which no table counts: b" in answer.output
