"""Output folders: what is refused, what a failure leaves, and a kill at every step."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from odometry.errors import OutputError
from odometry.outputs.manifest import NAME, check_finished, read_manifest
from odometry.outputs.output_folder import claim_folder

FIRST = {"result.json": "first", "odometer.csv": "first", "learned.toml": "first"}
SECOND = {"result.json": "second", "odometer.csv": "second", "figures/path.png": "second"}


def write(out, made, contents):
    with claim_folder(out, made).writing() as part:
        for name, text in contents.items():
            (part / name).parent.mkdir(exist_ok=True)
            (part / name).write_text(text)


def files(folder):
    """Every file and folder: names and contents."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() if path.is_file() else None
        for path in folder.rglob("*")
    }


def results(folder):
    """Texts of the files that are no manifest and not temporary."""
    found = {name: text.decode() for name, text in files(folder).items() if text is not None}
    return {name: text for name, text in found.items() if name != NAME and ".part" not in name}


@pytest.mark.parametrize("there", ["absent", "empty", "deep"])
def test_a_free_folder_gets_the_files_and_a_manifest_that_names_them(tmp_path, made, there):
    out = tmp_path / "a" / "b" if there == "deep" else tmp_path / "out"
    if there == "empty":
        out.mkdir()
    write(out, made, SECOND)
    assert results(out) == SECOND
    manifest = read_manifest(out)
    assert (manifest.state, manifest.verb) == ("finished", "run")
    assert set(manifest.files) == set(SECOND)
    assert manifest.made["identity"] == made.identity
    assert set(files(out)) == {*SECOND, "figures", NAME}


def test_a_second_run_replaces_the_first_and_leaves_a_strangers_file(tmp_path, made):
    write(tmp_path, made, FIRST)
    (tmp_path / "notes.txt").write_text("mine")
    write(tmp_path, made, SECOND)
    assert results(tmp_path) == {**SECOND, "notes.txt": "mine"}
    write(tmp_path, made, FIRST)
    assert results(tmp_path) == {**FIRST, "notes.txt": "mine"}
    assert not (tmp_path / "figures").exists()


def test_a_folder_that_somebody_else_filled_is_refused_and_not_touched(tmp_path, made):
    (tmp_path / "thesis.tex").write_text("years of work")
    before = files(tmp_path)
    with pytest.raises(OutputError, match=r"not empty, and `run` did not make it; choose another"):
        claim_folder(tmp_path, made)
    assert files(tmp_path) == before


def test_a_folder_of_another_verb_is_refused(tmp_path, made):
    write(tmp_path, made, FIRST)
    with pytest.raises(OutputError, match="holds what `run` made"):
        claim_folder(tmp_path, replace(made, verb="gap"))


@pytest.mark.parametrize("name", ["terrain.csv", "figures/path.png"])
def test_a_strangers_file_of_a_name_of_ours_is_refused_before_any_work(tmp_path, made, name):
    write(tmp_path, made, FIRST)
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    with pytest.raises(OutputError, match=rf"{name}: it is in the way"):
        claim_folder(tmp_path, made)


def test_a_strangers_file_that_comes_later_stops_the_move_before_it_begins(tmp_path, made):
    write(tmp_path, made, FIRST)
    before = results(tmp_path)

    def write_while_a_file_appears():
        with claim_folder(tmp_path, made).writing() as part:
            (part / "new.csv").write_text("ours")
            (tmp_path / "new.csv").write_text("mine")

    with pytest.raises(OutputError, match=r"new\.csv: it is in the way"):
        write_while_a_file_appears()
    assert results(tmp_path) == {**before, "new.csv": "mine"}
    assert read_manifest(tmp_path).state == "finished"


