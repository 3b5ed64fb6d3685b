"""Positions that were rounded in a part of a recording."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Level
from odometry.checks.poses.coarse_part import coarse_part
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import drive, pausing, varied, winding
from tests.odometry.checks.faulty import positions

SPANS = [(71.3, np.inf), (-np.inf, 88.8), (63.2, 131.7)]


def rounded(run, step_m, span_s=(-np.inf, np.inf)):
    part = (run.pose["t"] >= span_s[0]) & (run.pose["t"] < span_s[1])
    return positions(
        run, lambda *both: [np.where(part, np.round(c / step_m) * step_m, c) for c in both]
    )


@pytest.mark.parametrize(("span_s", "step_m"), list(zip(SPANS, (0.05, 0.3, 1.0), strict=True)))
def test_a_part_in_steps_is_named_with_its_moments(step_m, span_s):
    (found,) = check_recording(rounded(varied(), step_m, span_s)).at(Level.WARNING)
    assert found.name == "coarse_positions"
    assert f"positions come in steps of {step_m:g} m, and elsewhere they do not" in found.seen
    assert found.spans_s[0] == pytest.approx(np.clip(span_s, 0, 199.95), abs=0.5)


@pytest.mark.parametrize("make", [varied, winding, pausing])
def test_positions_that_were_not_rounded_have_no_part(make):
    assert coarse_part(Evidence(make())) is None


def test_a_whole_recording_in_steps_is_no_part():
    run = rounded(varied(), 0.3)
    assert coarse_part(Evidence(run)) is None
    (found,) = check_recording(run).at(Level.WARNING)
    assert found.seen == "positions come in steps of 0.3 m"


def test_millimetres_of_a_log_are_no_part():
    assert coarse_part(Evidence(rounded(varied(), 0.001))) is None


def test_steady_speeds_along_both_axes_are_no_step():
    """Without noise each change is the same: one size of it is no grid."""
    at_s = 0.05 * np.arange(2400)
    turn = np.where(at_s < 60, 0.4 * np.sin(at_s / 3), 0.0)
    turn[:1200] -= turn[:1200].mean()
    turn[1800] = np.pi / 2 / 0.05
    speed = np.where(at_s < 60, 0.8 + 0.1 * np.sin(at_s), 1.0)
    run = drive(speed, turn, sigma_m=0.0, yaw_sigma=0.0)
    changes = np.diff(np.stack([run.pose["x"], run.pose["y"]]))
    assert (np.abs(changes[:, -580:] - 0.1) < 1e-9).sum(axis=1).min() > 250
    assert coarse_part(Evidence(run)) is None
