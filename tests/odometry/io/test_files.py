import pytest

from odometry.errors import OutputError
from odometry.io.files import atomic_write, check_writable


def test_the_file_is_there_when_the_block_ends(tmp_path):
    file = tmp_path / "new" / "a.txt"
    with atomic_write(file) as part:
        part.write_text("whole")
        assert not file.exists()
        assert part.suffix == ".txt"
        assert part.parent == file.parent
    assert file.read_text() == "whole"
    assert list(file.parent.iterdir()) == [file]


def test_a_block_that_raises_leaves_what_was_there(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("before")

    def half_done():
        with atomic_write(file) as part:
            part.write_text("half")
            raise KeyError("stop")

    with pytest.raises(KeyError):
        half_done()
    assert file.read_text() == "before"
    assert list(tmp_path.iterdir()) == [file]


def test_a_folder_that_cannot_be_made_is_known_before(tmp_path):
    check_writable(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="is not a folder"):
        check_writable(tmp_path / "file" / "b")
