import subprocess

import pytest

from odometry.errors import OutputError
from odometry.outputs.output_file import (
    claim_file,
    is_picture_of,
    is_set_of,
    picture_source,
)
from odometry.parameters import ParameterSet, TerrainParameters, write_parameters
from odometry.report.drawing.figure import save_figure

ICR = {"y_left": 0.3, "y_right": -0.3, "x_icr": 0.0}


def write_set(file, source="", comment=""):
    terrains = {"mud": TerrainParameters("icr", ICR, source=source)}
    write_parameters(file, ParameterSet(terrains), comment)


def claim(file, verb="identify"):
    claim_file(file, is_set_of(verb), verb)


def test_a_set_that_says_which_verb_made_it_is_that_verbs_own(tmp_path, made):
    file = tmp_path / "set.toml"
    claim(file)
    write_set(file, comment=made.to_comment())
    claim(file, "run")
    with pytest.raises(OutputError, match="`identify` did not make it; choose another file"):
        claim(file)


def test_a_set_that_was_edited_since_is_its_users(tmp_path, made):
    file = tmp_path / "set.toml"
    write_set(file, comment=made.to_comment())
    claim(file, made.verb)
    for edited in ('\n[terrain.asphalt]\nmodel = "icr"\n', "# measured by hand\n"):
        with file.open("a", encoding="utf-8") as stream:
            stream.write(edited)
        kept = file.read_bytes()
        with pytest.raises(OutputError, match="did not make it as it is now: it was edited"):
            claim(file, made.verb)
        assert file.read_bytes() == kept
        file.unlink()
        write_set(file, comment=made.to_comment())


@pytest.mark.parametrize(
    ("source", "is_own"),
    [
        ("identified by terrain-odometry from 4 windows of yard", True),
        ("Martinez 2024, Table 2", False),
        ("", False),
    ],
)
def test_a_set_of_version_0_4_is_known_by_its_source(tmp_path, source, is_own):
    file = tmp_path / "set.toml"
    write_set(file, source)
    assert is_set_of("identify")(file) is is_own


@pytest.mark.parametrize("content", [b"", b"\xff\xd8 a photograph", b"[robot]\n", b"terrain = 3\n"])
def test_another_file_is_refused_and_kept(tmp_path, content):
    file = tmp_path / "photo.toml"
    file.write_bytes(content)
    with pytest.raises(OutputError, match="is there already"):
        claim(file)
    assert file.read_bytes() == content


def test_a_link_to_nothing_and_a_folder_are_refused(tmp_path):
    (tmp_path / "link.toml").symlink_to(tmp_path / "absent")
    (tmp_path / "folder.toml").mkdir()
    for name in ("link.toml", "folder.toml"):
        with pytest.raises(OutputError, match="is there already"):
            claim(tmp_path / name)


def test_the_name_of_a_file_of_a_run_folder_is_refused(make_run):
    folder = make_run()
    with pytest.raises(OutputError, match=r"is a run folder, and truth\.csv a file of its own"):
        claim(folder / "truth.csv")
    claim(folder / "set.toml")


def test_what_a_killed_run_left_is_removed(tmp_path):
    with subprocess.Popen(["true"]) as child:
        child.wait()
    left = tmp_path / f".set.{child.pid}.part.toml"
    left.write_text("half")
    claim(tmp_path / "set.toml")
    assert not left.exists()


def test_a_picture_says_which_verb_made_it(tmp_path):
    file = save_figure(
        tmp_path / "a.png", (1, 1), lambda _: None, source=picture_source("identify")
    )
    claim_file(file, is_picture_of("identify"), "identify")
    with pytest.raises(OutputError, match="did not make it"):
        claim_file(file, is_picture_of("ident"), "ident")
    save_figure(file, (1, 1), lambda _: None)
    with pytest.raises(OutputError, match="did not make it"):
        claim_file(file, is_picture_of("identify"), "identify")
