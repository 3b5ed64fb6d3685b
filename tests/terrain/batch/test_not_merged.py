"""Why a batch has no learned.toml."""

import pytest

from odometry.parameters import ParameterSet
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
