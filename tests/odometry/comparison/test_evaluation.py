"""Errors per metre against a plain loop over the motion of every window."""

import math
from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.compare import compare
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation, evaluation_windows
from odometry.comparison.split import parts_by_terrain, windows_of_parts
from odometry.dead_reckoning import dead_reckon
from odometry.errors import WindowError
from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import reference_of, score
from odometry.models.catalogue import MODELS
from odometry.recording.run import Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.run_inputs import inputs_of
from odometry.windows.window_errors import window_errors


def whole(run):
    (part,) = parts_by_terrain(with_named_terrain(run, None), run.name).values()
    return part


def loop_errors(run, icrs, horizon_m, bench):
    """Translation and rotation per metre of distinct windows, sample by sample."""
    t, speeds = run.odometry.stamps_s, run.odometry.stack("v_left", "v_right")
    poses = {
        round(s, 6): p
        for s, p in zip(run.pose.stamps_s, run.pose.stack("x", "y", "yaw"), strict=True)
    }
    found, travel, reached, turned = [], 0.0, 0.0, 0.0
    predicted, start, before = None, None, None
    for i in range(len(t)):
        pose = poses.get(round(t[i], 6))
        if pose is not None:
            if before is not None:
                turned += math.remainder(pose[2] - before[2], 2 * math.pi)
            before = pose
            if start is not None and travel - start[1] >= horizon_m - 1e-9:
                length = travel - start[1]
                dx, dy = pose[0] - start[0][0], pose[1] - start[0][1]
                c, s = math.cos(start[0][2]), math.sin(start[0][2])
                away = math.hypot(c * dx + s * dy - predicted[0], c * dy - s * dx - predicted[1])
                found.append((away / length, abs(predicted[2] - (turned - start[2])) / length))
                start = None
            if start is None and travel >= reached - 1e-9:
                start, predicted = (pose, travel, turned), (0.0, 0.0, 0.0)
                reached += horizon_m
        if i + 1 < len(t):
            if predicted is not None:
                predicted = bench.advance(predicted, *speeds[i], icrs, t[i + 1] - t[i])
            travel += np.abs(speeds[i]).mean() * (t[i + 1] - t[i])
    return np.array(found).T


@pytest.mark.parametrize("horizon_m", [0.8, 4.0])
def test_errors_are_those_of_a_plain_loop(tmp_path, bench, horizon_m):
    """Speeds of 0.8 m/s and poses at 10 Hz, so that windows end on whole multiples of both."""
    rng = np.random.default_rng(3)
    half = np.repeat(rng.uniform(-0.8, 0.8, 20), 40)
    speeds = np.column_stack([half, np.sign(half) * 1.6 - half])  # mean of magnitudes: 0.8
    run = Run.read(bench.write(tmp_path / "run", speeds, icrs=bench.skewed, noise_m=0.02))
    model = MODELS["icr"]
    windows = evaluation_windows(whole(run), horizon_m, WindowConfig())
    errors = window_errors(model, model.pack(bench.symmetric), windows)
    expected = loop_errors(run, bench.symmetric, horizon_m, bench)
    assert len(windows) == len(expected[0]) > 5
    np.testing.assert_allclose(errors.translation_per_m, expected[0], rtol=0, atol=1e-5)
    np.testing.assert_allclose(errors.rotation_per_m, expected[1], rtol=0, atol=1e-5)


def test_a_robot_that_spins_turns_by_more_than_half_a_circle(tmp_path, bench):
    """v = -0.5, 0.5 at 0.8 m between ICRs: 1.25 rad/s, 2.5 rad per metre, 10 rad over 4 m."""
    speeds = np.tile([-0.5, 0.5], (500, 1))
    run = Run.read(bench.write(tmp_path / "run", speeds, noise_m=0.0))
    windows = evaluation_windows(whole(run), 4.0, WindowConfig())
    np.testing.assert_allclose(windows.measured[:, 2], 10.0, rtol=0, atol=1e-6)
    ideal = MODELS["differential_drive"]
    errors = window_errors(ideal, ideal.pack({"track_width": bench.track_width}), windows)
    np.testing.assert_allclose(errors.rotation_per_m, 4.0 - 2.5, rtol=0, atol=1e-6)


