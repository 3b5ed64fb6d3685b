"""Which ground becomes a patch, and of what terrain it is, by the world that was drawn."""

from collections import Counter
from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from odometry.recording.run import Run
from odometry.tables.table import Table
from terrain.errors import PatchError
from terrain.images import read_image
from terrain.labelling.corrections import Corrections
from terrain.labelling.given_terrain import given_terrain
from terrain.labelling.label_runs import label_runs
from terrain.labelling.patch_files import write_labelled_patches
from terrain.labelling.scale import LabelConfig
from terrain.labelling.square_labels import STRADDLES

SMALL = LabelConfig(place_m=1.0)


@pytest.fixture(scope="module")
def run(across_run):
    return Run.read(across_run)


@pytest.fixture(scope="module")
def files(labelled, tmp_path_factory):
    folder = tmp_path_factory.mktemp("patches") / "out"
    assert write_labelled_patches(folder, labelled) == {}
    return folder


def ground_of(world, square):
    """World x and y of the square's pixels, by the known drive."""
    size = 34
    steps = (np.arange(size) + 0.5) / size
    r = square.rectangle
    x = world.speed_m_s * square.stamp_s + r.x_max - steps * (r.x_max - r.x_min)
    y = r.y_max - steps * (r.y_max - r.y_min)
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)


def true_terrain(world, x):
    return "boards" if world.edges_m[0] < x < world.edges_m[1] else "gravel"


def test_every_patch_lies_on_the_terrain_of_its_label(labelled, world):
    assert Counter(each.label for each in labelled.chosen)["boards"] >= 10
    assert Counter(each.label for each in labelled.chosen)["gravel"] >= 20
    for each in labelled.chosen:
        x = ground_of(world, each.of.square)[..., 0]
        for corner in (x.min(), x.max()):
            assert true_terrain(world, corner) == each.label == each.of.label


def test_ground_at_an_edge_is_left_out_and_counted(labelled, run):
    (left_out,) = labelled.left_out.values()
    assert left_out[STRADDLES] > 5
    assert labelled.seen[run.folder] == len(labelled.chosen) + sum(left_out.values())


