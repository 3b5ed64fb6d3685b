from pathlib import Path

import numpy as np
import pytest

from odometry.errors import RunFolderError
from odometry.recording.run import Run

# Doubles hold these stamps exactly, so that "equal" needs no tolerance.
ODOMETRY = "t,v_left,v_right\n0,1,2\n0.5,3,4\n1,5,6\n"
POSE = "t,x,y,yaw\n-0.25,9,9,0\n0.5,1,2,0.5\n0.75,3,4,1\n2,5,6,0\n"
IMAGES = "t,file\n0.25,a.png\n0.75,b.png\n"


@pytest.fixture
def merged(make_run):
    folder = make_run(odometry=ODOMETRY, pose=POSE, images=IMAGES)
    for name in ("a.png", "b.png"):
        (folder / name).write_bytes(b"not an image: frames do not open it")
    return list(Run.read(folder).frames())


def test_frames_are_the_union_of_all_stamps_in_time_order(merged):
    """But for 1.5, where the last tread speed ends: a median period after the last row."""
    assert [frame.stamp_s for frame in merged] == [-0.25, 0, 0.25, 0.5, 0.75, 1, 1.5, 2]


def test_a_tread_speed_holds_until_the_next_stamp(merged):
    speeds = {frame.stamp_s: frame.tread_speeds_m_s.tolist() for frame in merged}
    assert np.isnan(speeds[-0.25]).all()
    assert speeds[0] == speeds[0.25] == [1, 2]
    assert speeds[0.5] == speeds[0.75] == [3, 4]
    assert speeds[1] == [5, 6]
    assert np.isnan(speeds[1.5]).all()
    assert np.isnan(speeds[2]).all()


def test_the_last_tread_speed_makes_no_frame_of_its_own_where_nothing_lies_beyond(make_run):
    run = Run.read(make_run(odometry=ODOMETRY, pose="t,x,y,yaw\n1.25,0,0,0\n"))
    assert [frame.stamp_s for frame in run.frames()] == [0, 0.5, 1, 1.25]


def test_rows_of_odometry_are_named(merged):
    assert [frame.odometry_row for frame in merged] == [-1, 0, 0, 1, 1, 2, 2, 2]


def test_equal_stamps_make_one_frame(merged):
    (frame,) = (frame for frame in merged if frame.stamp_s == 0.75)
    assert frame.pose.tolist() == [3, 4, 1]
    assert frame.image.name == "b.png"


def test_poses_and_images_are_at_their_own_stamps_only(merged):
    assert [f.stamp_s for f in merged if f.pose is not None] == [-0.25, 0.5, 0.75, 2]
    assert [(f.stamp_s, f.image.name) for f in merged if f.image] == [
        (0.25, "a.png"),
        (0.75, "b.png"),
    ]


def test_image_paths_are_in_the_folder(merged, tmp_path):
    assert merged[2].image == tmp_path / "a_run" / "a.png"


def test_a_run_of_odometry_alone(make_run):
    frames = list(Run.read(make_run(odometry=ODOMETRY)).frames())
    assert [frame.stamp_s for frame in frames] == [0, 0.5, 1]
    assert all(frame.pose is None and frame.image is None for frame in frames)


def test_frames_can_be_requested_twice(make_run):
    run = Run.read(make_run(odometry=ODOMETRY, pose=POSE))
    assert [f.stamp_s for f in run.frames()] == [f.stamp_s for f in run.frames()]


def test_the_pose_of_a_row_with_an_empty_cell_is_nan(make_run):
    run = Run.read(make_run(pose="t,x,y,yaw\n0,1,,0\n"))
    (pose,) = (frame.pose for frame in run.frames() if frame.pose is not None)
    np.testing.assert_equal(pose, [1, np.nan, 0])


def test_truth_makes_no_frames(make_run):
    run = Run.read(make_run(odometry=ODOMETRY, truth="t,x,y,yaw\n0.125,0,0,0\n"))
    assert 0.125 not in [frame.stamp_s for frame in run.frames()]
    assert run.truth.stamps_s.tolist() == [0.125]


