import pytest

from odometry.io.files import atomic_write


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