def test_a_link_in_the_folder_is_not_written_through(tmp_path, made):
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    write(out, made, SECOND)
    elsewhere.mkdir()
    (elsewhere / "path.png").write_text("mine")
    (out / "figures" / "path.png").unlink()
    (out / "figures").rmdir()
    (out / "figures").symlink_to(elsewhere)
    with pytest.raises(OutputError, match="figures: it is in the way"):
        write(out, made, SECOND)
    assert (elsewhere / "path.png").read_text() == "mine"


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_a_failure_leaves_no_trace_or_the_earlier_result(tmp_path, made, error):
    def fail(out):
        with claim_folder(out, made).writing() as part:
            (part / "result.json").write_text("half")
            raise error

    with pytest.raises(error) as caught:
        fail(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()
    assert caught.value.__notes__ == [f"nothing was written to {tmp_path / 'a' / 'b'}"]
    write(tmp_path / "out", made, FIRST)
    before = files(tmp_path)
    with pytest.raises(error) as caught:
        fail(tmp_path / "out")
    assert files(tmp_path) == before
    assert caught.value.__notes__ == [f"{tmp_path / 'out'} holds the earlier result, unchanged"]


def in_child_killed_at(step, out, made):
    """Write SECOND in a child process that ends, with no tidying up, before its n-th change."""
    child = os.fork()
    if child == 0:
        steps = iter(range(step))
        for name in ("mkdir", "rmdir", "replace", "unlink", "write_text"):
            kept = getattr(Path, name)

            def change(self, *args, _kept=kept, **kwargs):
                if next(steps, None) is None:
                    os._exit(9)
                return _kept(self, *args, **kwargs)

            setattr(Path, name, change)
        try:
            write(out, made, SECOND)
        finally:
            os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.parametrize("earlier", [None, FIRST], ids=["into nothing", "over an earlier result"])
def test_a_kill_at_any_step_tears_and_mixes_nothing(tmp_path, made, earlier):
    """Either the old result whole, or the new one whole, or the folder says `unfinished`."""
    write(tmp_path / "undisturbed", made, SECOND)
    undisturbed = files(tmp_path / "undisturbed")
    step, states = 0, []
    while True:
        out = tmp_path / str(step)
        if earlier:
            write(out, made, earlier)
        finished = in_child_killed_at(step, out, made) == 0
        if out.exists() and any(".part" not in name for name in files(out)):
            manifest = read_manifest(out)
            states.append(manifest.state)
            if manifest.state == "finished":
                assert results(out) in (earlier, SECOND)
            else:
                with pytest.raises(OutputError, match=r"unfinished: `terrain-odometry run` was"):
                    check_finished(out)
        write(out, made, SECOND)
        assert files(out) == undisturbed
        if finished:
            break
        step += 1
    assert step > 10
    assert {"finished", "unfinished"} == set(states)


def test_a_folder_in_which_another_process_writes_is_refused(tmp_path, made):
    stage = tmp_path / f".unfinished.{os.getppid()}.part"
    stage.mkdir()
    with pytest.raises(OutputError, match=f"process {os.getppid()} is writing there"):
        claim_folder(tmp_path, made)
    assert stage.exists()


def test_a_message_names_the_file_and_not_the_temporary_one(tmp_path, made):
    def fail():
        with claim_folder(tmp_path / "out", made).writing() as part:
            raise OutputError(f"cannot write {part / 'result.json'}: No space left on device")

    with pytest.raises(OutputError) as caught:
        fail()
    assert str(caught.value) == (
        f"cannot write {tmp_path / 'out' / 'result.json'}: No space left on device"
    )


def test_the_manifest_cannot_lead_out_of_the_folder(tmp_path, made):
    write(tmp_path / "out", made, FIRST)
    (tmp_path / "precious").write_text("mine")
    file = tmp_path / "out" / NAME
    for name in ("../precious", str(tmp_path / "precious"), "figures/../../precious", ""):
        content = json.loads(file.read_text()) | {"files": [name]}
        file.write_text(json.dumps(content))
        with pytest.raises(OutputError, match="damaged"):
            claim_folder(tmp_path / "out", made)
    assert (tmp_path / "precious").exists()


def test_what_a_killed_run_left_aside_is_in_nobodys_way(tmp_path, made):
    """The verb `modes` gives folders names of the user's, so that any folder may be its own."""
    made = replace(made, verb="modes")
    write(tmp_path, made, {"modes.csv": "first"})
    stage = tmp_path / f".unfinished.{os.getpid()}.part"
    stage.mkdir()
    (stage / "modes.csv").write_text("half")
    write(tmp_path, made, {"modes.csv": "second"})
    assert results(tmp_path) == {"modes.csv": "second"}
    assert not stage.exists()