def test_wheel_travel_by_hand(make_run):
    """|speeds| of 1.5, 3.5 and 1 m/s, each over half a second; the last row has no successor."""
    run = Run.read(make_run(odometry="t,v_left,v_right\n0,-1,2\n0.5,3,-4\n1,1,1\n"))
    np.testing.assert_allclose(run.wheel_travel_m, [0, 0.75, 2.5], rtol=0, atol=1e-15)


def test_a_spin_on_the_spot_has_wheel_travel(make_run):
    run = Run.read(make_run(odometry="t,v_left,v_right\n0,-1,1\n1,-1,1\n"))
    np.testing.assert_allclose(run.wheel_travel_m, [0, 1])


def test_robot_and_settings(make_run):
    run = Run.read(
        make_run(
            settings='[robot]\ntrack_width = 1.2\nname = "w"\nmass = 590\nlength = 1.5\n'
            'width = 1.4\nwheel_radius = 0.3\n[run]\nterrain = "snow"\n[mine]\nkept = [1, 2]\n'
        )
    )
    assert (run.robot.track_width, run.robot.name, run.robot.mass) == (1.2, "w", 590)
    assert (run.robot.length, run.robot.width, run.robot.wheel_radius) == (1.5, 1.4, 0.3)
    assert run.terrain == "snow"
    assert run.settings["mine"] == {"kept": [1, 2]}
    assert run.name == "a_run"


def test_optional_keys_of_robot_and_run_may_be_absent(make_run):
    run = Run.read(make_run())
    assert (run.robot.length, run.robot.width, run.robot.mass, run.terrain) == (None,) * 4


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ("", ["run.toml", "track_width"]),
        ("[robot]\n", ["run.toml", "track_width"]),
        ("robot = 3\n", ["run.toml", "robot"]),
        ('[robot]\ntrack_width = "wide"\n', ["track_width", "wide"]),
        ("[robot]\ntrack_width = 0\n", ["track_width", "0"]),
        ("[robot]\ntrack_width = -1.5\n", ["track_width", "-1.5"]),
        ("[robot]\ntrack_width = nan\n", ["track_width", "nan"]),
        ("[robot]\ntrack_width = inf\n", ["track_width", "inf"]),
        ("[robot]\ntrack_width = true\n", ["track_width", "True"]),
        ("[robot]\ntrack_width = 1\nmass = -3\n", ["mass", "-3"]),
        ("[robot]\ntrack_width = 1\nlength = 'long'\n", ["length", "long"]),
        ("[robot]\ntrack_width = 1\n[run]\nterrain = 3\n", ["terrain", "3"]),
        ("run = 3\n[robot]\ntrack_width = 1\n", ["run"]),
        ("[robot\n", ["run.toml"]),
        (b"[robot]\ntrack_width = 1\nname = '\xff'\n", ["run.toml"]),
    ],
)
def test_bad_settings_are_named(make_run, settings, words):
    folder = make_run(settings=settings)
    with pytest.raises(RunFolderError) as error:
        Run.read(folder)
    for word in words:
        assert word in str(error.value)


def test_missing_folder_and_files_are_named(make_run, tmp_path):
    with pytest.raises(RunFolderError, match="nowhere"):
        Run.read(tmp_path / "nowhere")
    with pytest.raises(RunFolderError, match=r"run\.toml"):
        Run.read(make_run(settings=None))


def test_missing_odometry_is_named(make_run):
    with pytest.raises(RunFolderError, match=r"odometry\.csv"):
        Run.read(make_run(odometry=None))


def test_every_shared_recording_reads(shared_data):
    folders = sorted(path.parent for path in Path(shared_data / "motion").glob("*/run.toml"))
    assert len(folders) == 31
    for folder in folders:
        run = Run.read(folder)
        assert np.isfinite(run.odometry.stack("v_left", "v_right")).all()
        assert (run.pose is None) == folder.name.startswith("husky_borealtc")
        stamps = [frame.stamp_s for frame in run.frames()]
        assert np.all(np.diff(stamps) > 0)
        assert len(stamps) >= len(run.odometry)
