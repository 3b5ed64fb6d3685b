"""Whether a parameter set is of this robot, and in metres and m/s."""

import pytest

from odometry.installed import shipped_data
from odometry.parameters import ParameterSet, TerrainParameters, read_parameters
from odometry.recording.run import Robot
from odometry.set_of_robot import set_notes

ICRS = {"y_left": 0.35, "y_right": -0.33, "x_icr": 0.0}
ROBOT = Robot(0.4)


def notes(values, vehicle=None, model="icr"):
    table = TerrainParameters(model, values)
    return set_notes(ParameterSet({"grass": table}, vehicle or {}), ROBOT)


@pytest.mark.parametrize("vehicle", [{}, {"track_width": 0.43}, {"track_width": "wide"}])
def test_nothing_is_odd_of_this_robot(vehicle):
    assert notes(ICRS, vehicle) == []


def test_a_set_that_states_another_track_width():
    (note,) = notes(ICRS, {"name": "Warthog", "track_width": 1.2})
    assert "of track width 1.2 m (Warthog), and this one has 0.4 m" in note


def test_a_table_that_states_another_track_width():
    (note,) = notes({"k": 0.9, "m": 0.5, "track_width": 1.2}, model="traction_mode")
    assert "of track width 1.2 m, and this one has 0.4 m" in note


def test_an_ideal_drive_may_have_an_effective_width():
    assert notes({"track_width": 0.8}, model="differential_drive") == []


@pytest.mark.parametrize(
    ("factor", "said"),
    [(1000.0, "680 m wide, 1700 of its track"), (0.2, "0.136 m wide, 0.34 of its track")],
)
def test_icrs_of_another_unit_or_robot(factor, said):
    (note,) = notes({name: factor * value for name, value in ICRS.items()})
    assert said in note


def test_slip_factors_of_another_unit():
    (note,) = notes(ICRS | {"alpha_left": 0.001, "alpha_right": 0.001})
    assert "moves the robot by 0.001 m" in note


def test_a_linear_model_in_degrees():
    in_degrees = {"gamma_31": -60.0, "gamma_32": 60.0, "gamma_21": 0.0, "gamma_22": 0.0}
    (note,) = notes(in_degrees | {"gamma_11": 0.5, "gamma_12": 0.5}, model="full_linear")
    assert "as if 0.01667 m wide" in note


def test_a_set_that_never_turns():
    names = ("gamma_21", "gamma_22", "gamma_31", "gamma_32")
    never = dict.fromkeys(names, 0.0) | {"gamma_11": 0.5, "gamma_12": 0.5}
    (note,) = notes(never, model="full_linear")
    assert "as if inf m wide" in note


@pytest.mark.parametrize(
    ("robot", "width_m"), [("warthog", 1.2), ("auriga_alpha", 0.42), ("j8", 1.7), ("lazaro", 0.4)]
)
def test_printed_sets_are_not_odd(robot, width_m):
    for file in (shipped_data() / "parameters").glob(f"{robot}*.toml"):
        assert set_notes(read_parameters(file), Robot(width_m)) == []
