"""`evaluate --with`: poses whose errors would be those of a fault are not counted."""

import numpy as np
import pytest

from odometry.geometry import se3
from odometry.geometry.se3 import OPTICAL_FROM_CAMERA
from odometry.io.csv_table import read_csv_table
from odometry.io.trajectory_files import read_trajectory
from odometry.io.tum import write_spatial_tum
from odometry.trajectory import SpatialTrajectory, Trajectory
from terrain.other_odometry.other_stamps import late_note, repeated_after_s
from tests.terrain.cli.test_evaluate_others import answer, others, winding

__all__ = ["winding"]


def written(file, winding, quaternions=lambda xyzw: xyzw, positions=lambda m: m, separator=" "):
    """Our odometer as a file of another program, its numbers as given."""
    ours = read_trajectory(winding / "results" / "odometer.tum")
    xyzw = np.roll(ours.quaternions_wxyz, -1, axis=1)
    rows = np.column_stack([ours.stamps_s, positions(ours.positions_m), quaternions(xyzw)])
    lines = [separator.join(f"{cell:.9f}" for cell in row) for row in rows]
    file.write_text("\n".join(lines) + "\n")
    return file


def found(winding, file):
    return others(winding, "--with", f"slam={file}")[1]["others"]["other/slam"]


def sloped(xyzw):
    """The same attitudes on a slope, where a wrong order gives no constant yaw."""
    wxyz = np.roll(xyzw, 1, axis=1)
    angles = np.column_stack([np.full(len(wxyz), 0.05), np.full(len(wxyz), -0.08)])
    tilt = se3.rotation_from_roll_pitch_yaw(np.column_stack([angles, np.zeros(len(wxyz))]))
    turned = tilt @ se3.rotation_from_quaternion_wxyz(wxyz)
    return np.roll(se3.quaternion_wxyz(turned), -1, axis=1)


@pytest.mark.parametrize("attitude", [lambda xyzw: xyzw, sloped])
def test_a_quaternion_of_another_order_is_named_and_nothing_is_counted(winding, tmp_path, attitude):
    file = written(tmp_path / "slam.tum", winding, lambda xyzw: np.roll(attitude(xyzw), 1, axis=1))
    result = found(winding, file)
    assert (result["windows"], result["position_m"]["mean"], result["scale"]) == (0, None, None)
    (note,) = result["notes"]
    assert "qw qx qy qz" in note
    right = found(winding, written(file, winding, attitude))
    assert right["windows"] > 0
    assert not any("not counted" in note for note in right["notes"])


def test_a_heading_that_never_changes_is_named(winding, tmp_path):
    still = written(tmp_path / "slam.tum", winding, lambda xyzw: xyzw * 0 + [0, 0, 0, 1])
    result = found(winding, still)
    assert result["windows"] == 0
    assert "heading stays at 0 rad" in result["notes"][0]
    said = answer(winding / "results", "--with", f"slam={still}")
    (row,) = [line for line in said.stdout.splitlines() if "other/slam" in line]
    assert row.split()[-7:] == ["-"] * 7
    assert "not counted" in said.stderr


def test_poses_that_never_move_are_named(winding):
    """As the odometry of a run folder whose bag had speeds alone."""
    kept = winding / "run" / "other_odometry"
    kept.mkdir()
    stamps = np.arange(0.0, 59.0, 0.1)
    (kept / "speeds.csv").write_text(
        "\n".join(["t,x,y,yaw", *(f"{stamp:.2f},0,0,0" for stamp in stamps)])
    )
    try:
        result = others(winding)[1]["others"]["other/speeds"]
    finally:
        (kept / "speeds.csv").unlink()
        kept.rmdir()
    assert result["windows"] == 0
    assert "it never moves" in result["notes"][0]


