"""Poses on lines between measured ones are left out, and others are not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.checks.findings.finding import Level
from odometry.checks.recording import check_recording
from odometry.identification.identify import identify
from odometry.recording.run import Run
from odometry.windows.recorded.interpolated import interpolated, on_lines, poses_per_measured_one
from odometry.windows.recorded.measured_poses import measured_poses, measured_positions

EVERY = 20  # rows of 10 Hz


@pytest.fixture(scope="module")
def recorded(synthetic, tmp_path_factory):
    """Two minutes, poses at 10 Hz with 5 mm and 3 mrad of noise, a rest in the middle."""
    rng = np.random.default_rng(3)
    odometry = synthetic.commands(rng, 1200)
    odometry[550:650, 1:3] = 0.0
    folder = tmp_path_factory.mktemp("interpolated") / "run"
    twist = synthetic.icr_twist(synthetic.icrs)
    run = Run.read(synthetic.write(folder, odometry, np.arange(0, 119.5, 0.1), twist))
    return synthetic.noisy(run, rng, 0.005, 0.003)


def resampled(run, fixes):
    """Poses on straight lines between those of some rows, with six digits."""
    t = run.pose.stamps_s
    columns = {n: np.interp(t, t[fixes], run.pose[n][fixes]).round(6) for n in ("x", "y", "yaw")}
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, **columns}))


@pytest.fixture(scope="module")
def regular(recorded):
    return resampled(recorded, np.arange(0, len(recorded.pose), EVERY))


def between_fixes(run, offset_s):
    """Poses at 10 Hz on lines between poses measured every two seconds, at other times."""
    t = run.pose.stamps_s
    fixes_s = np.arange(t[0] + offset_s, t[-1], EVERY / 10)
    grid_s = t[(t >= fixes_s[0]) & (t <= fixes_s[-1])]
    columns = {
        name: np.interp(grid_s, fixes_s, np.interp(fixes_s, t, run.pose[name]))
        for name in ("x", "y", "yaw")
    }
    return replace(run, pose=replace(run.pose, columns={"t": grid_s, **columns}))


@pytest.mark.parametrize("offset_s", [0.0, 0.03, 0.05, 0.08])
def test_lines_are_recognised_wherever_the_measured_poses_lie(recorded, offset_s):
    pose = between_fixes(recorded, offset_s).pose
    positions = pose.stack("x", "y")
    kept = ~interpolated(pose.stamps_s, positions)
    assert kept.mean() < 0.3  # at rest no line is recognised
    assert poses_per_measured_one(pose.stamps_s, positions) == pytest.approx(EVERY, abs=1)


def test_measured_poses_are_one_each(recorded):
    assert poses_per_measured_one(recorded.pose.stamps_s, recorded.pose.stack("x", "y")) == 1


@pytest.mark.parametrize("measured", [measured_poses, measured_positions])
def test_measured_poses_alone_are_kept(recorded, regular, measured):
    stamps_s, *_ = measured(regular)
    fixes_s = recorded.pose.stamps_s[::EVERY]
    assert np.isin(fixes_s, stamps_s).all()
    assert len(stamps_s) < len(fixes_s) + EVERY  # the last rows hold the last fix
    assert len(measured(recorded)[0]) == len(recorded.pose)


def test_identified_parameters_are_as_if_the_lines_were_not_there(synthetic, regular):
    """With the lines, slip factors are 5 % too small and more."""
    (found,) = identify([regular], "icr").terrains.values()
    assert found.fit.values == pytest.approx(synthetic.icrs, abs=0.02)


def test_straight_drives_without_noise_keep_their_poses():
    """Turns of half a second after straight drives of 1 to 6 s."""
    rng = np.random.default_rng(2)
    rates = [np.append(np.zeros(rng.integers(10, 60)), np.full(5, 0.1)) for _ in range(20)]
    yaw = np.cumsum(np.concatenate(rates))
    positions = 0.1 * np.cumsum(np.stack([np.cos(yaw), np.sin(yaw)], axis=-1), axis=0)
    stamps_s = 0.1 * np.arange(len(yaw))
    moving, on_line = on_lines(stamps_s, positions)
    assert on_line[moving].mean() > 0.8
    assert not interpolated(stamps_s, positions).any()


@pytest.mark.parametrize("count", [0, 1, 19])
def test_few_poses_are_all_measured(count):
    t = np.arange(count, dtype=float)
    assert not interpolated(t, np.stack([t, t], axis=-1)).any()


def test_the_check_says_that_the_lines_cut_curves(regular):
    (finding,) = [
        one for one in check_recording(regular).findings if one.name == "interpolated_poses"
    ]
    assert finding.level is Level.NOTE  # the others are left out
    assert "leave the others out" in finding.remedy
    assert "cut curves short" in finding.cause


def test_lines_of_unequal_time_across_turns_are_a_warning(recorded):
    """They cannot be told from straight drives by themselves: the gyroscope or treads tell."""
    rng = np.random.default_rng(1)
    fixes = np.cumsum(rng.integers(5, 35, 200))
    uneven = resampled(recorded, fixes[fixes < len(recorded.pose)])
    (finding,) = [
        one for one in check_recording(uneven).findings if one.name == "interpolated_poses"
    ]
    assert finding.level is Level.WARNING
    assert len(measured_poses(uneven)[0]) == len(uneven.pose)


def test_even_stretches_between_short_pushes_are_no_lines_between_poses():
    stamps_s = np.arange(0.0, 60.0, 0.1)
    speed = np.where(np.arange(600) % 60 == 0, 0.7, 0.1)
    x = np.concatenate([[0.0], np.cumsum(0.1 * speed[:-1])])
    assert not interpolated(stamps_s, np.column_stack([x, 0 * x])).any()
