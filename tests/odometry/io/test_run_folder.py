from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import RunFolderError
from odometry.io.run_folder import write_run_folder
from odometry.recording.run import Run

BAD_TABLES = [
    ("odometry", "t,v_left\n0,1\n", ["odometry.csv", "v_right"]),
    ("odometry", "t,v_left,v_right\n0,1,\n", ["odometry.csv", "row 2", "v_right"]),
    ("odometry", "t,v_left,v_right\n0,1,nan\n", ["odometry.csv", "row 2", "v_right"]),
    ("odometry", "t,v_left,v_right\n", ["odometry.csv"]),
    ("odometry", "t,v_left,v_right,roll\n0,1,1,up\n", ["odometry.csv", "row 2", "roll", "up"]),
    ("pose", "t,x,y\n0,1,1\n", ["pose.csv", "yaw"]),
    ("pose", "t,x,y,yaw\n0.1,1,1,0\n0,1,1,0\n", ["pose.csv", "row 3", "t"]),
    ("velocity", "t,vx,vy\n0,1,1\n", ["velocity.csv", "wz"]),
    ("images", "t\n0\n", ["images.csv", "file"]),
    ("images", "t,file\n0,\n", ["images.csv", "row 2", "file"]),
    ("images", "t,file\n0,gone.png\n", ["images.csv", "row 2", "file", "gone.png"]),
    ("images", "t,file\n\n0,a b.png\n", ["images.csv", "row 3", "'a b.png'"]),
    ("images", "t,file\n0,/etc/hostname\n", ["images.csv", "row 2", "file", "/etc/hostname"]),
    ("truth", "t,x,y,yaw\n0,1,,0\n", ["truth.csv", "row 2", "y"]),
]


@pytest.mark.parametrize(("table", "content", "words"), BAD_TABLES)
def test_file_row_and_column_are_named(make_run, table, content, words):
    folder = make_run(**{table: content})
    with pytest.raises(RunFolderError) as error:
        Run.read(folder)
    for word in words:
        assert word in str(error.value)


def test_optional_columns_and_unknown_ones_are_kept(make_run):
    run = Run.read(
        make_run(
            odometry="terrain,v_right,gyro_z,mine,t,v_left,roll\nsand,2,0.1,7,0,1,0.2\n",
            pose="yaw,y,x,t,window,z\n0.3,0.2,0.1,5,1,9\n",
            velocity="t,vx,vy,wz\n0,,,0.5\n1,,,\n",
        )
    )
    assert run.odometry.stack("v_left", "v_right", "gyro_z", "mine", "roll").tolist() == [
        [1, 2, 0.1, 7, 0.2]
    ]
    assert run.odometry["terrain"].tolist() == ["sand"]
    assert run.pose.stack("x", "y", "yaw", "z", "window").tolist() == [[0.1, 0.2, 0.3, 9, 1]]
    np.testing.assert_equal(run.velocity["vx"], [np.nan, np.nan])
    np.testing.assert_equal(run.velocity["wz"], [0.5, np.nan])


def test_files_that_the_format_does_not_name_are_ignored(make_run):
    assert len(Run.read(make_run(notes="not,a\ntable")).odometry) == 3


def test_images_are_not_opened(make_run):
    folder = make_run(images="t,file\n0,images/one.jpg\n")
    (folder / "images").mkdir()
    (folder / "images" / "one.jpg").write_bytes(b"")
    assert Run.read(folder).images["file"].tolist() == ["images/one.jpg"]


nano = st.integers(-(10**13), 10**13).map(lambda value: value / 1e9)


def columns_of(names, values=nano):
    """Tables of one to six rows: increasing stamps on a grid of microseconds, then `names`."""
    stamps = st.lists(st.integers(0, 10**10), min_size=1, max_size=6, unique=True)
    return stamps.map(sorted).flatmap(
        lambda stamps_us: st.fixed_dictionaries(
            {"t": st.just(np.array(stamps_us) / 1e6)}
            | {
                name: st.lists(values, min_size=len(stamps_us), max_size=len(stamps_us)).map(
                    np.array
                )
                for name in names
            }
        )
    )


TABLES = st.fixed_dictionaries(
    {
        "odometry": columns_of(["v_left", "v_right", "extra"]),
        "pose": columns_of(["x", "y", "yaw"], nano | st.just(np.nan)),
        "truth": columns_of(["x", "y", "yaw", "y_left"]),
    }
)


@settings(max_examples=30)
@given(TABLES, st.floats(0.01, 10), st.text(st.characters(codec="utf-8")))
def test_what_is_written_reads_back(tmp_path_factory, tables, track_width, note):
    folder = tmp_path_factory.getbasetemp() / "round_trip"
    written = {"robot": {"track_width": track_width}, "source": {"note": note, "list": [1, 2]}}
    write_run_folder(folder, written, tables)
    run = Run.read(folder)
    assert run.settings == written
    assert run.robot.track_width == track_width
    read = {"odometry": run.odometry, "pose": run.pose, "truth": run.truth}
    for table, columns in tables.items():
        for name, values in columns.items():
            np.testing.assert_allclose(read[table][name], values, rtol=1e-15, atol=5e-10)


def test_writing_twice_gives_the_same_bytes(tmp_path):
    odometry = {"t": np.arange(3.0), "v_left": np.ones(3) / 3, "v_right": np.zeros(3)}
    for name in ("one", "two"):
        write_run_folder(tmp_path / name, {"robot": {"track_width": 1.0}}, {"odometry": odometry})
    names = sorted(path.name for path in Path(tmp_path / "one").iterdir())
    assert names == ["odometry.csv", "run.toml"]
    for name in names:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


@pytest.mark.parametrize("name", ["../x.png", "images/../../x.png", "link.png", "linked/x.png"])
def test_images_outside_of_the_folder_are_refused(make_run, name):
    folder = make_run(images=f"t,file\n\n0,{name}\n")
    (folder / "images").mkdir()
    (folder.parent / "x.png").touch()
    (folder / "link.png").symlink_to(folder.parent / "x.png")
    (folder / "linked").symlink_to(folder.parent)
    with pytest.raises(RunFolderError, match=r"images\.csv: row 3, column 'file': .* leads out"):
        Run.read(folder)


def test_a_folder_behind_a_symbolic_link_is_read(make_run):
    folder = make_run(images="t,file\n0,images/one.jpg\n")
    (folder / "images").mkdir()
    (folder / "images" / "one.jpg").touch()
    way = folder.with_name("way")
    way.symlink_to(folder)
    assert len(Run.read(way).images) == 1


@pytest.mark.parametrize("value", ["1e-300", "1e300", "nan", "1" * 6000, "'wide'", "[1]", "true"])
def test_sizes_that_no_robot_has_are_refused(make_run, value):
    with pytest.raises(RunFolderError, match=r"run\.toml: "):
        Run.read(make_run(f"[robot]\ntrack_width = {value}\n"))
