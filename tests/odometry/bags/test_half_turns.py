"""Angles of wheels within one turn that change by half a turn between two messages."""

import numpy as np
import pytest

from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, Bag


def turning(turns_a_message, tmp_path, **options):
    """Wheels whose angles are given within one turn, while they speed up to so many turns."""
    turned = np.cumsum(np.linspace(0, turns_a_message, 200)) * 2 * np.pi
    bag = Bag("mcap")
    for k, angle in enumerate((turned + np.pi) % (2 * np.pi) - np.pi):
        bag.joints(0.2 * k, ["left_wheel", "right_wheel"], [angle, angle], [])
    return imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)


@pytest.mark.parametrize("turns", [0.45, 0.6, 1.2])
def test_angles_that_change_by_half_a_turn_between_messages_stop_the_import(turns, tmp_path):
    with pytest.raises(BagError, match="nearly half a turn between two messages"):
        turning(turns, tmp_path)
    (tmp_path / "again").mkdir()
    _, said = turning(turns, tmp_path / "again", wheels__values="position")
    assert any(note.startswith("warning: positions within one turn") for note in said.notes)


def test_angles_that_change_by_less_than_half_a_turn_are_differenced(tmp_path):
    run, said = turning(0.35, tmp_path)
    expected = np.linspace(0, 0.35, 200)[1:] * 2 * np.pi * RADIUS_M / 0.2
    np.testing.assert_allclose(run.odometry["v_left"], expected, atol=1e-6)
    assert not any("half a turn" in note for note in said.notes)
