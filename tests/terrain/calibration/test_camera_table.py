"""[camera] of run.toml is replaced, and nothing else."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from terrain.calibration.camera_table import replaced, write_camera
from terrain.errors import CalibrationError

NEW = {"image_size": [640, 480], "matrix": [[1.0, 0.0, 2.0], [0.0, 1.0, 3.0], [0.0, 0.0, 1.0]],
       "distortion": [], "mount": [0.1, 0.0, 0.5, 0.0, 0.3, 0.0]}  # fmt: skip
ROBOT = "# my robot\n[robot]\ntrack_width = 0.4   # measured\n"
OLD = """[camera]   # old
image_size = [320, 240]
matrix = [
  [100.0, 0.0, 160.0],
  [0.0, 100.0, 120.0],
  [0.0, 0.0, 1.0]
]
distortion = [0.1, 0.0, 0.0, 0.0]
ground_to_image = [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]
lens = "wide"
"""
LAST = "\n# what else\n[source]\nnote = '''\n[camera]\n'''\n"


def written(tmp_path, text):
    file = tmp_path / "run.toml"
    file.write_bytes(text.encode())
    write_camera(tmp_path, NEW)
    return file.read_bytes().decode()


def test_a_table_in_the_middle(tmp_path):
    text = written(tmp_path, ROBOT + "\n" + OLD + LAST)
    assert text.startswith(ROBOT + "\n[camera]\n")
    assert text.endswith(LAST)
    assert tomllib.loads(text)["camera"] == NEW | {"lens": "wide"}


def test_no_table_yet(tmp_path):
    text = written(tmp_path, ROBOT)
    assert text.startswith(ROBOT)
    assert tomllib.loads(text) == tomllib.loads(ROBOT) | {"camera": NEW}


@pytest.mark.parametrize(
    "text",
    [
        ROBOT.rstrip(),
        ROBOT.replace("\n", "\r\n"),
        OLD + ROBOT,
        ROBOT + OLD + "[camera.more]\na = 1\n" + LAST,
    ],
)
def test_other_shapes_of_the_file(tmp_path, text):
    before = tomllib.loads(text)
    after = tomllib.loads(written(tmp_path, text))
    assert {name: after[name] for name in after if name != "camera"} == {
        name: before[name] for name in before if name != "camera"
    }
    assert {key: after["camera"][key] for key in NEW} == NEW


def test_twice_is_the_same(tmp_path):
    once = written(tmp_path, ROBOT + OLD + LAST)
    assert written(tmp_path, once) == once


@pytest.mark.parametrize(
    "text",
    ["camera = {image_size = [1, 2]}\n" + ROBOT, "camera.image_size = [1, 2]\n" + ROBOT,
     "camera = 3\n" + ROBOT, "note = '''\n[camera]\n'''\n" + ROBOT],
)  # fmt: skip
def test_forms_that_cannot_be_replaced_leave_the_file_as_it_was(tmp_path, text):
    with pytest.raises(CalibrationError, match="by hand"):
        written(tmp_path, text)
    assert (tmp_path / "run.toml").read_bytes().decode() == text


@given(st.lists(st.sampled_from([ROBOT, OLD, LAST, "\n", "# a\n"]), max_size=6, unique=True))
def test_any_order_of_parts(parts):
    text = "".join(parts)
    if LAST in parts and (OLD not in parts or parts.index(LAST) < parts.index(OLD)):
        return  # the text in LAST looks like a table: refused, see above
    after = tomllib.loads(replaced(text, NEW))
    before = tomllib.loads(text)
    assert after == before | {"camera": NEW}