def test_mean_speeds_are_averages_over_time(tmp_path, bench):
    speeds = np.concatenate([np.tile([0.2, 0.6], (50, 1)), np.tile([1.0, 0.6], (51, 1))])
    run = Run.read(bench.write(tmp_path / "run", speeds))
    windows = evaluation_windows(whole(run), 3.0, WindowConfig())
    found = Evaluation("rover", "grass", "run", "others", 3.0, windows, {}).mean_speeds_m_s
    np.testing.assert_allclose(found, [[0.6, 0.6]], rtol=0, atol=1e-9)


def test_windows_straddle_joints_of_poses_but_no_gaps(tmp_path, bench):
    """1 m/s for 30 s, joints every 2 s: 14 distinct windows of 2 m; a gap costs two of them."""
    speeds = np.full((601, 2), 1.0)
    plain = Run.read(bench.write(tmp_path / "plain", speeds, window_s=1.5))
    assert len(evaluation_windows(whole(plain), 2.0, WindowConfig())) == 15
    gap = Run.read(bench.write(tmp_path / "gap", speeds, window_s=1.5, gap_s=(10.5, 11.9)))
    windows = evaluation_windows(whole(gap), 2.0, WindowConfig())
    ends_s = windows.start_s + 2.0
    assert len(windows) == 5 + 9
    assert not np.any((windows.start_s < 11.0) & (ends_s > 11.0))


def test_training_windows_do_not_straddle_joints(tmp_path, bench):
    speeds = np.full((601, 2), 1.0)
    run = Run.read(bench.write(tmp_path / "run", speeds, window_s=1.5))

    windows = windows_of_parts([whole(run)], WindowConfig())
    assert windows.travel_m.max() < 1.5


def test_a_run_shorter_than_the_horizon_says_so(tmp_path, bench):
    run = Run.read(bench.write(tmp_path / "run", np.full((40, 2), 0.5)))
    with pytest.raises(WindowError, match="no window of 2 m"):
        evaluation_windows(whole(run), 2.0, WindowConfig())


def test_horizons_of_training_do_not_reach_the_evaluation_windows(tmp_path, bench):
    run = Run.read(bench.write(tmp_path / "run", np.full((400, 2), 0.5)))
    seconds = replace(WindowConfig(), horizon_s=1.0, stride=0.5, shortest=0.1)
    by_seconds, by_metres = (
        evaluation_windows(whole(run), 2.0, c) for c in (seconds, WindowConfig())
    )
    np.testing.assert_array_equal(by_seconds.start_s, by_metres.start_s)


def test_a_score_of_the_same_windows_has_the_same_errors(tmp_path, bench):
    """The ideal drive of a robot that spins twice as fast: more than half a turn off in 5 m."""
    icrs = bench.symmetric | {"y_left": 0.12, "y_right": -0.12}
    runs = [
        Run.read(bench.write(tmp_path / f"{i}", bench.varied(rng, 60.0), icrs=icrs))
        for i, rng in enumerate(map(np.random.default_rng, (8, 9)))
    ]
    config = ComparisonConfig(horizons_m=(5.0,), draws=100)
    found = compare(runs, ["differential_drive"], config=config)
    (evaluation,) = [e for e in found.evaluations if (e.run, e.horizon_m) == ("0", 5.0)]
    rotation = np.degrees(evaluation.errors["differential_drive"].rotation_per_m)
    assert rotation.max() * 5 > 180
    run, ideal = runs[0], MODELS["differential_drive"]
    twists = ideal.twist(ideal.pack({"track_width": bench.track_width}), inputs_of(run))
    odometer = dead_reckon(run.odometry.stamps_s, twists, np.zeros(3))
    scored = score(run, odometer, reference_of(run)[1], EvaluationConfig(5.0, stride_m=5.0))
    assert scored.windows == len(evaluation.windows)
    np.testing.assert_allclose(
        scored.rotation_deg_per_m, np.percentile(rotation, [25, 50, 75]), rtol=1e-6
    )
    assert scored.mean_rotation_deg_per_m == pytest.approx(rotation.mean(), rel=1e-6)
    translation = evaluation.errors["differential_drive"].translation_per_m
    assert scored.mean_translation_per_m == pytest.approx(translation.mean(), rel=1e-4)
