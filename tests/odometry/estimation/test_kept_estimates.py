"""Estimates on disk are the estimates that were put there."""

import copy
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

import odometry
from odometry.estimation import kept_estimates
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.kept_estimates import KeptEstimates
from odometry.replays.estimates import Replay

CARRIED = {"watch": None, "recent": (), "refused": ()}  # kept of the last alone


@pytest.fixture(scope="module")
def estimates():
    """Of a run that changes its terrain twice, with an event in the middle."""
    run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    ekf = odometry.IcrEkf(run.robot.track_width)
    first, *frames = list(run.frames())[:600]
    found = [ekf.start(first, "a")]
    for k, frame in enumerate(frames):
        found.append(ekf.step(found[-1], frame, "b" if 100 < k < 300 else "a"))
    found[400] = replace(found[400], events=(FilterEvent("odd", 1.0, 2.0, "it was odd"),))
    return found


def same(one, other):
    """Whether all that is kept of an estimate is what it was."""
    first, second = (replace(each, **CARRIED, scale=one.scale) for each in (one, other))
    return equal(first, second)


def equal(one, other):
    """Whether two values are the same, with those that they are made of."""
    if is_dataclass(one):
        assert type(one) is type(other)
        return all(equal(getattr(one, of.name), getattr(other, of.name)) for of in fields(one))
    if isinstance(one, Mapping):
        return one.keys() == other.keys() and all(equal(one[key], other[key]) for key in one)
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(equal, one, other))
    if isinstance(one, np.ndarray | float):
        return np.array_equal(one, other, equal_nan=True)
    return one == other


@pytest.mark.parametrize("block", [7, 256, 1000])
def test_they_come_back(estimates, monkeypatch, block):
    monkeypatch.setattr(kept_estimates, "BLOCK", block)
    kept = KeptEstimates(estimates)
    assert len(kept) == len(estimates)
    assert all(map(same, kept, estimates))
    for place in (0, 5, 101, 102, 400, 401, -2):
        assert same(kept[place], estimates[place])
    assert kept[-1] is estimates[-1]
    assert all(map(same, kept[300:305], estimates[300:305]))
    np.testing.assert_array_equal(
        kept.numbers("covariance"), [each.covariance.ravel() for each in estimates]
    )


def test_a_place_beyond_the_end_is_an_error(estimates):
    with pytest.raises(IndexError):
        KeptEstimates(estimates)[len(estimates)]


def test_the_last_may_get_events_at_the_end(estimates):
    kept = KeptEstimates(estimates)
    event = FilterEvent("late", 1.0, 2.0, "it was late")
    kept.end_with(replace(estimates[-1], events=(event,)))
    assert [each.kind for each in Replay(kept).events] == ["odd", "late"]
    assert len(kept) == len(estimates)


def test_another_process_gets_a_copy(estimates):
    replay = Replay(KeptEstimates(estimates))
    assert len(replay.stamps_s) == len(estimates)
    there = copy.deepcopy(replay)  # by what `pickle` asks for
    np.testing.assert_array_equal(there.means, [each.mean for each in estimates])


def test_what_a_replay_tells_is_what_its_estimates_say(estimates):
    replay = Replay(KeptEstimates(estimates))
    assert replay.terrains == tuple(each.terrain for each in estimates)
    accepted = [each.innovation is not None and each.innovation.accepted for each in estimates]
    assert replay.accepted.tolist() == accepted
    assert replay.is_astride.tolist() == [each.crossing is not None for each in estimates]
    squared = [each.innovation.normalised_squared for each in estimates if each.innovation]
    np.testing.assert_array_equal(
        replay.innovations_squared[~np.isnan(replay.innovations_squared)], squared
    )
    np.testing.assert_array_equal(
        replay.pose_covariances, [each.covariance[:3, :3] for each in estimates]
    )
    np.testing.assert_array_equal(
        replay.sigmas, [np.sqrt(each.covariance.diagonal()) for each in estimates]
    )


def test_no_estimates():
    assert list(KeptEstimates()) == []
