"""Positions whose scale drifts, and what only looks like it."""

from dataclasses import replace

import numpy as np

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from tests.odometry.checks.drives import PERIOD_S, drive, winding
from tests.odometry.checks.faulty import positions, put, treads


def shares(count):
    return np.linspace(0.0, 1.0, count)


def drifting(run, last):
    """The steps of the map times one at first and `last` at last."""
    factor = 1 + (last - 1) * shares(len(run.pose))[1:]

    def scaled(x, y):
        return tuple(np.append(0.0, np.cumsum(factor * np.diff(values))) for values in (x, y))

    return positions(run, scaled)


def slipping(run, along, across):
    """Treads that read more by these factors at last: along the way, and in turns."""
    rises = shares(len(run.odometry))

    def change(left, right):
        mean = (left + right) / 2 * (1 + (along - 1) * rises)
        half = (right - left) / 2 * (1 + (across - 1) * rises)
        return mean - half, mean + half

    return treads(run, change)


def named(run):
    return {finding.name: finding for finding in check_recording(run).findings}


def test_a_map_whose_scale_drifts_may_be_treads_that_slip_and_turns_keep_their_factor():
    for last, slip in ((0.8, "more and more"), (1.2, "less and less")):
        found = named(drifting(winding(), last))["scale_drifts"]
        assert found.level is Level.WARNING
        assert found.cause.startswith("Either the scale of the map drifts")
        assert "or differs between its places" in found.cause
        assert f"slip {slip} along" in found.cause
        assert "or the scale of the tread speeds" not in found.cause
        assert "turns do not change alike" in found.seen


def test_a_drive_that_goes_on_over_the_map_does_not_tell_time_from_place():
    at_s = PERIOD_S * np.arange(2400)
    run = drive(1 + 0.3 * np.sin(at_s / 7), 0.5 * np.sin(at_s / 3))
    (found,) = named(drifting(run, 0.7)).values()
    assert found.name == "scale_drifts"
    assert " at small " in found.seen


def test_treads_that_slip_along_alone_have_the_same_words():
    assert set(named(slipping(winding(), 1.25, 1.0))) == {"scale_drifts"}


def test_a_drive_that_turns_for_a_while_says_that_treads_may_drift_as_well():
    at_s = PERIOD_S * np.arange(2400)
    turns = np.where(abs(at_s - 60) < 15, 0.5 * np.sin(at_s / 2), 0.0)
    run = drive(np.full(2400, 0.8), turns)
    found = named(drifting(run, 0.8))["scale_drifts"]
    assert "or the scale of the tread speeds drifts" in found.cause
    assert "turns do not say" in found.seen


def test_what_changes_turns_as_well_is_no_map():
    assert "scale_drifts" not in named(slipping(winding(), 1.2, 1.2))
    assert "scale_drifts" not in named(slipping(winding(), 1.15, 1.4))


def test_small_and_constant_changes_are_none():
    assert named(drifting(winding(), 0.95)) == {}
    assert "scale_drifts" not in named(positions(winding(), lambda x, y: (0.8 * x, 0.8 * y)))


def test_parts_that_differ_to_and_fro_are_no_drift():
    """A line through them rises by a fifth, with half of that as its standard deviation."""
    run = winding()
    factors = np.repeat([1.0, 1.2, 0.9, 1.25, 0.95, 1.3, 1.05, 1.3], len(run.odometry) // 8)

    def change(left, right):
        more = (factors - 1) * (left + right) / 2
        return left + more, right + more

    assert "scale_drifts" not in named(treads(run, change))


def test_another_disagreement_comes_first():
    run = drifting(winding(), 0.8)
    found = named(put(run, "pose", yaw=run.pose["yaw"] + 0.4 * np.sin(run.pose["t"] / 15)))
    assert "scale_drifts" not in found
    assert found


def test_another_terrain_from_the_middle_on_is_a_step_and_no_drift():
    """Over a quarter of the way, as where the robot drives along an edge."""
    run = winding()
    more = 1 + 0.25 * np.clip((shares(len(run.odometry)) - 0.375) / 0.25, 0.0, 1.0)

    def slips_along(left, right):
        mean, half = more * (left + right) / 2, (right - left) / 2
        return mean - half, mean + half

    assert "scale_drifts" not in named(treads(run, slips_along))


def test_chords_of_tighter_and_tighter_turns_are_no_drift():
    at_s = PERIOD_S * np.arange(4800)
    turn = (0.2 + 1.3 * shares(4800)) * np.sign(np.sin(at_s / 3))
    run = drive(0.7 + 0.2 * np.sin(at_s / 7), turn)
    few = replace(run, pose=run.pose.rows(slice(None, None, 20)))
    assert "scale_drifts" not in named(few)
