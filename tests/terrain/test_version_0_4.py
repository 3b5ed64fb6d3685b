"""What version 0.4 wrote opens, and its folders may be written over by the same verb.

The files were made by commit cb1625b with `simulate`, `identify`, `gap`, `identify-modes`,
`modes`, `compare`, `train --preset chen2023` on the shipped patches, and `run`.
"""

import json
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from odometry.errors import OutputError
from odometry.modes.models.mode_set_file import read_mode_set
from odometry.outputs.output_file import claim_file, is_set_of
from odometry.outputs.output_folder import claim_folder
from odometry.outputs.provenance import Made
from odometry.parameters import read_parameters
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.model_file import is_model
from terrain.cli.verbs.evaluate import evaluate
from terrain.errors import ResultError
from terrain.results import read_errors

FILES = Path(__file__).parents[1] / "version_0_4"
FOLDERS = {"run": "result", "gap": "gap", "modes": "modes", "compare": "comparison"}


def made(verb):
    return Made(verb, "", {}, (), {})


def test_sets_and_models_open():
    for name in ("set.toml", "result/learned.toml", "gap/model.toml"):
        assert read_parameters(FILES / name).terrains
    assert read_mode_set(FILES / "modes.toml").names == ("asphalt", "grass")
    classes = TerrainClassifier.load(FILES / "terrain.model").classes_
    assert classes.tolist() == ["brick", "grass", "gravel"]


def test_evaluate_reads_its_result():
    answer = CliRunner().invoke(evaluate, [str(FILES / "result")])
    assert answer.exit_code == 0
    assert "odometer" in answer.output


@pytest.mark.parametrize("verb", FOLDERS)
@pytest.mark.parametrize("by", [*FOLDERS, "simulate", "demo"])
def test_a_folder_is_the_own_of_the_verb_that_wrote_it(tmp_path, verb, by):
    out = tmp_path / "out"
    shutil.copytree(FILES / FOLDERS[verb], out)
    (out / "notes.txt").write_text("mine")
    if by != verb:
        with pytest.raises(OutputError, match=f"`{by}` did not make it"):
            claim_folder(out, made(by))
        return
    with claim_folder(out, made(by)).writing() as part:
        (part / "report.html").write_text("new")
    names = {path.name for path in out.rglob("*")}
    assert names == {"notes.txt", "report.html", "terrain-odometry.json"}


def test_single_files_are_the_own_of_the_verb_that_wrote_them():
    claim_file(FILES / "set.toml", is_set_of("identify"), "identify")
    claim_file(FILES / "modes.toml", is_set_of("identify-modes"), "identify-modes")
    claim_file(FILES / "terrain.model", is_model, "train")
    for name, own in (
        ("modes.toml", is_set_of("identify")),
        ("set.toml", is_set_of("identify-modes")),
        ("result/learned.toml", is_set_of("identify")),
        ("set.toml", is_model),
    ):
        with pytest.raises(OutputError, match="is there already"):
            claim_file(FILES / name, own, "verb")


def test_a_newer_result_says_so(tmp_path):
    content = json.loads((FILES / "result" / "result.json").read_text())
    (tmp_path / "result.json").write_text(json.dumps(content | {"format": 2}))
    with pytest.raises(ResultError, match=r"made by a newer version .* \(format 2"):
        read_errors(tmp_path)
