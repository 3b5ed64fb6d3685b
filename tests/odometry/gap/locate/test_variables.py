"""Variables of windows, against what they are by definition."""

import numpy as np
import pytest

from odometry.gap.locate.variables import window_variables


@pytest.fixture(scope="module")
def two_grounds(make_scene):
    """One ground up to 40 s, another after."""

    def terrain(t):
        return np.where(t < 40.0, "sand", "grass")

    return make_scene(3, lambda _, twist: twist, duration_s=80.0, terrain=terrain)


def variables(scene, known):
    return {v.name: v.values for v in window_variables(known.base, (), (scene,))}


def held(scene, name, starts):
    """Recorded column at times."""
    stamps_s = scene.run.odometry.stamps_s
    return scene.run.odometry[name][np.searchsorted(stamps_s, starts + 1e-9, side="right") - 1]


def test_means_are_those_of_fine_samples(two_grounds, known):
    found = variables(two_grounds, known)
    ends_s = two_grounds.pose_s[two_grounds.windows[:, -1]]
    fine = np.linspace(two_grounds.start_s, ends_s, 4001)[:-1]
    left, right = held(two_grounds, "v_left", fine), held(two_grounds, "v_right", fine)
    omega = (right - left) / 0.87
    forward = (0.45 * right + 0.42 * left) / 0.87
    for name, expected in {
        "speed": (left + right) / 2,
        "omega": omega,
        "lateral_acceleration": forward * omega,
        "speed_difference": np.abs(right - left),
        "roll": held(two_grounds, "roll", fine),
        "pitch": held(two_grounds, "pitch", fine),
    }.items():
        np.testing.assert_allclose(found[name], expected.mean(axis=0), atol=2e-3, err_msg=name)
    mean_forward = forward.mean(axis=0)
    quick = np.abs(mean_forward) > 0.06
    radius = (mean_forward / omega.mean(axis=0))[quick]
    np.testing.assert_allclose(1 / found["curvature"][quick], radius, rtol=0.05, atol=0.05)
    mean = omega.mean(axis=0)
    expected = np.where(mean > 0.05, "left", np.where(mean < -0.05, "right", "straight"))
    sure = np.abs(np.abs(mean) - 0.05) > 0.01
    assert (found["turn"] == expected)[sure].all()


def test_angles_are_at_the_middle_and_commands_at_the_ends(two_grounds, known):
    found = variables(two_grounds, known)
    ends_s = two_grounds.pose_s[two_grounds.windows[:, -1]]
    middle_s = (two_grounds.start_s + ends_s) / 2
    odometry = two_grounds.run.odometry
    travel = np.concatenate([[0.0], np.cumsum(0.05 * odometry["v_left"])])[:-1]
    angle = np.interp(middle_s, odometry.stamps_s, travel) / 0.165
    assert np.cos(found["left_wheel_angle"] - angle).min() > 1 - 1e-9
    pose = two_grounds.run.pose
    heading = np.interp(middle_s, pose.stamps_s, np.unwrap(pose["yaw"]))
    assert np.cos(found["heading"] - heading).min() > 1 - 1e-9
    assert np.abs(found["heading"]).max() <= np.pi
    before = (held(two_grounds, "v_left", two_grounds.start_s - 0.05)
              + held(two_grounds, "v_right", two_grounds.start_s - 0.05)) / 2  # fmt: skip
    last = (
        held(two_grounds, "v_left", ends_s - 0.05) + held(two_grounds, "v_right", ends_s - 0.05)
    ) / 2
    np.testing.assert_allclose(found["speed_before"], before)
    np.testing.assert_allclose(found["speed_change"], last - before)
    np.testing.assert_allclose(found["time"], two_grounds.start_s)
    assert (found["terrain"] == np.where(middle_s < 40.0, "sand", "grass")).all()


def test_what_was_not_recorded_or_does_not_vary_is_left_out(make_scene, known):
    names = set(variables(make_scene(4, duration_s=60.0), known))
    assert {"speed", "omega", "time"} <= names
    assert not {"roll", "pitch", "terrain"} & names
