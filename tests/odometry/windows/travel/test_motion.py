from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from odometry.models.catalogue import MODELS
from odometry.models.icr import Icr
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot, Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel import linear_motion
from odometry.windows.travel.motion import linearised_window_motion, window_motion
from odometry.windows.travel.windows import Windows, windows_of

STEP = 1e-5  # of a parameter's ordinary size; truncation and rounding are both below 1e-8
COUNTED = {"contacts"}  # a whole number has no derivative
ROBOT = Robot(0.5, length=0.9, width=0.6, wheel_radius=0.15, mass=50.0)
SPINNING = np.array([0.5, -0.5, 0.1, 1.0, 1.0])


def derivative_of_motion(model, values, windows):
    return linearised_window_motion(model, values, windows)[1]


def matrix(yaw, pitch, roll, x, y):
    transform = np.eye(4)
    transform[:3, :3] = Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix()
    transform[:2, 3] = x, y
    return transform


def end_by_matrices(twist_of, windows, k):
    """4x4 matrices and matrix exponentials; the yaw is followed through its turns."""
    x, y, yaw = 0.0, 0.0, 0.0
    inputs = windows.inputs.rows(np.arange(windows.first[k], windows.last[k]))
    for i in range(inputs.shape[0]):
        roll, pitch = inputs.roll_rad[i], inputs.pitch_rad[i]
        v_x, v_y, omega = twist_of(inputs.left[i], inputs.right[i], roll, pitch)
        rate = np.zeros((4, 4))
        rate[0, 1], rate[1, 0], rate[:2, 3] = -omega, omega, (v_x, v_y)
        step = expm(rate * windows.steps_s[windows.first[k] + i])
        moved = matrix(yaw, pitch, roll, x, y) @ step
        x, y = moved[:2, 3]
        change = np.arctan2(moved[1, 0], moved[0, 0]) - yaw
        yaw += (change + np.pi) % (2 * np.pi) - np.pi
    return [x, y, yaw]


@pytest.fixture(scope="module", params=["level", "plane", "rough"])
def driven(request, synthetic, tmp_path_factory):
    """Half a minute; poses, and so windows, begin between rows of odometry."""
    rng = np.random.default_rng(5)
    attitude_of = {
        "level": synthetic.level,
        "plane": synthetic.plane(0.3),
        "rough": lambda *_: tuple(rng.uniform(-0.3, 0.3, 2)),
    }[request.param]
    folder = synthetic.write(
        tmp_path_factory.mktemp("driven") / request.param,
        synthetic.commands(rng, 300),
        np.arange(0.57, 29, 0.3),
        synthetic.icr_twist(synthetic.icrs),
        attitude_of=attitude_of,
    )
    return Run.read(folder)


def test_against_matrices(driven, synthetic):
    """Windows that start amid the run, overlap, and end between rows."""
    windows = windows_of([driven], WindowConfig(horizon_m=1.5, stride=0.6))
    assert len(windows) > 10
    predicted = window_motion(Icr(), Icr().pack(synthetic.icrs), windows)
    twist_of = synthetic.icr_twist(synthetic.icrs)
    expected = [end_by_matrices(twist_of, windows, k) for k in range(len(windows))]
    np.testing.assert_allclose(predicted, expected, rtol=0, atol=1e-12)


def test_true_parameters_meet_the_poses_of_the_plain_loop(driven, synthetic):
    windows = windows_of([driven], WindowConfig())
    predicted = window_motion(Icr(), Icr().pack(synthetic.icrs), windows)
    error = predicted - windows.measured
    error[:, 2] = np.remainder(error[:, 2] + np.pi, 2 * np.pi) - np.pi
    np.testing.assert_allclose(error, 0, atol=1e-12)


@pytest.mark.parametrize("predict", [window_motion, derivative_of_motion])
def test_of_no_windows_nothing_is_predicted(winding, predict):
    windows = windows_of([winding], WindowConfig())
    none = windows.where(np.zeros(len(windows), dtype=bool))
    assert len(predict(Icr(), SPINNING, none)) == 0


def spinning(steps_s):
    """One window over all steps of turning on the spot at 2 rad/s, and one over the last two."""
    count = len(steps_s)
    return Windows(
        Inputs(np.tile([-1.0, 1.0], (count + 1, 1))),
        np.append(steps_s, 0.0),
        np.array([0, count - 2]),
        np.array([count, count]),
        np.array([0, 1]),
        np.array([2, 2]),
        np.zeros((2, 3)),
        np.array([np.sum(steps_s), np.sum(steps_s[-2:])]),
        np.zeros(2),
        np.array(["run"] * 2, dtype=object),
        np.array(["ground"] * 2, dtype=object),
    )


