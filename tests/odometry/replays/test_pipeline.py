from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from odometry.replays.pipeline import ConstantTerrain, replay

ICRS = {"y_left": 0.4, "y_right": -0.3, "x_icr": 0.05, "alpha_left": 0.9}
PARAMETERS = ParameterSet(
    {
        "a": TerrainParameters("icr", ICRS),
        "b": TerrainParameters("icr", {"y_left": 0.8, "y_right": -0.6, "x_icr": -0.1}),
    }
)


@dataclass
class FromStamp:
    """Another terrain from a stamp on; remembers what it was shown."""

    stamp_s: float
    initial: str = "a"

    def __post_init__(self):
        self.shown = []

    def terrain(self, frame, estimate):
        self.shown.append((frame.stamp_s, estimate.stamp_s))
        return "a" if frame.stamp_s < self.stamp_s else "b"


def odometry_csv(stamps_s):
    rows = [f"{t},{0.5 + 0.2 * np.sin(t)},{0.6 - 0.1 * t}\n" for t in stamps_s]
    return "t,v_left,v_right\n" + "".join(rows)


STAMPS_S = np.arange(0, 4.01, 0.25)


def replayed(run, source=None):
    return replay(run, IcrEkf(0.6, PARAMETERS), source or ConstantTerrain("a"))


def reckoned(stamps_s, tables, start):
    """Open loop by 500 midpoint steps between rows, straight from data/README.md."""
    x, y, yaw = start
    places = [(x, y)]
    for (t, until), table in zip(pairwise(stamps_s), tables, strict=True):
        v_left = (0.5 + 0.2 * np.sin(t)) * table.get("alpha_left", 1)
        v_right = (0.6 - 0.1 * t) * table.get("alpha_right", 1)
        omega = (v_right - v_left) / (table["y_left"] - table["y_right"])
        v_x = (v_right * table["y_left"] - v_left * table["y_right"]) / (
            table["y_left"] - table["y_right"]
        )
        v_y, dt = -table["x_icr"] * omega, (until - t) / 500
        for _ in range(500):
            middle = yaw + omega * dt / 2
            x += (v_x * np.cos(middle) - v_y * np.sin(middle)) * dt
            y += (v_x * np.sin(middle) + v_y * np.cos(middle)) * dt
            yaw += omega * dt
        places.append((x, y))
    return np.array(places)


def test_without_poses_odometer_and_filter_are_one_open_loop(make_run):
    result = replayed(Run.read(make_run(odometry=odometry_csv(STAMPS_S))))
    expected = reckoned(STAMPS_S, [ICRS] * 16, (0, 0, 0))
    np.testing.assert_allclose(result.odometer().poses[:, :2], expected, atol=1e-7)
    np.testing.assert_allclose(result.trajectory().poses[:, :2], expected, atol=1e-7)
    np.testing.assert_array_equal(result.stamps_s, STAMPS_S)


def test_the_odometer_takes_the_icrs_held_at_each_moment(make_run):
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S)))
    result = replayed(run, FromStamp(2.0))
    values = {name: dict(table.values) for name, table in PARAMETERS.terrains.items()}
    tables = [values["a"] if t < 2.0 else values["b"] for t in STAMPS_S[:-1]]
    expected = reckoned(STAMPS_S, tables, (0, 0, 0))
    np.testing.assert_allclose(result.odometer().poses[:, :2], expected, atol=1e-7)
    assert result.terrains == ("a",) * 8 + ("b",) * 9


def test_the_odometer_starts_at_the_first_pose_and_is_never_corrected(make_run):
    """Poses that say the robot stands still pull the filter, not the odometer."""
    poses = "t,x,y,yaw\n" + "".join(f"{t},{3 + 1e-6 * t},4,0.5\n" for t in STAMPS_S[2:])
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S), pose=poses))
    result = replayed(run)
    assert result.stamps_s[0] == 0.5
    np.testing.assert_allclose(result.odometer().poses[0], [3, 4, 0.5], atol=1e-5)
    gone = np.linalg.norm(result.odometer().poses[-1, :2] - [3, 4])
    held = np.linalg.norm(result.trajectory().poses[-1, :2] - [3, 4])
    assert gone > 0.5
    assert held < gone / 3


def test_the_ideal_differential_drive(make_run):
    result = replayed(Run.read(make_run(odometry=odometry_csv(STAMPS_S))))
    ideal = {"y_left": 0.25, "y_right": -0.25, "x_icr": 0.0}
    np.testing.assert_allclose(
        result.differential_drive(0.5).poses[:, :2],
        reckoned(STAMPS_S, [ideal] * 16, (0, 0, 0)),
        atol=1e-7,
    )


def test_it_starts_at_the_first_whole_pose_within_the_odometry(make_run):
    poses = "t,x,y,yaw\n-1,9,9,9\n0.1,,2,0\n0.6,1,2,0\n"
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S), pose=poses))
    result = replayed(run)
    assert result.stamps_s[0] == 0.6
    np.testing.assert_array_equal(result.means[0, :3], [1, 2, 0])


def test_a_run_whose_poses_are_all_empty_starts_at_the_origin(make_run):
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S), pose="t,x,y,yaw\n0.6,1,,0\n"))
    np.testing.assert_array_equal(replayed(run).means[0, :3], [0, 0, 0])


def test_poses_outside_of_the_odometry_are_an_error(make_run):
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S), pose="t,x,y,yaw\n99,1,1,0\n"))
    with pytest.raises(RunFolderError, match="pose"):
        replayed(run)


