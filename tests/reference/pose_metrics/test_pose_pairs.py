"""Pairs by hand, and against searches pose by pose that do without any cleverness."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from odometry.errors import ConfigError
from odometry.geometry import se3
from odometry.trajectory import SpatialTrajectory
from tests.reference.pose_metrics.pose_pairs import (
    all_frame_pairs,
    all_path_pairs,
    consecutive_frame_pairs,
    consecutive_path_pairs,
)


def along(steps_m):
    """A trajectory that rises straight up by the given steps."""
    path = np.append(0.0, np.cumsum(steps_m))[:, None]
    poses = se3.pose(path * np.array([0, 0, 1.0]), np.eye(3))
    return SpatialTrajectory(np.arange(len(path), dtype=float), poses)


EIGHT = along(np.ones(7))
UNEVEN = along([1, 1, 3, 0.5, 0.5, 0, 2])  # path: 0 1 2 5 5.5 6 6 8


def test_frames_that_follow_one_another():
    assert consecutive_frame_pairs(EIGHT, 3).tolist() == [[0, 3], [3, 6]]
    assert consecutive_frame_pairs(EIGHT, 7).tolist() == [[0, 7]]
    assert consecutive_frame_pairs(EIGHT, 8).shape == (0, 2)


def test_frames_from_every_pose():
    assert all_frame_pairs(EIGHT, 5).tolist() == [[0, 5], [1, 6], [2, 7]]
    assert all_frame_pairs(EIGHT, 8).shape == (0, 2)


def test_paths_that_follow_one_another():
    """What goes beyond the length is not carried over to the next pair."""
    assert consecutive_path_pairs(UNEVEN, 1.5).tolist() == [[0, 2], [2, 3], [3, 7]]
    assert consecutive_path_pairs(EIGHT, 2).tolist() == [[0, 2], [2, 4], [4, 6]]
    assert consecutive_path_pairs(UNEVEN, 9).shape == (0, 2)


def test_paths_from_every_pose():
    """The nearest end, the first of equals; 1.5 m is too far from 1 m for the tolerance."""
    assert all_path_pairs(UNEVEN, 1, 0.1).tolist() == [[0, 1], [1, 2], [3, 5]]
    assert all_path_pairs(UNEVEN, 2, 0.3).tolist() == [[0, 2], [4, 7], [5, 7], [6, 7]]
    assert all_path_pairs(along([]), 1).shape == (0, 2)


lengths = st.lists(st.sampled_from([0.0, 0.125, 0.25, 1.0, 1.75]), min_size=1, max_size=12)


@given(lengths, st.sampled_from([0.125, 0.3, 0.5, 1.0, 2.5]), st.sampled_from([0.1, 0.5, 2.0]))
def test_paths_from_every_pose_against_a_search(steps_m, path_m, tolerance):
    """Standing still, ties and lengths beyond the end included."""
    trajectory = along(steps_m)
    lengths_m = np.linalg.norm(np.diff(trajectory.positions_m, axis=0), axis=1)
    path = np.append(0.0, np.cumsum(lengths_m))
    expected = []
    for start in range(len(path) - 1):
        misses = np.abs(path[start + 1 :] - path[start] - path_m)
        if misses.min() <= tolerance * path_m:
            expected.append([start, start + 1 + int(np.argmin(misses))])
    assert all_path_pairs(trajectory, path_m, tolerance).tolist() == expected


@pytest.mark.parametrize(
    "pairs", [consecutive_frame_pairs, all_frame_pairs, consecutive_path_pairs, all_path_pairs]
)
def test_a_length_of_nothing_is_an_error(pairs):
    with pytest.raises(ConfigError, match="= 0, expected"):
        pairs(EIGHT, 0)