def test_a_patch_shows_the_terrain_that_it_is_of(files, labelled, world):
    """Against the textures, drawn from above where the manifest says."""
    for each in labelled.chosen[:: len(labelled.chosen) // 12]:
        patch = read_image(files / each.label / each.of.name).astype(float)
        truth = cv2.resize(world.across(ground_of(world, each.of.square)), patch.shape[::-1])
        near = each.of.square.rectangle.x_max < 0.9  # farther ground is imaged too coarsely
        assert np.corrcoef(patch.ravel(), truth.ravel())[0, 1] > (0.8 if near else 0.3)


def test_a_label_is_of_the_moment_of_passing_not_of_the_image(labelled, world):
    before_the_edge = [
        each
        for each in labelled.chosen
        if each.label == "boards" and world.speed_m_s * each.of.square.stamp_s < world.edges_m[0]
    ]
    assert before_the_edge
    for each in before_the_edge:
        square = each.of.square
        assert square.stamp_s < square.passing.begin_s
        assert world.speed_m_s * square.passing.begin_s > world.edges_m[0] - 0.05


def test_patches_of_one_place_share_their_group_and_no_ground_is_of_two(labelled, world):
    by_place = {}
    for each in labelled.chosen:
        pixels = ground_of(world, each.of.square).reshape(-1, 2)
        by_place.setdefault(each.photo_id, []).append(pixels)
    assert len(by_place) >= 3
    extents = sorted(
        (float(np.concatenate(of)[:, 0].min()), float(np.concatenate(of)[:, 0].max()))
        for of in by_place.values()
    )
    for (_, end), (begin, _) in pairwise(extents):
        assert end <= begin + 1e-3  # along the straight way places do not overlap


def test_two_runs_over_one_place_share_its_group(run, told_spans):
    again = replace(run, folder=run.folder.parent / "across")
    pair = label_runs([run, again], [told_spans(run)] * 2, SMALL)
    groups = {}
    for each in pair.chosen:
        groups.setdefault(each.of.name.split("_", 1)[0], set()).add(each.photo_id)
    assert set(groups) == {"across-1", "across-2"}
    assert groups["across-1"] == groups["across-2"]


def test_images_that_are_labelled_tell_what_they_all_show(run, world):
    images = run.images
    names = np.array([true_terrain(world, world.speed_m_s * t + 0.7) for t in images.stamps_s])
    lines = np.arange(len(images)) + 2
    table = Table("images.csv", {**images.columns, "terrain": names}, lines)
    run = replace(run, images=table)
    found = label_runs([run], [given_terrain(run, "images.csv")], SMALL)
    assert {each.label for each in found.chosen} == {"boards", "gravel"}
    for each in found.chosen:
        x = ground_of(world, each.of.square)[..., 0].mean()
        assert true_terrain(world, x) == each.label


def test_no_more_than_a_place_needs(run, told_spans):
    few = label_runs([run], [told_spans(run)], replace(SMALL, per_place=3))
    assert max(Counter((each.photo_id, each.label) for each in few.chosen).values()) == 3


def test_corrections_are_kept(run, told_spans, labelled):
    names = [each.of.name for each in labelled.chosen if each.label == "gravel"]
    corrections = Corrections({names[0]: "moss"}, frozenset(names[1:3]))
    found = label_runs(
        [run], [told_spans(run)], replace(SMALL, per_place=3), corrections=corrections
    )
    labels = {each.of.name: (each.label, each.of.label) for each in found.chosen}
    assert labels[names[0]] == ("moss", "gravel")
    assert not set(names[1:3]) & set(labels)


def test_corrections_are_not_lost(run, told_spans):
    corrections = Corrections({"across_000_+999_+000.png": "moss"})
    with pytest.raises(PatchError, match="1 patches that were moved by hand"):
        label_runs([run], [told_spans(run)], SMALL, corrections=corrections)


@pytest.mark.parametrize("part", ["images", "camera"])
def test_a_run_without_images_or_camera_is_refused(run, told_spans, part):
    settings = {name: of for name, of in run.settings.items() if name != "camera"}
    other = replace(run, images=None) if part == "images" else replace(run, settings=settings)
    with pytest.raises(PatchError, match=part):
        label_runs([other], [told_spans(run)])


def test_a_camera_that_sees_no_ground_that_is_driven_over_is_refused(run, told_spans):
    mount = [0.2, 0.0, 0.55, 0.0, -1.0, 0.0]  # it looks up
    settings = {**run.settings, "camera": {**run.settings["camera"], "mount": mount}}
    with pytest.raises(PatchError, match="shows terrain"):
        label_runs([replace(run, settings=settings)], [told_spans(run)])


def test_a_view_that_shows_little_more_than_a_square_gives_patches(run, told_spans):
    mount = [0.2, 0.0, 0.3, 0.0, 1.25, 0.0]
    settings = {**run.settings, "camera": {**run.settings["camera"], "mount": mount}}
    labelled = label_runs([replace(run, settings=settings)], [told_spans(run)], SMALL)
    assert min(Counter(each.label for each in labelled.chosen).values()) >= 5


@pytest.mark.parametrize(
    ("config", "message"),
    [
        (LabelConfig(metres_per_pixel=0.02), "expected 32 or more"),
        (LabelConfig(patch_size_px=200, metres_per_pixel=0.01), "more than the width"),
    ],
)
def test_a_scale_without_a_use_is_refused(run, told_spans, config, message):
    with pytest.raises(PatchError, match=message):
        label_runs([run], [told_spans(run)], config)


def test_two_spellings_of_a_terrain_are_refused(run, told_spans):
    given = told_spans(run)
    *others, last, nothing = given.names
    names = (*others, last.capitalize(), nothing)
    with pytest.raises(PatchError, match="'Gravel' and 'gravel' differ by capitals"):
        label_runs([run], [replace(given, names=names)], SMALL)
