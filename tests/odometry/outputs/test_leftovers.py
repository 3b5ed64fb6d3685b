import os
import subprocess

import pytest

from odometry.outputs.leftovers import remove_stages, remove_temporaries


@pytest.fixture
def gone():
    """The number of a process that has ended."""
    with subprocess.Popen(["true"]) as child:
        child.wait()
    return child.pid


def test_only_our_files_of_processes_that_are_gone_are_removed(tmp_path, gone):
    ours = f".set.{gone}.part.toml"
    others = [
        f".other.{gone}.part.toml",
        f".set.{os.getppid()}.part.toml",
        ".set.part.toml",
        f"set.{gone}.part.toml",
        f".set.{gone}.part.csv",
    ]
    for name in (ours, *others):
        (tmp_path / name).write_text("")
    remove_temporaries(tmp_path, lambda name: name == "set.toml")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(others)


def test_a_temporary_folder_of_this_processs_number_is_of_an_earlier_one(tmp_path, gone):
    for process in (gone, os.getpid()):
        (tmp_path / f".unfinished.{process}.part" / "figures").mkdir(parents=True)
    (tmp_path / ".unfinished.x.part").mkdir()
    remove_stages(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [".unfinished.x.part"]