@pytest.mark.parametrize("steps_s", [np.full(40, 0.25), np.array([2.0, 3.0, 2.5, 2.5])])
def test_yaw_is_counted_through_whole_turns(steps_s):
    """20 rad in 10 s, by small steps and by steps of most of a turn."""
    windows = spinning(steps_s)
    predicted = window_motion(Icr(), SPINNING, windows)
    np.testing.assert_allclose(predicted[:, 2], 2 * windows.travel_m, rtol=1e-13)
    # The centre of the robot goes round its ICR at (x_icr, 0).
    angle = 2 * windows.travel_m
    circle = 0.1 * np.column_stack([1 - np.cos(angle), -np.sin(angle)])
    np.testing.assert_allclose(predicted[:, :2], circle, rtol=0, atol=1e-13)


def differences(model, values, windows, place, size):
    ends = []
    for sign in (1, -1):
        moved = values.copy()
        moved[place] += sign * STEP * size
        ends.append(window_motion(model, moved, windows))
    return (ends[0] - ends[1]) / (2 * STEP)


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
@pytest.mark.parametrize("tilt", [0.0, 0.3], ids=["level", "tilted"])
def test_jacobian_is_the_derivative(model, tilt, winding):
    """In units of each parameter's ordinary size, near the guess, for speeds on no kink."""
    rng = np.random.default_rng(8)
    plain = windows_of([winding], WindowConfig(horizon_m=1.5, stride=0.6))
    plain = plain.where(np.arange(len(plain)) < 25)
    count = len(plain.steps_s)
    inputs = Inputs(
        rng.uniform(-0.9, 1.1, (count, 2)),
        *(tilt * rng.uniform(-1, 1, (2, count))),
        rng.uniform(-2, 2, (count, 2)),
    )
    windows = replace(plain, inputs=inputs)
    sizes = model.ordinary_sizes(ROBOT)
    values = model.pack(model.guess(ROBOT))
    free = [p.name not in COUNTED for p in model.parameters]
    values = values + 0.05 * sizes * rng.uniform(0.2, 1, len(sizes)) * free
    jacobian = derivative_of_motion(model, values, windows) * sizes
    assert jacobian.shape == (len(windows), 3, len(values))
    for place in np.flatnonzero(free):
        np.testing.assert_allclose(
            jacobian[..., place],
            differences(model, values, windows, place, sizes[place]),
            rtol=1e-6,
            atol=1e-7,
            err_msg=model.parameters[place].name,
        )


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_linearised_has_the_motion_of_the_other_face(model, driven):
    if model.name == "icr_inertia_measured":
        return  # nothing was measured here
    windows = windows_of([driven], WindowConfig(horizon_m=1.5, stride=0.6))
    values = model.pack(model.guess(ROBOT))
    predicted, _ = linearised_window_motion(model, values, windows)
    expected = window_motion(model, values, windows)
    np.testing.assert_allclose(predicted, expected, rtol=0, atol=1e-12)


LINEAR = {name: model for name, model in MODELS.items() if model.is_linear_in_speeds}


@pytest.mark.parametrize("model", LINEAR.values(), ids=LINEAR)
def test_sums_that_serve_all_parameters(model, driven, monkeypatch):
    """The same as with the derivative of each sample; speeds of turns from none to three."""
    windows = windows_of([driven], WindowConfig(horizon_m=1.5, stride=0.6))
    speeds = np.random.default_rng(3).uniform(-1, 1, (len(windows.steps_s), 2))
    speeds[::3, 1] = speeds[::3, 0]
    speeds[1::3, 1] = speeds[1::3, 0] * (1 + 3e-4)
    speeds[2::30] *= 300
    windows = replace(windows, inputs=Inputs(speeds))
    values = model.pack(model.guess(ROBOT)) * 1.1
    found = linearised_window_motion(model, values, windows)
    monkeypatch.setattr(type(model), "is_linear_in_speeds", False)
    expected = linearised_window_motion(model, values, windows)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-12 * np.abs(other).max())


@pytest.mark.parametrize("order", [1, -1], ids=["in order", "backwards"])
def test_blocks_make_no_difference(driven, monkeypatch, order):
    """Windows of one block, of many that overlap, and of many in any order."""
    windows = windows_of([driven], WindowConfig(horizon_m=1.5, stride=0.3))
    fields = ("first", "last", "measured")
    windows = replace(windows, **{name: getattr(windows, name)[::order] for name in fields})
    whole = linearised_window_motion(Icr(), SPINNING, windows)
    monkeypatch.setattr(linear_motion, "BLOCK", 7)
    apart = linearised_window_motion(Icr(), SPINNING, windows)
    for one, other in zip(whole, apart, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12)
