import json

import pytest

from odometry.errors import OutputError
from odometry.outputs.manifest import NAME, Manifest, check_finished, read_manifest


def test_what_was_written_is_read(tmp_path):
    manifest = Manifest("gap", "finished", ("gap.json", "figures/a.png"), {"identity": "ab"})
    manifest.write(tmp_path)
    assert read_manifest(tmp_path) == manifest
    assert read_manifest(tmp_path / "other") is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"format": 2}, r"made by a newer version of terrain-odometry \(format 2"),
        ({"format": "1"}, "expected a number"),
        ({"program": "another"}, "it is not of terrain-odometry"),
        ({"state": "sleeping"}, "damaged"),
        ({"files": "all"}, "damaged"),
        ({"made": 3}, "damaged"),
    ],
)
def test_another_content_is_refused_with_what_to_do(tmp_path, change, message):
    Manifest("gap", "finished", ()).write(tmp_path)
    file = tmp_path / NAME
    file.write_text(json.dumps(json.loads(file.read_text()) | change))
    with pytest.raises(OutputError, match=message):
        read_manifest(tmp_path)


@pytest.mark.parametrize("text", ["", "{", "[]", "[" * 100_000])
def test_no_json_is_refused(tmp_path, text):
    (tmp_path / NAME).write_text(text)
    with pytest.raises(OutputError, match="choose another --out, or delete the folder"):
        read_manifest(tmp_path)


def test_of_an_unfinished_folder_only_what_is_ours_is_refused(tmp_path):
    Manifest("demo", "unfinished", ("result.json", "without_vision/result.json")).write(tmp_path)
    for name in (".", "result.json", "without_vision", "without_vision/result.json"):
        with pytest.raises(OutputError, match=r"`terrain-odometry demo` was stopped"):
            check_finished(tmp_path / name)
    check_finished(tmp_path / "notes.txt")
    Manifest("demo", "finished", ("result.json",)).write(tmp_path)
    check_finished(tmp_path / "result.json")
