import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from odometry.feel.labels.felt import FeelConfig
from odometry.feel.labels.files import sentences, write_feel
from odometry.feel.labels.follow import follow_feel
from odometry.feel.model_file import (
    FeelFileError,
    is_feel_model,
    read_feel_model,
    write_feel_model,
)
from odometry.installed import shipped_data
from odometry.io.csv_table import read_csv_table
from odometry.recording.run import Run
from odometry.report.feel_page import write_feel_report
from tests.odometry.feel.feel_drives import drive

# of the shipped run since 0.29; on the one before it what 0.10 itself had given held to 1e-6
FIRST_ROWS, FIRST_GIVEN = [0, 10, 30, 50], [0.43957133, 0.44865967, 0.45283565, 0.46888647]


def test_a_model_comes_back_and_answers_alike(model, tmp_path):
    write_feel_model(tmp_path / "a.feel", model)
    again = read_feel_model(tmp_path / "a.feel")
    run = drive("snow", 40)
    np.testing.assert_array_equal(
        follow_feel(run, model).lasting_probabilities, follow_feel(run, again).lasting_probabilities
    )
    assert again.report == json.loads(json.dumps(model.report))
    write_feel_model(tmp_path / "b.feel", again)
    assert (tmp_path / "a.feel").read_bytes() == (tmp_path / "b.feel").read_bytes()


def test_a_model_of_the_first_version_is_read_and_is_modest(tmp_path):
    """Written by 0.10, which knew no distance of the mean: its answers are those that it gave."""
    old = read_feel_model(Path(__file__).parent / "version_0_10.feel")
    assert not any(of.any() for of in old.strangeness.weights.values())
    assert old.members.logistic is None
    run = Run.read(shipped_data() / "runs" / "demo")
    felt = follow_feel(run, old)
    np.testing.assert_allclose(felt.unknown, 0.1)
    np.testing.assert_allclose(felt.probabilities.sum(axis=1), 0.9)
    np.testing.assert_allclose(felt.probabilities[FIRST_ROWS, 0], FIRST_GIVEN, atol=1e-6)
    assert any("older version" in line for line in sentences(felt))
    write_feel_model(tmp_path / "again.feel", old)
    again = follow_feel(run, read_feel_model(tmp_path / "again.feel"))
    np.testing.assert_array_equal(again.lasting_probabilities, felt.lasting_probabilities)


def test_the_shipped_model_is_of_this_version():
    model = read_feel_model(shipped_data() / "feel" / "demo.feel")
    run = Run.read(shipped_data() / "runs" / "demo")
    assert model.members.logistic is not None
    assert not any("older version" in one for one in sentences(follow_feel(run, model)))


def test_damage_is_reported(model, tmp_path):
    write_feel_model(tmp_path / "a.feel", model)
    data = bytearray((tmp_path / "a.feel").read_bytes())
    data[len(data) // 2] ^= 1
    (tmp_path / "b.feel").write_bytes(data)
    assert is_feel_model(tmp_path / "a.feel")
    assert not is_feel_model(tmp_path / "b.feel")
    with zipfile.ZipFile(tmp_path / "c.feel", "w") as archive:
        archive.writestr("x", "y")
    for name, match in (("b", "checksum|cannot be read"), ("c", "not a model of `identify-feel`")):
        with pytest.raises(FeelFileError, match=match):
            read_feel_model(tmp_path / f"{name}.feel")


def test_what_was_felt_is_written_and_shown(model, tmp_path):
    felt = follow_feel(drive("snow", 41), model, FeelConfig(stretch_s=5.0))
    write_feel(felt, tmp_path)
    write_feel_report(felt, tmp_path)
    table = read_csv_table(tmp_path / "feel.csv", ("t", "label", "probability_snow"))
    assert len(table) == len(felt.windows)
    columns = [table[name] for name in table.columns if name.startswith("probability_")]
    np.testing.assert_allclose(np.sum(columns, axis=0), 1.0, atol=1e-6)
    result = json.loads((tmp_path / "result.json").read_text())
    assert result["run_probabilities"]["snow"] > 0.8
    assert result["balanced_accuracy"]["stretch"] > 0.8
    page = (tmp_path / "report.html").read_text()
    assert "snow" in page
    assert "<img" in page


def test_probabilities_of_a_stretch_are_of_its_windows_alone(model):
    run = drive("snow", 42)
    felt = follow_feel(run, model, FeelConfig(stretch_s=2.0))
    np.testing.assert_allclose(felt.lasting_probabilities, felt.probabilities, atol=1e-12)
