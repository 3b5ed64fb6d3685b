"""What simulated steps between images say of drives in which little can be determined."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.tables.table import Table
from terrain.checks import image_motion as checked
from terrain.checks import unrelated_images
from terrain.checks.ground_steps import GroundSteps
from terrain.checks.image_motion import image_motion
from terrain.checks.image_stretches import ImageStretches
from tests.odometry.checks.drives import drive
from tests.odometry.checks.faulty import without_gyroscope

AT_S = 0.05 * np.arange(2400)


class Height:
    """All that is asked of a camera."""

    height_m = 1.2
    image_size = (640, 480)


def steps_of(motion, x_icr, stamps_s, seed):
    """Steps of a robot whose lateral speed is -x_icr omega, with 3 mm and 3 mrad of noise."""
    speed, turn = motion
    yaw = np.concatenate([[0.0], np.cumsum(turn)[:-1] * 0.05])
    velocity = speed + -1j * x_icr * turn
    place = np.concatenate([[0.0], np.cumsum(velocity * np.exp(1j * yaw))[:-1] * 0.05])
    x, y, angle = (np.interp(stamps_s, AT_S, of) for of in (place.real, place.imag, yaw))
    moved = np.diff(x + 1j * y, axis=1)[:, 0] * np.exp(-1j * angle[:, 0])
    noise = np.random.default_rng(seed).normal(0, 0.003, (3, len(moved)))
    return np.column_stack([moved.real, moved.imag, np.diff(angle, axis=1)[:, 0]]) + noise.T


@pytest.fixture
def found(monkeypatch):
    """Findings and what could not be checked, of a drive whose images are late by so much."""

    def of(
        motion,
        *,
        x_icr=0.0,
        late_s=0.0,
        stamps_s=None,
        backwards=False,
        seed=0,
        gyro=True,
        slip=None,
    ):
        image_s = np.arange(1.0, 118.0, 0.25) if stamps_s is None else stamps_s
        rows = np.unique(np.linspace(0, len(image_s) - 2, 32).astype(int))
        rows = np.column_stack([rows, rows + 1])
        run = drive(*motion)
        run = run if gyro else without_gyroscope(run)
        images = Table(Path("images.csv"), {"t": image_s + late_s}, np.arange(len(image_s)) + 2)
        true_s = (image_s[::-1] if backwards else image_s)[rows]
        measured = steps_of(motion, x_icr, true_s, seed)
        if slip is not None:
            measured[:, :2] *= slip
        scales = np.random.default_rng(seed).normal(1, 0.003, len(rows))
        steps = GroundSteps(rows, image_s[rows] + late_s, measured, len(rows), scales)
        none = GroundSteps(rows[:0], np.empty((0, 2)), np.empty((0, 3)), len(rows))
        all_show = ImageStretches(replace(run, images=images), rows[:0], rows[:0, 0])
        monkeypatch.setattr(checked, "image_stretches", lambda *_: all_show)
        monkeypatch.setattr(checked, "fixed_parts", lambda *_: None)
        monkeypatch.setattr(checked, "lost_details", lambda *_: ())
        monkeypatch.setattr(checked, "ground_steps", lambda *_: steps)
        monkeypatch.setattr(unrelated_images, "ground_steps", lambda *_: none)
        monkeypatch.setattr(unrelated_images, "_by_name", lambda _: None)
        findings, skipped = image_motion(replace(run, images=images), Height())
        return [one.name for one in findings], skipped

    return of


WINDING = (1 + 0.3 * np.sin(AT_S / 7), 0.5 * np.sin(AT_S / 3) + 0.2 * np.sin(AT_S / 1.3))
KNOTS = np.random.default_rng(1).uniform(-1, 1, (2, 61))  # each two seconds
WANDERING = tuple(np.interp(AT_S, 2.0 * np.arange(61), of) for of in (1 + 0.5 * KNOTS[0], KNOTS[1]))
SPIN = (np.zeros(len(AT_S)), 0.6 * np.sin(AT_S / 4))
STRAIGHT = (0.6 + 0.4 * np.sin(0.5 * AT_S), np.zeros(len(AT_S)))
MOSTLY_SPINS = (0.02 * np.sin(AT_S / 3), 0.7 * np.sin(AT_S / 2))
CIRCLE = (0.6 + 0.3 * np.sin(0.4 * AT_S), 0.6 + 0.3 * np.sin(0.4 * AT_S))


@pytest.mark.parametrize("gyro", [True, False])
@pytest.mark.parametrize("x_icr", [0.0, -0.2])
@pytest.mark.parametrize("motion", [WINDING, WANDERING, SPIN, STRAIGHT, MOSTLY_SPINS, CIRCLE])
def test_no_drive_is_accused(found, motion, x_icr, gyro):
    for seed in range(3):
        assert found(motion, x_icr=x_icr, seed=seed, gyro=gyro)[0] == []


def test_a_lag_at_the_end_of_the_search_is_no_lag(found):
    assert found(WINDING, late_s=9.0)[0] == ["images_late"]
    names, skipped = found(WINDING, late_s=12.0)
    assert names == []
    assert "do not agree within 10 s" in skipped


@pytest.mark.parametrize("gyro", [True, False])
def test_a_lag_far_beyond_the_search_is_another_drive(found, gyro):
    assert found(WANDERING, late_s=30.0, gyro=gyro)[0] == ["images_unrelated"]


def test_a_straight_drive_at_an_even_speed_is_of_any_drive(found):
    names, skipped = found((np.full(len(AT_S), 0.6), 0.02 * np.sin(AT_S / 3)), late_s=12.0)
    assert names == []
    assert not skipped or "do not agree within 10 s" in skipped


@pytest.mark.parametrize("gyro", [True, False])
def test_treads_that_slip_are_not_taken_for_another_drive(found, gyro):
    """Most of the way is lost, now more and now less: the turns still are those of the robot."""
    slip = np.random.default_rng(5).uniform(0.1, 1.0, (32, 1))
    assert "images_unrelated" not in found(WANDERING, slip=slip, gyro=gyro)[0]


def test_treads_that_spin_on_the_spot_are_not_taken_for_another_drive(found):
    slip = np.repeat([[0.0], [1.0]], 16, axis=0)
    assert "images_unrelated" not in found(WANDERING, slip=slip)[0]


def test_a_reverse_order_at_an_uneven_rate_is_found(found):
    stamps_s = np.concatenate([np.arange(1.0, 40.0, 0.2), np.arange(40.0, 118.0, 0.5)])
    assert found(WINDING, stamps_s=stamps_s, backwards=True)[0] == ["images_reversed"]
