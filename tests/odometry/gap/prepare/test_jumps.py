"""Steps of the reference that no robot makes, and those that a slipping robot may make."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.measurement.reference_outliers import (
    FrozenPoses,
    JumpingPoses,
    ReferenceOutliers,
)
from odometry.gap.config import GapConfig
from odometry.gap.prepare.jumps import jumps
from odometry.gap.prepare.outliers import closes, outliers_of
from odometry.gap.prepare.scenes import cleaned_runs, without_outliers
from odometry.gap.prepare.statistic import squared_errors
from odometry.windows.dense.dense import dense_windows_of

CONFIG = GapConfig()
AT = np.array([100, 250, 333, 520, 700])


@pytest.fixture(scope="module")
def plain(make_scene):
    return make_scene(31, lambda _, twist: twist)


@pytest.fixture(scope="module")
def jumping(plain):
    """Each time another 1.5 m to one side, for good."""
    run = plain.run
    moved = 1.5 * np.searchsorted(AT, np.arange(len(run.pose)), side="right")
    pose = replace(run.pose, columns={**run.pose.columns, "y": run.pose["y"] + moved})
    return dense_windows_of(replace(run, pose=pose), CONFIG.horizon_s)


def test_jumps_that_stay_are_found_each(jumping, plain, known):
    found = outliers_of([jumping], [], [plain], known, CONFIG)
    assert isinstance(found.named.effect, JumpingPoses)
    assert len(found.measured[0].sigmas) == len(AT)
    assert found.measured[0].off[AT].all()
    assert found.low[0] < found.named.values[0] < found.high[0]
    assert found.named.values[1] == pytest.approx(1.5, rel=0.1)


def test_windows_end_before_a_jump_and_begin_after_it(jumping, plain, known):
    found = outliers_of([jumping], [jumping], [plain], known, CONFIG)
    (measured,), (held,) = cleaned_runs([jumping.run], [jumping.run], found)
    assert len(measured.pose) == len(jumping.run.pose)
    cut = dense_windows_of(held, CONFIG.horizon_s)
    first, last = cut.windows[:, 0], cut.windows[:, -1]
    assert not ((first[:, None] < AT) & (last[:, None] >= AT)).any()
    assert closes([jumping], [cut], known.base, CONFIG)


def test_jumps_are_left_out_where_a_single_one_is_held_out(jumping, plain, known):
    """Each is one by itself: that a model errs there is no chance of the stretch."""
    scene = jumping.numbered(0)
    numbers = [np.array([int(jumping.pose_s[AT[0]] // CONFIG.part_s)])]
    raw, (fitted, held), found = without_outliers(
        ([jumping.run], []), ([scene], []), numbers, ([plain], known), CONFIG
    )
    assert isinstance(found.named.effect, JumpingPoses)
    limit_m2 = 1.0
    for cut in (*fitted, *held):
        assert np.max(squared_errors(known.base, (), cut)) < limit_m2
    errors_m2 = [squared_errors(known.base, (), whole) for of in raw for whole in of]
    assert np.concatenate(errors_m2).max() > limit_m2


def test_a_chain_that_there_was_stays_cut(jumping, plain, known):
    pose = jumping.run.pose
    half = (np.arange(len(pose)) > 400).astype(float)
    run = replace(jumping.run, pose=replace(pose, columns={**pose.columns, "window": half}))
    found = outliers_of([jumping], [jumping], [plain], known, CONFIG)
    (measured,), _ = cleaned_runs([run], [run], found)
    windows = measured.pose["window"]
    assert windows[400] != windows[401]
    assert (np.diff(windows) >= 0).all()


def slowly(run, change, single):
    """Windows of every tenth pose, of which the single ones are changed."""
    pose = run.pose.rows(np.arange(0, len(run.pose), 10))
    columns = {name: column.copy() for name, column in pose.columns.items()}
    change(columns, single)
    return dense_windows_of(replace(run, pose=replace(pose, columns=columns)), 4.0)


def repeated(columns, single):
    for name in ("x", "y", "yaw"):
        columns[name][single] = columns[name][single - 1]


def aside(columns, single):
    columns["y"][single] += 1.5


@pytest.mark.parametrize(
    ("change", "single", "kind"),
    [(aside, (8, 37, 66), ReferenceOutliers), (repeated, (8, 21, 37, 52, 66), FrozenPoses)],
)
def test_steps_to_single_poses_and_back_are_these_poses(plain, known, change, single, kind):
    """As single poses they may be chance beside so short a calibration."""
    places = np.array(single)
    off = slowly(plain.run, change, places)
    usual = slowly(plain.run, change, places[:0])
    found = outliers_of([off], [off], [usual], known, CONFIG)
    assert type(found.named.effect) is kind
    np.testing.assert_array_equal(np.flatnonzero(found.measured[0].off), places)


def test_few_and_as_many_as_usual_are_no_finding(jumping, known):
    assert outliers_of([jumping], [], [jumping], known, CONFIG) is None


def test_a_robot_that_slips_stays_behind_and_does_not_jump(make_scene, known):
    def stuck(inputs, twist):
        return twist * (inputs["t"] % 7 > 2)[:, None]

    assert not jumps(make_scene(32, stuck), known, CONFIG).off.any()


@pytest.mark.parametrize("rest_s", [0.8, 4.0])
def test_an_encoder_that_drops_out_is_no_jump_of_the_reference(plain, known, rest_s):
    odometry = plain.run.odometry
    t_s = odometry["t"] - odometry["t"][0]
    gone = (t_s % 15 > 5) & (t_s % 15 < 5 + rest_s)
    columns = {**odometry.columns, "v_left": np.where(gone, 0.0, odometry["v_left"])}
    run = replace(plain.run, odometry=replace(odometry, columns=columns))
    assert not jumps(dense_windows_of(run, CONFIG.horizon_s), known, CONFIG).off.any()


def test_a_robot_that_rolls_on_after_its_commands_does_not_jump(plain, known):
    """Commands of a drive that changes its speed slowly end before the robot does."""
    odometry = plain.run.odometry
    t_s = odometry["t"] - odometry["t"][0]
    ended = t_s % 10 > 7
    columns = {
        **odometry.columns,
        **{name: np.where(ended, 0.0, odometry[name]) for name in ("v_left", "v_right")},
    }
    run = replace(plain.run, odometry=replace(odometry, columns=columns))
    assert not jumps(dense_windows_of(run, CONFIG.horizon_s), known, CONFIG).off.any()
