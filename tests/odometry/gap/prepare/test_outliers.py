"""Single poses that are far off are found, and nothing that lasts is taken for one."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.prepare.frozen import frozen, frozen_steps, isolated
from odometry.gap.prepare.outliers import closes, outliers_of
from odometry.gap.prepare.scenes import cleaned_runs, without_outliers
from odometry.windows.dense.dense import dense_windows_of

CONFIG = GapConfig()
OFF = np.arange(20, 780, 37)  # in some windows the last pose, in others one between


def same(_, twist):
    return twist


def with_poses(scene, change):
    run = scene.run
    x, y = change(run.pose["x"], run.pose["y"])
    pose = replace(run.pose, columns={**run.pose.columns, "x": x, "y": y})
    return dense_windows_of(replace(run, pose=pose), CONFIG.horizon_s)


@pytest.fixture(scope="module")
def plain(make_scene):
    return make_scene(31, same)


@pytest.fixture(scope="module")
def jumping(plain):
    def change(x, y):
        x, y = x.copy(), y.copy()
        x[OFF] += 0.5
        y[OFF[::2]] -= 0.8
        return x, y

    return with_poses(plain, change)


def test_jumps_there_and_back_are_found_each(jumping, plain, known):
    found = outliers_of([jumping], [jumping], [plain], known, CONFIG)
    stamps_s = jumping.run.pose.stamps_s[OFF] - jumping.run.odometry.stamps_s[0]
    np.testing.assert_allclose(found.named.effect.stamps_s[0], stamps_s)
    assert found.named.effect.of_reference
    share = len(OFF) / len(jumping.pose_s)
    assert found.named.values[0] == pytest.approx(share)
    assert found.low[0] < share < found.high[0]
    assert found.named.values[1] == pytest.approx(np.sqrt(0.25 + 0.32), abs=0.03)
    assert found.evidence > CONFIG.least_evidence


def test_without_them_the_gap_is_that_of_noise(jumping, plain, known):
    found = outliers_of([jumping], [jumping], [plain], known, CONFIG)
    (measured,), (held,) = cleaned_runs([jumping.run], [jumping.run], found)
    assert len(measured.pose) == len(jumping.run.pose) - len(OFF)
    cleaned = dense_windows_of(held, CONFIG.horizon_s)
    assert closes([jumping], [cleaned], known.base, CONFIG)
    assert not closes([plain], [plain], known.base, CONFIG)


def test_what_the_calibration_has_as_well_is_no_finding(jumping, known):
    assert outliers_of([jumping], [jumping], [jumping], known, CONFIG) is None


def test_the_next_place_of_a_grid_is_no_outlier(jumping, known):
    assert isolated(jumping, known, CONFIG).off.sum() == len(OFF)
    assert not isolated(replace(jumping, rounded_m=0.8), known, CONFIG).off.any()


@pytest.mark.parametrize(
    "change",
    [
        lambda x, y: (x + np.where(np.arange(len(x)) > 300, 1.0, 0.0), y),
        lambda x, y: (1.2 * x, y),
        lambda x, y: (x + 0.5 * np.sin(np.arange(len(x)) / 8), y),
        lambda x, y: (np.round(x / 0.3) * 0.3, np.round(y / 0.3) * 0.3),
    ],
    ids=["a jump that stays", "another scale", "a swing", "a grid"],
)
def test_what_lasts_is_none(plain, known, change):
    scene = with_poses(plain, change)
    assert outliers_of([scene], [scene], [plain], known, CONFIG) is None


def test_slip_is_none(make_scene, known):
    def slipping(columns, twist):
        gone = (columns["t"] % 11.0) < 1.5
        return np.where(gone[:, None], 0.4, 1.0) * twist

    assert isolated(make_scene(32, slipping), known, CONFIG).off.sum() <= 1


@pytest.mark.parametrize("delay_s", [0.2, 0.33])
def test_short_commands_of_which_treads_are_late_are_none(plain, known, delay_s):
    """Exact poses of a robot that follows short commands late, and one that jumps."""
    run = plain.run
    t = run.odometry.stamps_s
    pulses = np.where((t - t[0]) % 8.0 < 0.2, 0.7, 0.1)
    odometry = {**run.odometry.columns, "v_left": pulses, "v_right": pulses}
    travelled_m = np.concatenate([[0.0], np.cumsum(pulses[:-1] * np.diff(t))])
    x = np.interp(run.pose.stamps_s - delay_s, t, travelled_m)
    jumps = np.zeros_like(x)
    jumps[300] = 0.5
    still = np.zeros_like(x)
    scenes = []
    for places in (x, x + jumps):
        pose = {**run.pose.columns, "x": places, "y": still, "yaw": still}
        late = replace(
            run,
            odometry=replace(run.odometry, columns=odometry),
            pose=replace(run.pose, columns=pose),
        )
        scenes.append(dense_windows_of(late, CONFIG.horizon_s))
    assert not isolated(scenes[0], known, CONFIG).off.any()
    assert np.flatnonzero(isolated(scenes[1], known, CONFIG).off).tolist() == [300]


@pytest.mark.parametrize("noise_m", [0.0, 0.01])
def test_poses_that_repeat_the_last_one_are_found(plain, known, rng, noise_m):
    held = np.arange(len(plain.pose_s))
    for begin in (60, 200, 410, 600):
        held[begin : begin + 8] = begin
    run = plain.run
    columns = {name: of if name == "t" else of[held] for name, of in run.pose.columns.items()}
    columns["x"] = columns["x"] + noise_m * rng.normal(size=len(held))
    scene = dense_windows_of(replace(run, pose=replace(run.pose, columns=columns)), 2.0)
    found = outliers_of([scene], [], [plain], known, CONFIG)
    assert found.named.effect.form == "frozen"
    frozen_s = run.pose.stamps_s[held < np.arange(len(held))] - run.odometry.stamps_s[0]
    assert set(found.named.effect.stamps_s[0]) <= set(frozen_s)
    assert len(found.named.effect.stamps_s[0]) > 0.7 * len(frozen_s)


def test_poses_that_repeat_again_as_soon_as_they_caught_up_are_found(plain, known, rng):
    """Every second pose of some stretches repeats, at steps of a few times their noise."""
    pose = plain.run.pose.rows(np.arange(0, len(plain.run.pose), 3))
    repeats = np.concatenate([np.arange(begin, begin + 40, 2) for begin in (20, 110, 200)])
    columns = {name: of.copy() for name, of in pose.columns.items()}
    for name in ("x", "y"):
        columns[name] += 0.02 * rng.normal(size=len(pose))
    for name in ("x", "y", "yaw"):
        columns[name][repeats] = columns[name][repeats - 1]
    run = replace(plain.run, pose=replace(pose, columns=columns))
    off = np.flatnonzero(frozen(dense_windows_of(run, 4.0), known, CONFIG).off)
    assert set(off) <= set(repeats)
    assert len(off) > len(repeats) / 2


def test_poses_are_left_out_by_what_that_closes_on_all_runs(plain, known):
    """The reference hangs where nothing is held out: each such pose is off by itself."""
    held = np.arange(len(plain.pose_s))
    for begin in np.searchsorted(plain.pose_s, [3.0, 34.0, 44.0, 54.0, 64.0]):
        held[begin : begin + 8] = begin
    run = plain.run
    columns = {name: of if name == "t" else of[held] for name, of in run.pose.columns.items()}
    stuck = replace(run, pose=replace(run.pose, columns=columns))
    scene = dense_windows_of(stuck, CONFIG.horizon_s).numbered(0)
    _, _, found = without_outliers(
        ([stuck], []), ([scene], []), [np.array([1, 2])], ([plain], known), CONFIG
    )
    assert found is not None
    assert found.named.effect.form == "frozen"


def test_a_stretch_held_out_of_which_nothing_is_left_keeps_its_poses(plain, known):
    """The reference hangs all through the only stretch that is held out, and before and after."""
    pose_s = plain.pose_s
    hangs = (pose_s > 29.0) & (pose_s < 41.0)
    held = np.where(hangs, np.argmax(hangs), np.arange(len(pose_s)))
    run = plain.run
    columns = {name: of if name == "t" else of[held] for name, of in run.pose.columns.items()}
    stuck = replace(run, pose=replace(run.pose, columns=columns))
    scene = dense_windows_of(stuck, CONFIG.horizon_s).numbered(0)
    numbers = [np.array([3])]
    assert outliers_of([scene], [], [plain], known, CONFIG) is not None
    raw, (fitted, kept), found = without_outliers(
        ([stuck], []), ([scene], []), numbers, ([plain], known), CONFIG
    )
    assert found is None
    assert raw == (fitted, kept)
    assert len(fitted) == len(kept) == 1


def test_of_all_ways_to_freeze_and_jump_the_least_cost_is_found(rng):
    running, standing = rng.uniform(0.0, 30.0, 7), rng.uniform(0.0, 6.0, 7)
    after = {0: (0, 1), 1: (1, 2), 2: (0, 1)}

    def cost(states):
        if any(new not in after[old] for old, new in zip((0, *states[:-1]), states, strict=True)):
            return np.inf
        own = np.choose(states, [running, standing, np.zeros(7)]).sum()
        turns = sum(old != new != 0 for old, new in zip((0, *states[:-1]), states, strict=True))
        return own + np.log(7) * turns

    best = min(product(range(3), repeat=7), key=cost)
    found = frozen_steps(running, standing, 0.0)
    assert not (found & (np.array(best) != 1)).any()
    assert cost(best) < running.sum()
    assert found.any()
