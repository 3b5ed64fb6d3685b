import hashlib
import os
from pathlib import Path

import pytest

from odometry.outputs.provenance import Input


def test_the_sum_of_a_file_is_its_sha256(tmp_path):
    file = tmp_path / "set.toml"
    file.write_bytes(b"abc")
    assert Input.of("--parameters", file).sha256(with_images=False) == (
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"  # FIPS 180-4, "abc"
    )


def test_the_sum_of_a_run_folder_is_of_what_is_read(make_run):
    folder = make_run(images="t,file\n0,images/a.png\n")
    (folder / "images").mkdir()
    image = folder / "images" / "a.png"
    image.write_bytes(b"grey")
    before = Input.of("RUN", folder)
    (folder / "notes.txt").write_text("not read")
    assert Input.of("RUN", folder) == before
    sums = {before.sha256(with_images=yes) for yes in (False, True)}
    assert len(sums) == 2
    image.write_bytes(b"green")
    after = Input.of("RUN", folder)
    assert after.sha256(with_images=False) in sums
    assert after.sha256(with_images=True) not in sums
    (folder / "odometry.csv").write_text("t,v_left,v_right\n0,0,0\n")
    assert Input.of("RUN", folder).sha256(with_images=False) not in sums


def test_an_image_whose_name_was_quoted_for_spreadsheets_is_found(make_run):
    folder = make_run(images="t,file\n0,'-a.png\n")
    sums = set()
    for content in (b"grey", b"green"):
        (folder / "-a.png").write_bytes(content)
        sums.add(Input.of("RUN", folder).sha256(with_images=True))
    assert len(sums) == 2


def test_the_sum_of_photographs_is_of_names_and_bytes(tmp_path):
    (tmp_path / "p" / "mud").mkdir(parents=True)
    (tmp_path / "p" / "mud" / "1.jpg").write_bytes(b"mud")
    (tmp_path / "manifest.csv").write_text("path,photo_id\n")
    found = Input.of("PATCHES", tmp_path / "p")
    assert [file.name for file in found.files] == ["1.jpg", "manifest.csv"]
    lines = "".join(
        f"{name}\0{hashlib.sha256(data).hexdigest()}\n"
        for name, data in (("mud/1.jpg", b"mud"), ("../manifest.csv", b"path,photo_id\n"))
    )
    assert found.sha256(with_images=False) == hashlib.sha256(lines.encode()).hexdigest()


@pytest.mark.parametrize("content", ["", "x\n1\n", 't,file\n0,"\n', "t,file\n0,\x00\n", "\xff"])
def test_an_input_that_is_malformed_has_no_images_and_no_error(make_run, content):
    folder = make_run(images=content.encode("latin-1"))
    assert Input.of("RUN", folder).images == ()


def test_a_name_that_is_no_text_has_a_sum(tmp_path):
    (tmp_path / "mud").mkdir()
    Path(os.fsdecode(os.fsencode(tmp_path / "mud") + b"/\xff.jpg")).write_bytes(b"")
    assert len(Input.of("PATCHES", tmp_path).sha256(with_images=False)) == 64


def test_what_is_no_file_is_not_opened(make_run, tmp_path):
    folder = make_run()
    os.mkfifo(folder / "pose.csv")
    assert folder / "pose.csv" not in Input.of("RUN", folder).files
    assert Input.of("RUN", tmp_path / "absent").files == ()
