"""Velocities of joints that are not those of their positions."""

import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag, course

NAMES = ["left_wheel", "right_wheel"]
COURSE = np.array(list(course(30.0)))
RATES = COURSE[:, 1:3] / RADIUS_M
ANGLES = np.cumsum(RATES, axis=0) * 0.05


def import_of(places, speeds, tmp_path, **options):
    bag = Bag("mcap")
    for t_s, place, speed in zip(COURSE[:, 0], places, speeds, strict=True):
        bag.joints(t_s, NAMES, place, speed)
    return imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)


@pytest.mark.parametrize(
    ("unit", "factor"), [("m/s", RADIUS_M), ("rpm", 30 / np.pi), ("deg/s", 180 / np.pi)]
)
def test_the_unit_of_velocities_is_named_by_the_positions(unit, factor, tmp_path):
    with pytest.raises(BagError, match=rf"left_wheel, right_wheel are .* in {unit}.*--unit {unit}"):
        import_of(ANGLES, factor * RATES, tmp_path)
    (tmp_path / "again").mkdir()
    run, _ = import_of(ANGLES, factor * RATES, tmp_path / "again", wheels__unit=unit)
    np.testing.assert_allclose(run.odometry.stack("v_left", "v_right"), COURSE[:, 1:3], atol=1e-6)


def test_a_wheel_whose_velocity_has_another_sign_is_named(tmp_path):
    with pytest.raises(BagError, match="velocities of right_wheel are -1 times") as caught:
        import_of(ANGLES, RATES * [1.0, -1.0], tmp_path)
    assert "--unit rad/s" in str(caught.value)
    assert "Velocities may be" not in str(caught.value)


RIGHT = {
    "as they are": (ANGLES, RATES),
    "angles wrap": ((ANGLES + np.pi) % (2 * np.pi) - np.pi, RATES),
    "ticks": (np.floor(ANGLES * 4096 / (2 * np.pi)), RATES),
    "positions that are not filled in": (np.zeros_like(ANGLES), RATES),
    "velocities of another drive": (ANGLES, np.abs(RATES[::-1]) * np.sin(COURSE[:, :1])),
    "velocities that a filter has smoothed": (
        ANGLES,
        np.apply_along_axis(np.convolve, 0, RATES, np.ones(6) / 6, "same"),
    ),
}


@pytest.mark.parametrize(("places", "speeds"), RIGHT.values(), ids=RIGHT)
def test_what_shows_no_unit_is_imported_as_it_is(places, speeds, tmp_path):
    run, _ = import_of(places, speeds, tmp_path)
    found = run.odometry.stack("v_left", "v_right")
    np.testing.assert_allclose(found, speeds * RADIUS_M, atol=1e-6)


def test_a_user_who_states_the_unit_is_believed(tmp_path):
    run, _ = import_of(ANGLES, 30 * RATES, tmp_path, wheels__unit="rad/s", wheels__gear=30.0)
    np.testing.assert_allclose(run.odometry.stack("v_left", "v_right"), COURSE[:, 1:3], atol=1e-6)