@pytest.mark.parametrize(
    ("off_m", "turned_rad", "named"), [(0.0, 0.0, True), (0.0, 2.0, True), (0.01, 0.0, False)]
)
def test_the_reference_itself_measures_nothing(winding, tmp_path, off_m, turned_rad, named):
    """In another frame, with fewer digits, as programs write it; not what is a little off."""
    kept = read_csv_table(winding / "results" / "reference.csv", ["t", "x", "y", "yaw"])
    off = off_m * np.sin(kept.stamps_s)
    place = (kept["x"] + off + 1j * kept["y"]) * np.exp(1j * turned_rad) + 5.0 - 2.0j
    yaw = kept["yaw"] + turned_rad
    rows = zip(kept.stamps_s, place.real, place.imag, yaw, strict=True)
    lines = [",".join(f"{cell:.4f}" for cell in row) for row in rows]
    file = tmp_path / "slam.csv"
    file.write_text("\n".join(["t,x,y,yaw", *lines]) + "\n")
    result = found(winding, file)
    assert result["windows"] > 0
    assert any("it is the reference" in note for note in result["notes"]) is named


@pytest.mark.parametrize(("period_s", "found_s"), [(10.0, 10.0), (1e9, None)])
def test_a_shift_may_be_another_by_a_period_of_the_turns(period_s, found_s):
    """A drive in a slalom; and one whose turns never repeat."""
    at_s = np.arange(0.0, 60.0, 0.1)
    never = np.interp(at_s, np.arange(0.0, 63.0, 3.0), np.random.default_rng(4).normal(size=21))
    rate = np.sin(2 * np.pi * at_s / period_s) + (never if found_s is None else 0)
    ours = Trajectory(at_s, np.column_stack([at_s, 0 * at_s, np.cumsum(0.1 * rate)]))
    assert repeated_after_s(ours) == found_s
    assert ("repeat about every 10 s" in late_note(0.4, ours)) is (found_s is not None)


def test_degrees_and_opposite_turns_are_named(winding, tmp_path):
    ours = read_trajectory(winding / "results" / "odometer.tum")
    x, y, yaw = Trajectory(ours.stamps_s, ours.plane.poses).poses.T
    files = {"degrees": (y, np.degrees(yaw)), "opposite": (-y, -yaw)}
    notes = {}
    for name, (left, heading) in files.items():
        rows = zip(ours.stamps_s, x, left, heading, strict=True)
        lines = [",".join(f"{cell:.9f}" for cell in row) for row in rows]
        file = tmp_path / f"{name}.csv"
        file.write_text("\n".join(["t,x,y,yaw", *lines]) + "\n")
        result = found(winding, file)
        notes[name] = (result["windows"] > 0, " ".join(result["notes"]))
    assert notes["degrees"][0] is False
    assert "in degrees" in notes["degrees"][1]
    assert notes["opposite"][0] is True  # its path is what it says: mirrored
    assert "turns are opposite" in notes["opposite"][1]


def test_a_poor_odometer_keeps_its_numbers(winding, tmp_path):
    """Treads that slip turn it by 1.6 times as much, and stamps come with noise."""
    ours = read_trajectory(winding / "results" / "odometer.tum")
    poses = ours.plane.poses * [1.2, 1.2, 1.6]
    poses[:, 2] += np.random.default_rng(1).normal(0, 0.03, len(poses))
    spatial = SpatialTrajectory.from_plane(Trajectory(ours.stamps_s, poses))
    xyzw = np.roll(spatial.quaternions_wxyz, -1, axis=1)
    result = found(winding, written(tmp_path / "slam.tum", winding, lambda _: xyzw))
    assert result["windows"] > 0
    assert not any("turns" in note and "ours" in note for note in result["notes"])


def test_a_body_of_optical_axes_in_a_map_of_ours_is_not_counted(winding, tmp_path):
    ours = read_trajectory(winding / "results" / "odometer.tum")
    turn = se3.pose(np.zeros(3), OPTICAL_FROM_CAMERA)
    write_spatial_tum(tmp_path / "slam.tum", SpatialTrajectory(ours.stamps_s, ours.poses @ turn.T))
    result = found(winding, tmp_path / "slam.tum")
    assert (result["windows"], result["scale"]) == (0, None)
    assert "moves most along its z axis" in result["notes"][0]
    assert "base frame. Its errors are not counted" in result["notes"][0]
