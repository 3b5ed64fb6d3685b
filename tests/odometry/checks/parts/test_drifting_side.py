"""One tread whose scale changes little by little, and what is none."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.parts.drifting_side import drifting_side
from odometry.checks.recording import check_recording
from tests.odometry.checks.answers import warnings
from tests.odometry.checks.drives import drive, varied
from tests.odometry.checks.faulty import SENSORS, treads


def course(run):
    return np.linspace(0, 1, len(run.odometry["t"]))


def wears(run, side, to):
    scales = np.ones((2, len(run.odometry["t"])))
    scales[side] = to ** course(run)
    return treads(run, lambda *both: scales * both)


@pytest.mark.parametrize(
    ("sensors", "side", "to"), list(zip(SENSORS, (0, 1, 1), (0.4, 2.0, 0.7), strict=True))
)
def test_the_tread_and_its_scale_are_named(sensors, side, to):
    wrong = SENSORS[sensors](wears(varied(), side, to))
    found = check_recording(wrong).findings[0]
    assert found.name == "tread_scale_drifts"
    assert f"The scale of {('v_left', 'v_right')[side]} changes" in found.cause
    reads = drifting_side(Evidence(wrong)).reads
    assert reads[[0, -1]] == pytest.approx([1, to], rel=0.15)
    assert warnings(found.mend(wrong)) == []


def test_a_scale_that_holds_in_the_middle_only_is_followed():
    run = varied()
    middle = np.exp(-(((course(run) - 0.5) / 0.2) ** 2))
    found = drifting_side(Evidence(treads(run, lambda left, right: (left * 0.5**middle, right))))
    assert found.side == 0
    assert found.reads.min() == pytest.approx(0.55, abs=0.1)
    assert found.reads[[0, -1]] == pytest.approx([1, 1], abs=0.1)


@pytest.mark.parametrize("sensors", SENSORS)
@pytest.mark.parametrize(
    "change",
    [
        lambda _, left, right: (left, right),
        lambda share, left, right: (left, right * 1.1**share),
        lambda share, left, right: (left * 0.6**share, right * 0.6**share),
        lambda share, left, right: (
            left + 0.3 * share * (left - right),
            right + 0.3 * share * (right - left),
        ),
        lambda share, left, right: (left + 0.2 * share, right),
        lambda _, left, right: (left, 0.6 * right),
    ],
    ids=["as it is", "a side slips", "both", "a width", "an offset", "one scale"],
)
def test_what_is_no_scale_of_one_tread_that_changes_is_not_named(sensors, change):
    run = varied()
    changed = treads(run, lambda *both: change(course(run), *both))
    assert drifting_side(Evidence(SENSORS[sensors](changed))) is None


def test_a_way_that_does_not_change_alike_is_no_tread():
    """Turns as of a tread that wears, on a path that goes with both treads as they read."""
    at_s = 0.05 * np.arange(4000)
    turn, speed = 0.4 * np.sin(at_s / 7) + 0.3 * np.sin(at_s / 2.3), 0.8 + 0.3 * np.sin(at_s / 5)
    worn = wears(drive(speed, turn), 1, 0.5)
    assert drifting_side(Evidence(worn)) is not None
    mean = 0.93 * worn.odometry.stack("v_left", "v_right").mean(axis=1)
    assert drifting_side(Evidence(replace(worn, pose=drive(mean, turn).pose))) is None