def test_the_replay_ends_with_the_odometry(make_run):
    """The last speeds hold for one period of 0.25 s; of what comes later nothing is known."""
    poses = "t,x,y,yaw\n0,0,0,0\n64,0,0,0\n"
    result = replayed(Run.read(make_run(odometry=odometry_csv(STAMPS_S), pose=poses)))
    assert result.stamps_s[-2:].tolist() == [4.0, 4.25]


def test_the_source_sees_the_first_frame_and_each_with_the_estimate_before_it(make_run):
    run = Run.read(make_run(odometry=odometry_csv(STAMPS_S)))
    source = FromStamp(2.0)
    replayed(run, source)
    before = [STAMPS_S[0], *STAMPS_S[:-1]]
    assert source.shown == list(zip(STAMPS_S, before, strict=True))


def gap_run(make_run):
    """A left turn by the ICRs of "b"; from 10 to 13 s it went straight on, without odometry."""
    t = np.arange(0, 20, 0.05)
    lost = (t > 10.0) & (t < 13.0)
    omega = np.where(lost, 0.0, 0.3 / 1.4)
    ahead, aside = (0.6 * 0.8 + 0.3 * 0.6) / 1.4, 0.1 * omega
    yaw = np.cumsum(np.append(0.0, omega[:-1])) * 0.05
    x = np.cumsum(ahead * np.cos(yaw) - aside * np.sin(yaw)) * 0.05
    y = np.cumsum(ahead * np.sin(yaw) + aside * np.cos(yaw)) * 0.05
    odometry = "t,v_left,v_right\n" + "".join(f"{s},0.3,0.6\n" for s in t[~lost])
    rows = np.column_stack([t, x, y, yaw])[::4]
    pose = "t,x,y,yaw\n" + "".join(",".join(map(str, row)) + "\n" for row in rows.tolist())
    return Run.read(make_run(odometry=odometry, pose=pose))


def test_a_filter_learns_nothing_of_a_gap_of_odometry(make_run):
    run = gap_run(make_run)
    result = replayed(run, ConstantTerrain("b"))
    after = int(np.searchsorted(result.stamps_s, 13.5))
    np.testing.assert_allclose(result.means[after, 3:5], [0.8, -0.6], atol=0.005)
    blind = replayed(replace(run, pose=run.pose.rows(slice(0, 50))), ConstantTerrain("b"))
    before, ended = np.searchsorted(blind.stamps_s, [9.9, 13.0])
    assert blind.sigmas[before, 0] < 1.0
    assert blind.sigmas[ended, 0] > 5.0


def test_what_a_replay_holds(make_run):
    result = replayed(Run.read(make_run(odometry=odometry_csv(STAMPS_S))))
    assert result.means.shape == result.sigmas.shape == (17, 9)
    np.testing.assert_allclose(result.sigmas[5], np.sqrt(np.diag(result.estimates[5].covariance)))
    assert result.jumps.tolist() == [False] * 17


class Remembering(IcrEkf):
    """A filter that remembers the stamps of its frames, and of those in gaps."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.stamps_s, self.in_gaps_s = [], []

    def step(self, estimate, frame, terrain):
        self.stamps_s.append(frame.stamp_s)
        if frame.in_gap:
            self.in_gaps_s.append(frame.stamp_s)
        return super().step(estimate, frame, terrain)


def test_frames_within_gaps_and_at_their_ends_are_marked(make_run):
    """Poses contradict the held speed of one gap; nothing confirms that of the other."""
    stamps_s = [*np.arange(0, 4, 0.25), *np.arange(9, 12, 0.25), *np.arange(17, 20, 0.25)]
    rows = "".join(f"{t},0.5,0.5\n" for t in stamps_s)
    pose = "t,x,y,yaw\n0.0,0.0,0.0,0.0\n3.75,1.875,0.0,0.0\n5.0,1.9,0.0,0.0\n9.0,1.9,0.0,0.0\n"
    run = Run.read(make_run(odometry="t,v_left,v_right\n" + rows, pose=pose))
    ekf = Remembering(0.6, PARAMETERS)
    replay(run, ekf, ConstantTerrain("a"))
    assert ekf.in_gaps_s == [5.0, 9.0, 17.0]
    assert {3.75, 9.25, 11.75} < set(ekf.stamps_s)


@pytest.mark.parametrize(("measured", "has_row"), [(1.0, True), (0.95, True), (0.4, False)])
def test_a_path_by_the_gyroscope_needs_one_that_measured_most_of_the_time(
    make_run, measured, has_row
):
    stamps_s = np.arange(0.0, 20.0, 0.1)
    rows = "".join(f"{t:.1f},0.5,0.6\n" for t in stamps_s)
    rates = "".join(f"{t:.1f},0.1\n" for t in stamps_s[: round(measured * len(stamps_s))])
    folder = make_run(odometry="t,v_left,v_right\n" + rows)
    (folder / "imu.csv").write_text("t,gyro_z\n" + rates)
    result = replayed(Run.read(folder))
    assert result.gyroscope_share == pytest.approx(measured, abs=0.03)
    assert ("gyroscope" in result.open_loop(0.6)) == has_row


def test_of_a_single_estimate_no_share_was_measured(make_run):
    folder = make_run(odometry="t,v_left,v_right,gyro_z\n0,0.5,0.6,0.1\n1,0.5,0.6,0.1\n")
    first = next(iter(replayed(Run.read(folder)).estimates))
    assert Replay([first]).gyroscope_share == 0.0
