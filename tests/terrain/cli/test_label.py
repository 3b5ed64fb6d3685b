"""`label`: from a run to patches that `train` reads, and corrections that stay."""

import csv
import json
import re
import shutil
from collections import Counter

import pytest
from click.testing import CliRunner

from terrain.classification.classifier import TerrainClassifier
from terrain.classification.photographs.patches import find_photos
from terrain.cli.verbs.label import label
from terrain.cli.verbs.train import train
from terrain.images import read_image

SPANS = ["--span", "0:3.2=gravel", "--span", "3.2:6=boards", "--span", "6:60=gravel"]


def invoke(*words):
    return CliRunner().invoke(label, [*map(str, words), "--place", "1"])


def rows_of(folder):
    with (folder / "manifest.csv").open(newline="") as stream:
        return {row["path"]: row for row in csv.DictReader(stream)}


@pytest.fixture(scope="module")
def first(across_run, tmp_path_factory):
    """Labelled once; not to be changed."""
    folder = tmp_path_factory.mktemp("labelled") / "patches"
    answer = invoke(across_run, "--out", folder, *SPANS)
    assert answer.exit_code == 0, answer.output
    return folder, answer


@pytest.fixture
def again(across_run, first, tmp_path):
    """A folder of one's own, and the command that labels into it."""
    folder = shutil.copytree(first[0], tmp_path / "patches")
    return folder, lambda: invoke(across_run, "--out", folder, *SPANS)


def test_files_and_manifest_agree_and_a_sheet_shows_each_class(first):
    folder, answer = first
    rows = rows_of(folder)
    files = {path.relative_to(folder).as_posix() for path in folder.glob("*/*")}
    assert files == set(rows)
    for path, row in rows.items():
        assert path.split("/")[0] == row["class"] == row["told"]
        assert read_image(folder / path).shape == (32, 32)
    sheets = sorted(path.name for path in folder.glob("*.png"))
    assert sheets == ["contact_sheet_boards.png", "contact_sheet_gravel.png"]
    counts = Counter(row["class"] for row in rows.values())
    for name, count in counts.items():
        assert any(line.split()[:2] == [name, str(count)] for line in answer.stdout.splitlines())
    assert "astride two terrains" in answer.stdout
    assert answer.stdout.splitlines()[-1].startswith(f"Next: terrain-odometry train {folder}")


@pytest.fixture
def elsewhere(across_run, tmp_path):
    """The same drive, 10 m further on by its poses."""
    copy = shutil.copytree(across_run, tmp_path / "elsewhere")
    header, *rows = (copy / "pose.csv").read_text().splitlines()
    cells = [row.split(",") for row in rows]
    moved = [",".join([t, f"{float(x) + 10:.9g}", *rest]) for t, x, *rest in cells]
    (copy / "pose.csv").write_text("\n".join([header, *moved]) + "\n")
    return copy


@pytest.mark.slow
def test_train_reads_the_folder_by_place(across_run, elsewhere, tmp_path):
    folder = tmp_path / "patches"
    runs = [across_run, elsewhere]
    spans = [f"{run.name}:{span}" for run in runs for span in SPANS[1::2]]
    answer = invoke(*runs, "--out", folder, *(w for span in spans for w in ("--span", span)))
    assert answer.exit_code == 0, answer.output
    photo_ids = {(row["run"], row["photo_id"]) for row in rows_of(folder).values()}
    assert len(photo_ids) == len({photo_id for _, photo_id in photo_ids})
    answer = CliRunner().invoke(train, [str(folder), "--out", str(tmp_path / "a.model")])
    assert answer.exit_code == 0, answer.output
    assert (
        f"Note: the patches are of {', '.join(sorted(run.name for run in runs))}: what is held"
        in (answer.output)
    )
    model = TerrainClassifier.load(tmp_path / "a.model")
    assert model.classes_.tolist() == ["boards", "gravel"]
    rows = rows_of(folder)
    assert model.metres_per_pixel == float(next(iter(rows.values()))["metres_per_pixel"])
    groups = {photo.path.name: photo.group for photo in find_photos(folder)}
    assert groups == {path.split("/")[1]: row["photo_id"] for path, row in rows.items()}


def test_the_same_input_gives_the_same_bytes(across_run, first, tmp_path):
    folder, other = first[0], tmp_path / "patches"
    assert invoke(across_run, "--out", other, *SPANS).exit_code == 0
    for file in folder.rglob("*"):
        if file.is_file():
            assert (other / file.relative_to(folder)).read_bytes() == file.read_bytes()


