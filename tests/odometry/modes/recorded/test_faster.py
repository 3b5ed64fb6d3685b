"""Treads that run faster than in any run of identification: traction modes learn nothing there."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.follow.track import follow_modes
from odometry.modes.recorded.faster import MOST_FASTER, faster_than, with_faster_spans
from tests.odometry.modes.mode_examples import run_of, traction_set

STAMPS_S = np.arange(8.0)
SPEEDS_M_S = np.array([0.0, 1.0, 2.0, -2.0, 1.0, 1.0, 2.0, 2.0])
NO_GAPS_S = np.empty((0, 2))


def spans(gaps_s, fastest_m_s=1.0):
    both = np.column_stack([SPEEDS_M_S, np.zeros(8)])
    return with_faster_spans(np.array(gaps_s), STAMPS_S, both, fastest_m_s).tolist()


def test_the_limit_is_beyond_the_fastest_run():
    treads = np.array([[MOST_FASTER - 0.01, 0.0], [0.0, -MOST_FASTER - 0.01]])
    assert faster_than(treads, 1.0).tolist() == [False, True]


def test_spans_last_until_the_treads_are_slower_again():
    assert spans(NO_GAPS_S) == [[2.0, 4.0], [6.0, 7.0]]
    assert spans(NO_GAPS_S, np.inf) == []


@pytest.mark.parametrize(
    ("gap_s", "expected"),
    [
        ([0.0, 1.0], [[0.0, 1.0], [2.0, 4.0], [6.0, 7.0]]),
        ([3.0, 5.0], [[2.0, 5.0], [6.0, 7.0]]),
        ([4.0, 6.0], [[2.0, 7.0]]),
    ],
)
def test_gaps_and_spans_are_in_order_and_apart(gap_s, expected):
    assert spans([gap_s]) == expected


def followed(fastest_m_s, pose_until_s=np.inf):
    """Weaves by the second mode, with treads at up to 0.8 m/s."""
    mode_set = traction_set((0.5, 0.8))
    run = run_of(0.8, track_width=0.5, size=1000)
    kept = run.pose.stamps_s <= pose_until_s
    pose = replace(run.pose, columns={n: c[kept] for n, c in run.pose.columns.items()})
    modes = replace(mode_set.modes, fastest_m_s=fastest_m_s)
    return follow_modes(replace(run, pose=pose), replace(mode_set, modes=modes))


@pytest.mark.slow
def test_motion_at_speeds_far_above_is_no_evidence():
    assert followed(0.8).probabilities[-1, 1] > 0.99
    np.testing.assert_allclose(followed(0.2).probabilities[100:, 1], 0.5, atol=0.01)


def test_a_span_that_no_pose_follows_lasts_to_the_end():
    """The filter cannot begin anew without a pose after it."""
    track = followed(0.6, pose_until_s=14.0)
    assert np.isfinite(track.means).all()
    assert track.probabilities[-1].max() < 0.99
