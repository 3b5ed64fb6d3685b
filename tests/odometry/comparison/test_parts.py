from dataclasses import replace

import numpy as np
import pytest

from odometry.comparison.parts import halves, parts_by_ground, windows_of_parts
from odometry.grounds import with_named_ground
from odometry.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.errors import WindowError

ROWS = "t,v_left,v_right,terrain\n0,1,1,\n1,1,1,ice\n2,3,3,ice\n3,0,0,unknown\n4,1,1,ice\n"
POSES = "t,x,y,yaw\n-1,0,0,0\n0,1,0,0\n1,2,0,0\n2.5,3,0,0\n4,4,0,0\n9,5,0,0\n"


def test_a_part_holds_its_rows_and_the_poses_within_them(make_run):
    run = with_named_ground(Run.read(make_run(odometry=ROWS, pose=POSES)), "sand")
    part = replace(parts_by_ground(run, "a")["ice"], start=1, stop=4)
    assert part.rows.tolist() == [False, True, True, False, False]
    cut = part.cut()
    assert cut.odometry.stamps_s.tolist() == [1, 2, 3]
    assert cut.pose.stamps_s.tolist() == [1, 2.5]
    assert run.pose.stamps_s.tolist() == [-1, 0, 1, 2.5, 4, 9]  # untouched


def test_halves_share_the_wheel_travel_on_their_ground(make_run):
    """On ice 1 m, then 3 m: half is reached in the row of 3 m/s. Sand does not count."""
    run = with_named_ground(Run.read(make_run(odometry=ROWS, pose=POSES)), "sand")
    first, second = halves(parts_by_ground(run, "a")["ice"])
    assert (first.start, first.stop, second.start, second.stop) == (0, 2, 2, 5)
    assert not (first.rows & second.rows).any()


def test_halves_of_a_robot_that_stands_are_not_empty(make_run):
    run = with_named_ground(Run.read(make_run(odometry="t,v_left,v_right\n0,0,0\n1,0,0\n")), None)
    first, second = halves(parts_by_ground(run, "a")["ground"])
    assert (first.stop, second.start) == (1, 1)


def test_windows_keep_to_the_ground_of_the_part(bench, tmp_path):
    speeds = np.full((400, 2), 0.5)
    names = ["grass"] * 220 + ["ice"] * 180
    run = with_named_ground(
        Run.read(bench.write(tmp_path / "r", speeds, terrain_column=names)), None
    )
    parts = parts_by_ground(run, "r")
    config = WindowConfig(horizon_m=1.0)
    for ground, part in parts.items():
        windows = windows_of_parts([part], config)
        assert set(windows.terrain) == {ground}
        inside = (windows.start_s >= 11.0) == (ground == "ice")
        assert inside.all()
    with pytest.raises(WindowError, match="no window lies wholly on 'ice' in r"):
        windows_of_parts([parts["ice"]], WindowConfig(horizon_m=5.0, shortest=1.0))
