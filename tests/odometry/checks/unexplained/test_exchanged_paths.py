"""What positions alone say of the treads: no gyroscope, no yaw."""

import numpy as np
import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.unexplained.exchanged_paths import exchanged_in_part
from tests.odometry.checks.answers import UNKNOWN, warnings
from tests.odometry.checks.drives import drive, shunting, uneven
from tests.odometry.checks.faulty import jump, put, treads, without_gyroscope, without_yaw


def alone(run):
    return without_gyroscope(without_yaw(run))


def exchanged_half_way(left, right):
    first = np.arange(len(left)) < len(left) / 2
    return np.where(first, left, right), np.where(first, right, left)


@pytest.mark.parametrize("seed", range(3))
def test_treads_that_are_exchanged_half_way_are_not_the_path(seed):
    run = alone(uneven(seed))
    assert warnings(run) == []
    assert warnings(treads(run, exchanged_half_way)) == UNKNOWN
    words = exchanged_in_part(Evidence(treads(run, exchanged_half_way)))
    assert float(words.split("first at ")[1].split()[0]) == pytest.approx(100, abs=15)
    assert not exchanged_in_part(Evidence(run))


def turning_back(seed=0):
    """Forwards and backwards by turns, straight ahead mostly."""
    rng = np.random.default_rng(seed)
    speed = np.convolve(np.repeat([0.8, -0.6] * 10, 160), np.ones(9) / 9, "same")
    turn = np.convolve(np.repeat(rng.uniform(-0.2, 0.2, 40), 80), np.ones(20) / 20, "same")
    return alone(drive(speed, turn, seed=seed))


def test_magnitudes_are_named_where_the_robot_turns_back():
    run = turning_back()
    assert warnings(run) == []
    assert warnings(treads(run, lambda *speeds: tuple(map(np.abs, speeds)))) == ["treads_unsigned"]


def test_turns_on_the_spot_and_jumps_turn_no_robot_back():
    """The robot turns by three radians between lanes, and its positions jump."""
    lanes = [(0.7, 0.0)] * 160 + [(0.0, 0.6)] * 105
    run = alone(drive(*np.array(lanes * 12).T))
    for signed in (run, jump(run, 3.0)):
        magnitudes = put(signed, "odometry", v_left=np.abs(signed.odometry["v_left"]))
        assert "treads_unsigned" not in warnings(magnitudes)


def test_a_drive_of_all_kinds_is_not_accused():
    assert [warnings(alone(shunting(seed))) for seed in range(4)] == [[]] * 4
