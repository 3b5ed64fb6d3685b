"""What a batch does not merge, and why it has no learned.toml."""

import numpy as np
import pytest

from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from terrain.batch.row import Row, merge

ROBOT = ("robot", 0.5)
DONE = Row("a", "a", robot=ROBOT)
MISLED = Row("b", "b", robot=ROBOT, flags=("units",))
FAILED = Row("c", "c", error="no such folder")
WIDE = Row("d", "d", robot=("robot", 0.8))


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        ([DONE, FAILED], "no run changed the parameters of a terrain"),
        ([DONE, MISLED], "no run of the others changed the parameters of a terrain"),
        ([MISLED], "none was merged"),
        ([DONE, WIDE], "none was merged"),
        ([FAILED], "no run was finished"),
    ],
)
def test_it_is_said_why_there_is_none(tmp_path, rows, why):
    sentences = merge(tmp_path, rows, ParameterSet()).sentences
    assert sentences[-1] == f"No learned.toml is written: {why}"
    assert sum("learned.toml" in sentence for sentence in sentences) == 1


def test_a_copy_of_a_run_is_merged_once(tmp_path):
    one, copy, other = (
        Row(name, name, robot=ROBOT, sha256=sha256)
        for name, sha256 in (("a", "11"), ("b", "11"), ("c", "22"))
    )
    for row in (one, copy, other):
        (tmp_path / row.name).mkdir()
        table = TerrainParameters(
            "icr",
            {"y_left": 0.4, "y_right": -0.4, "x_icr": 0.0, "alpha_left": 1.0, "alpha_right": 1.0},
            ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right"),
            1e-4 * np.eye(5),
        )
        write_parameters(tmp_path / row.name / "learned.toml", ParameterSet({"mud": table}))
    learned = merge(tmp_path, [one, copy, other], ParameterSet())
    assert learned.terrains["mud"].runs == ("a", "c")
    assert "Not merged, because it is a copy of another run: b (of a)" in learned.sentences
