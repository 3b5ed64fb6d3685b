"""Keys of run.toml that are misspelt, and sizes that no robot has."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.recording import check_recording
from odometry.checks.settings.settings_names import robot_sizes, settings_names
from odometry.recording.run import Robot
from tests.odometry.checks.drives import winding
from tests.odometry.checks.faulty import width, without_gyroscope


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"sensors": {"pos": [0.1, 0, 0]}}, ("[sensors] has a key pos,", "no pose")),
        ({"sensors": {"antenna": [0.1, 0, 0]}}, ("[sensors] has a key antenna,", "no pose")),
        ({"sensors": {"IMU": [0, 0, 0]}}, ("[sensors] has a key IMU,", "no imu")),
        ({"sensor": {"pose": [0.1, 0, 0]}}, ("run.toml has a table [sensor],", "no [sensors]")),
        ({"robot": {"wheelradius": 0.1}}, ("[robot] has a key wheelradius,", "no wheel_radius")),
        ({"run": {"terain": "grass"}}, ("[run] has a key terain,", "no terrain")),
    ],
)
def test_a_key_that_is_not_read_is_noted_with_the_one_that_is_meant(settings, words):
    (found,) = settings_names(Evidence(replace(winding(), settings=settings)))
    assert found.name == "setting_name"
    assert all(word in found.seen for word in words)
    assert "run.toml" in found.seen


@pytest.mark.parametrize(
    "settings",
    [
        {"sensors": {"pose": [0.1, 0, 0], "antenna": "front"}, "source": {"bag": "x"}},
        {"robot": {"name": "husky", "serial": 7}, "simulation": {"seed": 1}, "anything": {}},
    ],
)
def test_other_keys_are_kept_and_not_noted(settings):
    assert list(settings_names(Evidence(replace(winding(), settings=settings)))) == []


@pytest.mark.parametrize("factor", [0.002, 100.0])
def test_a_track_width_in_another_unit_is_named_with_what_was_expected(factor):
    run = replace(without_gyroscope(winding()), pose=None)
    found = check_recording(width(run, factor)).findings
    assert [one.name for one in found if one.level == "warning"] == ["robot_size"]
    assert "expected 0.05 to 6 m" in found[0].seen
    assert "[robot] track_width = " in found[0].seen


@pytest.mark.parametrize("factor", [0.002, 100.0])
def test_turns_say_more_of_a_track_width(factor):
    found = check_recording(width(winding(), factor)).findings
    assert found[0].name == "track_width"
    assert "robot_size" not in [one.name for one in found]


def test_the_check_names_a_mass_in_grams_and_a_misspelt_key():
    robot = Robot(track_width=0.6, mass=5e5)
    run = replace(winding(), robot=robot, settings={"run": {"terain": "grass"}})
    size, key = check_recording(run).findings
    assert (size.name, key.name) == ("robot_size", "setting_name")
    assert "kg" in size.seen


@pytest.mark.parametrize(
    ("toml", "cause"),
    [
        ('[robot]\ntrack_width = "0.6"\n', "The value is no number"),
        ("[robot]\ntrack_width = [0.6]\n", "The value is no number"),
        ("[robot]\ntrack_width = true\n", "The value is no number"),
        ("[robot]\ntrack_width = -0.6\n", "negative or zero"),
        ("[robot]\ntrack_width = 0.6\n[sensors]\npose = 0.3\n", "no list of three numbers"),
        ('[robot]\ntrack_width = 0.6\n[sensors]\npose = ["1", 0, 0]\n', "no list of three numbers"),
        ("[robot]\ntrack_width = 0.6\n[sensors]\npose = [0.1, 0]\n", "no list of three numbers"),
        ("[robot]\ntrack_width = 0.6\n[sensors]\npose = [300, 0, 0]\n", "in mm or cm"),
        ("[robot]\ntrack_width = 0.6\n[sensors]\nimu = [180, 0, 0]\n", "in degrees"),
    ],
)
def test_a_value_of_a_wrong_type_is_not_called_another_unit(toml, cause, tmp_path):
    (tmp_path / "run.toml").write_text(toml)
    (tmp_path / "odometry.csv").write_text("t,v_left,v_right\n0,0,0\n1,0,0\n")
    (found,) = check_recording(tmp_path).findings
    assert cause in found.cause
    assert str(tmp_path / "run.toml") in found.seen


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("track_width", 0.05, 6.0),
        ("length", 0.05, 15.0),
        ("width", 0.05, 8.0),
        ("wheel_radius", 0.01, 2.0),
        ("mass", 0.1, 1e5),
    ],
)
def test_a_size_is_named_where_it_is_beyond_either_end(name, least, most):
    run = winding()

    def found(value):
        sized = replace(run, robot=replace(run.robot, **{name: value}))
        return [one.seen for one in robot_sizes(SimpleNamespace(run=sized))]

    assert found(least) == found(most) == []
    for value in (0.99 * least, 1.01 * most):
        (seen,) = found(value)
        assert f"[robot] {name} = {value:g}" in seen