@pytest.mark.slow
def test_files_that_were_moved_or_removed_stay_so(again):
    folder, label_again = again
    rows = rows_of(folder)
    gravel = sorted(path for path in rows if path.startswith("gravel/"))
    moved, to_new, removed = (path.split("/")[1] for path in gravel[:3])
    (folder / "moss").mkdir()
    (folder / "gravel" / moved).rename(folder / "boards" / moved)
    (folder / "gravel" / to_new).rename(folder / "moss" / to_new)
    (folder / "gravel" / removed).unlink()
    (folder / "boards" / "mine.png").write_bytes((folder / gravel[4]).read_bytes())
    groups = {photo.path.name: (photo.label, photo.group) for photo in find_photos(folder)}
    assert groups[moved] == ("boards", rows[f"gravel/{moved}"]["photo_id"])
    for _ in range(2):
        answer = label_again()
        assert answer.exit_code == 0, answer.output
        assert "Corrections kept: 2 moved, 1 removed." in answer.stdout
        now = rows_of(folder)
        assert now[f"boards/{moved}"]["told"] == "gravel"
        assert now[f"boards/{moved}"]["photo_id"] == rows[f"gravel/{moved}"]["photo_id"]
        assert now[f"moss/{to_new}"]["class"] == "moss"
        found = {path.name: path.parent.name for path in folder.glob("*/*")}
        assert (found[moved], found[to_new]) == ("boards", "moss")
        assert removed not in found
        assert found["mine.png"] == "boards"
    (folder / "boards" / moved).rename(folder / "gravel" / moved)
    assert "Corrections kept: 1 moved, 1 removed." in label_again().stdout


def test_a_file_that_lies_in_two_classes_needs_a_decision(again):
    folder, label_again = again
    name = next(iter(rows_of(folder))).split("/")[1]
    for other in ("moss", "ice"):
        (folder / other).mkdir()
        (folder / other / name).write_bytes((folder / "boards" / name).read_bytes())
    (folder / "boards" / name).unlink()
    answer = label_again()
    assert answer.exit_code == 1
    assert f"{name} lies in ice/{name}, moss/{name}" in str(answer.exception)


def test_damaged_images_are_left_out(across_run, tmp_path):
    copy = shutil.copytree(across_run, tmp_path / "copy")
    (copy / "images/010.png").write_bytes(b"")
    answer = invoke(copy, "--out", tmp_path / "patches", *SPANS)
    assert answer.exit_code == 0, answer.output
    assert "left out: " in answer.stderr
    assert "010.png" in answer.stderr
    assert not any("_010_" in path for path in rows_of(tmp_path / "patches"))


@pytest.mark.parametrize(
    "spans",
    [
        ["0:3"],
        ["0=grass"],
        ["a:3=grass"],
        ["3:3=grass"],
        ["0:nan=grass"],
        ["0:3="],
        ["0:3=unknown"],
        ["other:0:3=grass"],
    ],
)
def test_a_span_of_another_form_is_a_wrong_command_line(across_run, tmp_path, spans):
    answer = invoke(across_run, "--out", tmp_path / "a", *(w for s in spans for w in ("--span", s)))
    assert answer.exit_code == 2
    assert "--span" in answer.output


def test_spans_of_several_runs_name_their_run(across_run, astride_run, tmp_path):
    both = [across_run, astride_run, "--out", tmp_path / "a"]
    assert invoke(*both, "--span", "0:9=gravel").exit_code == 2
    answer = invoke(*both, "--span", "across:0:3.2=gravel")
    assert answer.exit_code == 2
    assert "has no span" in answer.output
    answer = invoke(*both, "--span", "across:3.2:6=boards", "--span", "astride:0:2=gravel")
    assert answer.exit_code == 0, answer.output
    runs = {(row["run"], row["class"]) for row in rows_of(tmp_path / "a").values()}
    assert runs <= {("across", "boards"), ("astride", "gravel")}


def test_a_span_outside_of_the_run_leaves_no_patch_and_says_why(across_run, tmp_path):
    answer = invoke(across_run, "--out", tmp_path / "a", "--span", "1000:2000=gravel")
    assert answer.exit_code == 1
    assert re.search(r"squares of terrain: \d+ of no given terrain", str(answer.exception))


def test_a_terrain_of_which_no_patch_is_left_is_named(across_run, first, tmp_path):
    spans = [*SPANS[:-1], "6:60=gravel", "--span", "300:400=mud"]
    said = invoke(across_run, "--out", tmp_path / "patches", *spans)
    assert said.exit_code == 0
    assert "Note: no patch shows mud: given outside of the recorded time" in said.stdout
    assert "no patch shows" not in first[1].stdout


def test_spans_count_from_the_first_stamp_also_of_a_part(across_run, tmp_path):
    part = tmp_path / "part"
    answer = invoke(across_run, "--out", part, *SPANS, "--from", "1", "--to", "8")
    assert answer.exit_code == 0, answer.output
    rows = rows_of(part)
    assert {row["class"] for row in rows.values()} == {"boards", "gravel"}
    for row in rows.values():
        edges_s = [3.2, 6.0]
        inside = edges_s[0] <= float(row["over_from"]) and float(row["over_to"]) <= edges_s[1]
        assert inside == (row["class"] == "boards")
        assert 1 <= float(row["t"]) <= 8


def test_a_run_that_names_no_terrain_is_refused_with_the_remedy(across_run, tmp_path):
    answer = invoke(across_run, "--out", tmp_path / "a")
    assert answer.exit_code == 1
    assert "--span 0:20=grass" in str(answer.exception)


def test_the_output_says_what_made_it(first):
    folder, _ = first
    content = json.loads((folder / "terrain-odometry.json").read_text())
    assert (content["verb"], content["state"]) == ("label", "finished")
    assert set(content["files"]) >= set(rows_of(folder))
