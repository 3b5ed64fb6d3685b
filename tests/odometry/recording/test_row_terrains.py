import pytest

from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains, with_named_terrain

ROWS = "t,v_left,v_right,terrain\n0,1,1,\n1,1,1,ice\n2,3,3,ice\n3,0,0,unknown\n4,1,1,ice\n"


@pytest.mark.parametrize(("given", "expected"), [(None, "ground"), ("sand", "sand")])
def test_every_terrain_gets_a_name(make_run, given, expected):
    run = with_named_terrain(Run.read(make_run(odometry=ROWS)), given)
    assert run.terrain == expected
    assert row_terrains(run).tolist() == [expected, "ice", "ice", expected, "ice"]


def test_the_name_in_the_run_goes_before_the_given_one(make_run):
    settings = '[robot]\ntrack_width = 0.4\n[run]\nterrain = "snow"\n'
    run = with_named_terrain(Run.read(make_run(settings=settings)), "sand")
    assert row_terrains(run).tolist() == ["snow"] * 3


def test_what_nobody_names_is_unknown(make_run):
    assert row_terrains(Run.read(make_run())).tolist() == ["unknown"] * 3


@pytest.mark.parametrize(("name", "expected"), [("", "ground"), (" ", "ground"), (" ice ", "ice")])
def test_a_name_is_read_as_in_a_cell(make_run, name, expected):
    """An empty one is none, and spaces around it are no part of it."""
    settings = f'[robot]\ntrack_width = 0.4\n[run]\nterrain = "{name}"\n'
    run = with_named_terrain(Run.read(make_run(settings=settings)), None)
    assert row_terrains(run).tolist() == [expected] * 3
