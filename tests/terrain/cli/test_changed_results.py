"""Tables of a results folder that were cut or edited after they were written."""

import json
import shutil

import pytest
from click.testing import CliRunner

from odometry.errors import OutputError
from odometry.outputs.manifest import NAME, read_manifest
from odometry.outputs.output_folder import claim_folder
from odometry.outputs.provenance import Made
from odometry.outputs.written_tables import changes_of
from terrain.cli.verbs.evaluate import evaluate
from terrain.cli.verbs.export import export
from terrain.main_job import run_odometry
from terrain.results import write_run

MADE = Made("run", "terrain-odometry run RUN", {}, (), {})


@pytest.fixture(scope="module")
def results(curvy_run, tmp_path_factory):
    """A folder that `run` wrote."""
    out = tmp_path_factory.mktemp("written") / "results"
    write_run(run_odometry(curvy_run, terrain="sand"), claim_folder(out, MADE), [])
    return out


@pytest.fixture(params=["with sums", "of an older version"])
def copied(results, request, tmp_path):
    """A copy to be changed, also one whose manifest has no sums."""
    out = tmp_path / "results"
    shutil.copytree(results, out)
    if request.param != "with sums":
        content = json.loads((out / NAME).read_text())
        del content["sums"]
        (out / NAME).write_text(json.dumps(content))
    return out


def cut(file):
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(lines[: len(lines) // 3]))


def shifted(file):
    head, *rows = file.read_text().splitlines()
    cells = [row.split(",") for row in rows]
    moved = [",".join([t, f"{float(x) + 3:.9f}", *more]) for t, x, *more in cells]
    file.write_text("\n".join([head, *moved]) + "\n")


def answers(folder):
    """What `export` and `evaluate` say."""
    out = str(folder.parent / "exported")
    return (
        CliRunner().invoke(export, [str(folder), "--to", "tum", "--out", out]),
        CliRunner().invoke(evaluate, [str(folder)]),
    )


def test_nothing_is_said_of_what_was_written(copied):
    assert changes_of(copied) == changes_of(copied.parent / "none")
    assert [answer.stderr for answer in answers(copied)] == ["", ""]


@pytest.mark.parametrize("name", ["odometer.csv", "estimate.csv", "reference.csv"])
def test_lost_rows_are_an_error(copied, name):
    cut(copied / name)
    exported, evaluated = answers(copied)
    assert "rows are lost" in str(exported.exception)
    assert name in str(exported.exception)
    assert not (copied.parent / "exported").exists()
    assert evaluated.exit_code == 1
    assert "rows are lost" in evaluated.stdout


def test_an_edited_table_is_exported_with_a_warning(copied):
    shifted(copied / "odometer.csv")
    exported, evaluated = answers(copied)
    assert (exported.exit_code, evaluated.exit_code) == (0, 0)
    assert "odometer.csv" in exported.stderr
    assert "exported as it is now" in exported.stderr
    assert "the errors above are those of result.json" in evaluated.stderr


def test_an_edited_result_json_is_named(results, tmp_path):
    out = tmp_path / "results"
    shutil.copytree(results, out)
    text = (out / "result.json").read_text()
    (out / "result.json").write_text(text.replace('"horizon_m": 5.0', '"horizon_m": 50.0'))
    (edited,) = changes_of(out).edited
    assert "result.json is not as `run` wrote it" in edited


def test_a_table_that_was_deleted_to_save_room_is_no_change(results, tmp_path):
    out = tmp_path / "results"
    shutil.copytree(results, out)
    (out / "estimate.csv").unlink()
    assert not changes_of(out).edited
    assert answers(out)[1].exit_code == 0


@pytest.mark.parametrize("sums", [[], {"a.csv": {}}, {"result.json": {"sha256": 1, "lines": 2}}])
def test_damaged_sums_are_said(results, tmp_path, sums):
    content = json.loads((results / NAME).read_text()) | {"sums": sums}
    (tmp_path / NAME).write_text(json.dumps(content))
    with pytest.raises(OutputError, match="damaged"):
        read_manifest(tmp_path)
