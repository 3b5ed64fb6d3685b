import numpy as np
import pytest

from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters, read_parameters, write_parameters
from odometry.recording.frames import Frame
from odometry.recording.run import Robot, Run
from odometry.replays.learned_parameters import learned_parameters
from odometry.replays.pipeline import replay

BEFORE = ParameterSet(
    {
        "a": TerrainParameters(
            "icr", {"y_left": 0.3, "y_right": -0.3, "x_icr": 0.0, "alpha_right": 0.9}, source="old"
        ),
        "never": TerrainParameters("icr_symmetric", {"alpha": 0.9, "b_hat": 0.7}, source="old"),
    },
    {"name": "a robot"},
)


class Zones:
    """a, then b, then c, by time."""

    initial = "a"

    def terrain(self, frame, _):
        return "a" if frame.stamp_s < 2 else "b" if frame.stamp_s < 4 else "c"


@pytest.fixture
def result(make_run):
    """Poses on a and b, none on c."""
    stamps_s = np.arange(0, 6.01, 0.25)
    odometry = "t,v_left,v_right\n" + "".join(f"{t},0.2,0.5\n" for t in stamps_s)
    yaws = {t: 0.45 * t for t in stamps_s if t < 4}
    poses = "t,x,y,yaw\n" + "".join(
        f"{t},{0.8 * np.sin(yaw)},{0.8 * (1 - np.cos(yaw))},{yaw}\n" for t, yaw in yaws.items()
    )
    run = Run.read(make_run(odometry=odometry, pose=poses))
    return replay(run, IcrEkf(0.6, BEFORE), Zones())


def test_terrains_with_poses_are_learned_and_others_stay(result):
    learned = learned_parameters(BEFORE, result, "my_run")
    assert list(learned.terrains) == ["a", "never", "b"]
    assert learned.terrains["never"] is BEFORE.terrains["never"]
    assert learned.vehicle == {"name": "a robot"}
    assert "my_run" in learned.terrains["b"].source
    assert " 8 poses" in learned.terrains["b"].source


def test_what_is_written_is_what_the_filter_held_when_it_left(result, tmp_path):
    write_parameters(tmp_path / "learned.toml", learned_parameters(BEFORE, result, "my_run"))
    learned = read_parameters(tmp_path / "learned.toml").terrains["a"]
    (last,) = (e for e in result.estimates if e.stamp_s == 1.75)
    names = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")
    held = [*last.mean[3:6], *last.mean[7:]]
    assert learned.values == dict(zip(names, held, strict=True))
    places = np.ix_([3, 4, 5, 7, 8], [3, 4, 5, 7, 8])
    np.testing.assert_allclose(learned.covariance_of(names), last.covariance[places], rtol=1e-12)


def test_the_next_filter_starts_from_it(result):
    learned = learned_parameters(BEFORE, result, "my_run")
    start = IcrEkf(0.6, learned).start(Frame(0.0, np.zeros(2), 0, None, None), "b")
    (last,) = (e for e in result.estimates if e.stamp_s == 3.75)
    np.testing.assert_array_equal(start.mean[3:6], last.mean[3:6])


def test_a_table_that_is_much_surer_than_a_short_visit_stays(result):
    """The filter left b with some centimetres of uncertainty; the table says 1 mm, or 1 m."""
    values = {"y_left": 0.3, "y_right": -0.3, "x_icr": 0.0}
    for sigma_m, stays in ((1e-3, True), (1.0, False)):
        table = TerrainParameters("icr", values, tuple(values), sigma_m**2 * np.eye(3))
        learned = learned_parameters(ParameterSet({"b": table}), result, "my_run")
        assert (learned.terrains["b"] is table) is stays


@pytest.mark.parametrize("speed_m_s", [0.0, 0.5])
def test_a_robot_that_stands_or_drives_straight_on_teaches_no_new_terrain(make_run, speed_m_s):
    stamps_s = np.arange(0, 6.01, 0.25)
    odometry = "t,v_left,v_right\n" + "".join(f"{t},{speed_m_s},{speed_m_s}\n" for t in stamps_s)
    poses = "t,x,y,yaw\n" + "".join(f"{t},{speed_m_s * t},0,0\n" for t in stamps_s)
    run = Run.read(make_run(odometry=odometry, pose=poses))
    still = replay(run, IcrEkf(0.6, BEFORE), Zones())
    assert list(learned_parameters(BEFORE, still, "my_run").terrains) == ["a", "never"]


def test_the_set_says_the_track_width_that_exports_need(result):
    assert learned_parameters(BEFORE, result, "r", Robot(0.6)).vehicle["track_width"] == 0.6
    stated = ParameterSet(BEFORE.terrains, {"track_width": 0.5})
    assert learned_parameters(stated, result, "r", Robot(0.52)).vehicle == {"track_width": 0.5}


def test_of_a_set_of_another_robot_only_what_was_learned_is_handed_on(result):
    other = ParameterSet(BEFORE.terrains, {"name": "another", "track_width": 1.2})
    learned = learned_parameters(other, result, "r", Robot(0.6))
    assert learned.vehicle == {"track_width": 0.6}
    assert "never" not in learned.terrains
    assert all(table.source.startswith("learned") for table in learned.terrains.values())
