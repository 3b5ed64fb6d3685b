import numpy as np
import pytest

from odometry.recording.run import Run
from odometry.windows.recorded.run_inputs import attitude_of, inputs_of

WHOLE = """t,v_left,v_right,roll,pitch,accel_x,accel_y
0,0.5,0.6,0.1,,1,
1,0.7,0.8,,0.2,,5
3,0.9,1.0,0.4,0.6,4,7
4,1.1,1.2,,,,
"""


def test_empty_cells_are_interpolated_in_time_and_held_at_the_ends(make_run):
    inputs = inputs_of(Run.read(make_run(odometry=WHOLE)))
    expected = [[0.5, 0.6], [0.7, 0.8], [0.9, 1.0], [1.1, 1.2]]
    np.testing.assert_array_equal(inputs.tread_speeds_m_s, expected)
    np.testing.assert_allclose(inputs.roll_rad, [0.1, 0.2, 0.4, 0.4], rtol=0, atol=1e-15)
    np.testing.assert_allclose(inputs.pitch_rad, [0.2, 0.2, 0.6, 0.6], rtol=0, atol=1e-15)
    accelerations = [[1, 5], [2, 5], [4, 7], [4, 7]]
    np.testing.assert_allclose(inputs.accelerations_m_s2, accelerations, rtol=0, atol=1e-15)


def test_a_run_without_attitude_and_accelerations_stands_on_level_ground(make_run):
    inputs = inputs_of(Run.read(make_run()))
    assert inputs.roll_rad.tolist() == inputs.pitch_rad.tolist() == [0, 0, 0]
    assert inputs.accelerations_m_s2 is None
    assert inputs.shape == (3,)


@pytest.mark.parametrize("rows", ["accel_x\n0,1,1,5\n1,1,1,5\n", "accel_x,accel_y\n0,1,1,5,\n"])
def test_one_acceleration_is_none(make_run, rows):
    """A missing column, and a column of empty cells."""
    assert (
        inputs_of(Run.read(make_run(odometry=f"t,v_left,v_right,{rows}"))).accelerations_m_s2
        is None
    )


def test_a_roll_without_pitch(make_run):
    odometry = "t,v_left,v_right,roll,pitch\n0,1,1,0.1,\n1,1,1,0.3,nan\n"
    roll, pitch = attitude_of(Run.read(make_run(odometry=odometry)))
    assert (roll.tolist(), pitch.tolist()) == ([0.1, 0.3], [0, 0])
