"""Rounded positions of the reference count as noise, and are named where they are the gap."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.answer.named_rounding import named_rounding
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.rounding import rounding_notes
from odometry.gap.prepare.scenes import scene_of
from odometry.gap.prepare.statistic import floor_of, floor_there, gap_of
from odometry.windows.dense.dense_noise import Noise, end_variance, estimated_noise, whitening
from tests.odometry.conftest import scaled

CONFIG = GapConfig()


def rounded(scene, step_m):
    """The scene of the same run with positions to a step."""
    pose = scene.run.pose
    columns = {name: np.round(pose[name] / step_m) * step_m for name in ("x", "y")}
    run = replace(scene.run, pose=replace(pose, columns={**pose.columns, **columns}))
    return scene_of(run, CONFIG)


def named(scenes, known):
    floor = floor_of(known.held_back, CONFIG.part_s)
    return named_rounding(scenes, scenes, known, floor, CONFIG)


@pytest.mark.parametrize("step_m", [0.15, 0.3])
def test_rounding_is_the_gap(make_scene, known, step_m):
    scene = rounded(make_scene(3, duration_s=120.0), step_m)
    found = named([scene], known)
    assert found.added.effect.key == ("reference_fault", "rounded", "")
    assert found.added.values[0] == pytest.approx(step_m, rel=0.02)
    assert found.evidence > CONFIG.least_evidence
    floor = floor_there(floor_of(known.held_back, 10.0), known, [scene], CONFIG)
    gap = gap_of(known.base, (), [scene], 10.0)
    assert floor.value == pytest.approx(gap.value, rel=0.15)


def test_a_coarse_step_is_found_whole(make_scene):
    """Around few positions the robot moved by two of them, and by more of a part of them."""
    assert rounded(make_scene(3, duration_s=60.0), 1.0).rounded_m == pytest.approx(1.0)


def test_positions_as_measured_are_not(make_scene, known):
    scene = make_scene(3, duration_s=120.0)
    assert scene_of(scene.run, CONFIG).rounded_m == 0.0
    assert named([scene], known) is None


def test_rounding_within_the_noise_is_no_gap(make_scene, known):
    scene = rounded(make_scene(3, duration_s=120.0), 0.01)
    assert named([replace(scene, rounded_m=0.01)], known) is None


def test_rounding_that_the_calibration_has_is_no_gap(make_scene, known):
    scene = rounded(make_scene(3, duration_s=120.0), 0.3)
    kept = tuple((base, rounded(of, 0.3)) for base, of in known.held_back)
    alike = replace(known, held_back=tuple((b, replace(s, rounded_m=0.3)) for b, s in kept))
    assert named([scene], alike) is None


def test_rounding_beside_a_larger_gap_is_not_its_name(make_scene, known):
    scene = rounded(make_scene(3, scaled, duration_s=120.0), 0.1)
    assert scene.rounded_m == pytest.approx(0.1, rel=0.02)
    assert named([scene], known) is None
    (note,) = rounding_notes([scene], [scene])
    assert "rounded to 0.1 m" in note


def test_the_step_adds_its_variance_to_that_of_positions(make_scene):
    scene, noise = make_scene(5, duration_s=30.0), Noise(0.01, 0.004, 0.01, 0.01)
    coarse = replace(scene, rounded_m=0.24)
    wider = replace(noise, position_m=float(np.hypot(0.01, 0.24 / np.sqrt(12))))
    np.testing.assert_allclose(end_variance(coarse, noise), end_variance(scene, wider))
    np.testing.assert_allclose(whitening(coarse, noise), whitening(scene, wider))


def test_noise_is_estimated_beyond_the_rounding(make_scene, rng):
    scene = make_scene(5, duration_s=300.0)
    coarse = replace(scene, rounded_m=0.1)
    white = rng.standard_normal((len(scene), scene.rows_per_window, 1))
    rows = np.linalg.solve(whitening(coarse, Noise(0.02, 0.01, 0.01, 0.01)), white)[..., 0]
    found = estimated_noise([coarse], [rows])
    assert found.position_m == pytest.approx(0.02, rel=0.3)
    assert estimated_noise([scene], [rows]).position_m == pytest.approx(0.035, rel=0.15)


def test_all_runs_must_be_rounded(make_scene, known: Calibration):
    scene = make_scene(3, duration_s=120.0)
    assert named([rounded(scene, 0.3), scene], known) is None
