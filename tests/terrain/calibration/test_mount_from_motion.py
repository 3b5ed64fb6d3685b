"""The mount from a run, against tracks and images made with a mount that is known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.recording.run import Run
from odometry.trajectory import Trajectory
from terrain.calibration.mount_fit import MountFit
from terrain.calibration.mount_from_motion import mount_from_motion
from terrain.calibration.mount_sources import MountSource, mount_of_motion, with_height
from terrain.calibration.tracks import Tracks
from terrain.camera_files.lens_models import Lens
from terrain.errors import CalibrationError
from terrain.main_job import run_odometry
from tests.terrain.calibration.rendered import OPTICAL, rotation

LENS = Lens.of((640, 480), [[460.0, 0, 319.5], [0, 460.0, 239.5], [0, 0, 1]])
MOUNT = [0.2, 0.05, 0.8, 0.03, 0.5, -0.04]


def tracks(mount, rng, *, pairs=24, noise_px=0.0, turn=0.05, outliers=0.0):
    """Points of the terrain in view, before and after steps of the robot."""
    mount = np.array(mount)
    optical = rotation(*mount[3:]) @ OPTICAL
    befores, afters, of_pair, steps = [], [], [], []
    for pair in range(pairs):
        rays = rng.uniform([-0.65, -0.5], [0.65, 0.5], (60, 2))
        robot = np.column_stack([rays, np.ones(60)]) @ optical.T
        rays, robot = rays[robot[:, 2] < -0.1], robot[robot[:, 2] < -0.1]
        ground = mount[:3] + robot * (mount[2] / -robot[:, 2])[:, None]
        step = np.array([rng.uniform(0.08, 0.16), rng.normal(0, 0.002), rng.normal(0, turn)])
        seen = ((ground - [*step[:2], 0]) @ rotation(0, 0, step[2]) - mount[:3]) @ optical
        after = seen[:, :2] / seen[:, 2:]
        wild = rng.random(len(after)) < outliers
        after[wild] += rng.uniform(-0.1, 0.1, (np.count_nonzero(wild), 2))
        befores.append(rays)
        afters.append(after + rng.normal(0, noise_px / 460, after.shape))
        of_pair.append(np.full(len(rays), pair))
        steps.append(step)
    return Tracks(
        np.concatenate(befores), np.concatenate(afters), np.concatenate(of_pair), np.array(steps),
        pairs,
    )  # fmt: skip


@settings(max_examples=8)
@given(
    st.floats(0.25, 2.0), st.floats(-0.15, 0.15), st.floats(0.1, 1.3),
    st.sampled_from([0.0, np.pi - 0.1, 0.2]),
)  # fmt: skip
@pytest.mark.slow
def test_exact_tracks_give_the_exact_mount(z, roll, pitch, yaw):
    """Cameras that look ahead, and one that looks back, low and high."""
    mount = np.array([0.2, 0.05, z, roll, pitch, yaw])
    exact = tracks(mount, np.random.default_rng(1))
    found, _ = mount_from_motion(exact, LENS, mount * [1, 1, 0, 0, 0, 0])
    np.testing.assert_allclose(found.mount, mount, atol=1e-4)
    assert found.agrees.all()


def test_noise_and_outliers():
    """A third of the features on things that move; steps wrong by 2 %."""
    rng = np.random.default_rng(2)
    made = tracks(MOUNT, rng, pairs=60, noise_px=0.4, outliers=0.33)
    steps = made.steps * (1 + rng.normal(0, 0.02, made.steps.shape))
    made = Tracks(made.before, made.after, made.pair, steps, made.tried)
    found, _ = mount_from_motion(made, LENS, np.array(MOUNT) * [1, 1, 0, 0, 0, 0])
    error = np.abs(found.mount - MOUNT)
    assert np.degrees(error[3:5]).max() < 0.15
    assert error[2] < 0.01
    assert (found.half_interval[2:] < [0.02, 0.01, 0.01, 0.02]).all()
    assert np.isnan(found.half_interval[:2]).all()
    assert 0.6 < found.agrees.mean() < 0.75


def test_features_that_do_not_move_as_terrain():
    rng = np.random.default_rng(3)
    made = tracks(MOUNT, rng)
    wild = Tracks(made.before, rng.uniform(-0.5, 0.5, made.after.shape), made.pair, made.steps, 24)
    with pytest.raises(CalibrationError, match="% of the features move as terrain would"):
        mount_from_motion(wild, LENS)


def test_too_few_pairs():
    with pytest.raises(CalibrationError, match=r"10 pairs of images .* at least 16"):
        mount_from_motion(tracks(MOUNT, np.random.default_rng(1), pairs=10), LENS)


def test_too_little_texture():
    made = tracks(MOUNT, np.random.default_rng(1), pairs=10)
    blind = Tracks(made.before, made.after, made.pair, made.steps, 80)
    with pytest.raises(CalibrationError, match=r"10 of 80 pairs .* too little texture"):
        mount_from_motion(blind, LENS)


def stayed(made, pairs, rng):
    """The same tracks, with the features of the first pairs where they were, to 0.1 px."""
    after = np.where((made.pair < pairs)[:, None], made.before, made.after)
    return replace(made, after=after + rng.normal(0, 0.1 / 460, after.shape))


def test_a_frozen_camera_has_no_mount():
    rng = np.random.default_rng(8)
    with pytest.raises(CalibrationError, match=r"in 24 of 24 pairs the image stays the same"):
        mount_from_motion(stayed(tracks(MOUNT, rng), 24, rng), LENS, np.array(MOUNT))


def test_pairs_in_which_the_view_stays_do_not_count():
    rng = np.random.default_rng(8)
    made = stayed(tracks(MOUNT, rng, pairs=40), 20, rng)
    found, used = mount_from_motion(made, LENS, np.array(MOUNT) * [1, 1, 0, 0, 0, 0])
    np.testing.assert_allclose(found.mount, MOUNT, atol=3e-3)
    assert len(used.steps) == 20
    assert found.notes[-1].startswith(
        "in 20 of 40 pairs the image stays the same though the treads"
    )
    assert found.notes[-1].endswith("the mount is that of the other 20")


def test_where_too_few_others_are_left_their_number_is_stated():
    rng = np.random.default_rng(8)
    with pytest.raises(CalibrationError, match=r"in 15 of 30 .* 15 pairs are left, expected"):
        mount_from_motion(stayed(tracks(MOUNT, rng, pairs=30), 15, rng), LENS, np.array(MOUNT))


def test_nothing_is_said_of_frozen_images_where_there_are_none():
    found, _ = mount_from_motion(tracks(MOUNT, np.random.default_rng(1)), LENS)
    assert not any("stays the same" in note for note in found.notes)


def test_the_intervals_are_said_to_hold_for_the_lens():
    found, _ = mount_from_motion(tracks(MOUNT, np.random.default_rng(1)), LENS)
    assert any("for the lens as given" in note for note in found.notes)


def test_a_height_that_the_run_does_not_determine_has_to_be_stated():
    half = np.array([np.nan, np.nan, np.nan, 0.01, 0.01, 0.01])
    source = MountSource(None, "the motion", MountFit(np.array(MOUNT), half, np.zeros(3)))
    with pytest.raises(CalibrationError, match="does not determine the height"):
        with_height(source)


def test_a_narrow_view_with_noise_determines_no_pitch():
    """All features within a degree, a pixel of noise each."""
    rng = np.random.default_rng(4)
    made = tracks(MOUNT, rng)
    near = (np.abs(made.before) < 0.02).all(axis=1)
    few = Tracks(
        made.before[near], made.after[near] + rng.normal(0, 1.5 / 460, made.after[near].shape),
        made.pair[near], made.steps, 24,
    )  # fmt: skip
    with pytest.raises(CalibrationError, match="does not determine the pitch"):
        mount_from_motion(few, LENS)


def test_rendered_images(across_run, world):
    """Images of 160 x 120 pixels over two terrains: pitch within half a degree."""
    run = Run.read(across_run)
    camera = world.camera
    lens = Lens.of(camera["image_size"], camera["matrix"], camera["distortion"])
    odometer = run_odometry(run, vision=False).replay.odometer()
    place = np.array(camera["mount"]) * [1, 1, 0, 0, 0, 0]
    found = mount_of_motion(run, odometer, lens, place)
    error = np.abs(found.fit.mount - camera["mount"])
    assert np.degrees(error[3:5]).max() < 0.5
    assert error[2] < 0.02
    assert found.fit.rms_px < 1.0


def test_a_run_without_images(curvy_run, world):
    lens = Lens.of(world.camera["image_size"], world.camera["matrix"])
    with pytest.raises(CalibrationError, match="no images"):
        mount_of_motion(Run.read(curvy_run), Trajectory(np.arange(2.0), np.zeros((2, 3))), lens)
