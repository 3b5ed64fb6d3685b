"""Inputs averaged over short steps: what they keep, and how little a path changes."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.models.inputs import Inputs
from odometry.tables.table import Table
from odometry.windows.dense.averaged import LONGEST_S, averaged, averaged_windows, averaging_steps
from odometry.windows.dense.dense import dense_windows_of
from odometry.windows.travel.motion import level_path


@pytest.fixture
def inputs(rng):
    """At 50 Hz and uneven: speeds that change by up to 2 m/s^2, and two terrains."""
    time_s = np.cumsum(rng.uniform(0.01, 0.03, 500))
    speeds = np.cumsum(rng.uniform(-0.04, 0.04, (500, 2)), axis=0)
    terrain = np.where(np.arange(500) < 217, "sand", "ice").astype(object)
    return Inputs(speeds, time_s=time_s, terrain=terrain)


def test_steps_begin_where_they_must_and_are_short(inputs):
    must = np.array([3, 40, 41, 350])
    first = averaging_steps(inputs, must)
    assert {0, 217, 499, *must} <= set(first)
    longest_s = np.diff(inputs.time_s).max()
    assert np.diff(inputs.time_s[first]).max() <= LONGEST_S + longest_s


def test_travel_is_kept_and_labels_are_not_mixed(inputs):
    steps_s = np.append(np.diff(inputs.time_s), 0.0)
    first = averaging_steps(inputs, np.array([100]))
    means = averaged(inputs, steps_s, first)
    longer_s = np.append(np.diff(inputs.time_s[first]), 0.0)
    travelled = (inputs.tread_speeds_m_s * steps_s[:, None]).sum(axis=0)
    kept = (means.tread_speeds_m_s * longer_s[:, None]).sum(axis=0)
    np.testing.assert_allclose(kept, travelled, atol=1e-5)
    np.testing.assert_array_equal(means.terrain, inputs.terrain[first])
    assert means.shape == means.time_s.shape == first.shape


def test_a_path_of_ten_seconds_changes_by_less_than_a_millimetre(inputs):
    def path(of, steps_s):
        forward, turn = of.tread_speeds_m_s.mean(axis=1), np.diff(of.tread_speeds_m_s)[:, 0]
        return level_path(np.column_stack([forward, 0 * turn, turn]), steps_s, of)

    steps_s = np.append(np.diff(inputs.time_s), 0.0)
    first = averaging_steps(inputs, np.array([100]))
    means = averaged(inputs, steps_s, first)
    coarse = path(means, np.append(np.diff(inputs.time_s[first]), 0.0))
    np.testing.assert_allclose(coarse[-1], path(inputs, steps_s)[-1], atol=1e-3)


@pytest.mark.parametrize("rows", [2, 5, 10])
def test_no_mean_spans_two_speeds_that_were_recorded_rarely(make_scene, rows):
    """Speeds each 0.1 s and more, poses between them: a delay of what is smeared is no delay."""
    run = make_scene(5, duration_s=60.0).run
    kept = {name: column[::rows] for name, column in run.odometry.columns.items()}
    kept["t"] = kept["t"] + 0.03
    odometry = Table(run.odometry.file, kept, run.odometry.lines[::rows])
    scene = averaged_windows(dense_windows_of(replace(run, odometry=odometry), 2.0))
    means = scene.inputs.tread_speeds_m_s[:, 0]
    off = np.abs(means[:, None] - kept["v_left"]).min(axis=1)
    assert off.max() < 1e-9
