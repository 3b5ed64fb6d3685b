"""Images before the start of a replay and after its end have a row and a reason."""

import numpy as np
import pytest

from terrain.main_job import run_odometry


@pytest.fixture(scope="module")
def result(tmp_path_factory, world, classifier):
    """Images from 0.07 s to 4.4 s; odometry from 0.5 s to 3 s, poses from 1 s on."""
    folder = world.drive_straight(tmp_path_factory.mktemp("outside") / "run", world.across, 2.2)
    for name, begin_s, end_s in (("odometry.csv", 0.5, 3.0), ("pose.csv", 1.0, 9.0)):
        header, *rows = (folder / name).read_text().split()
        kept = [row for row in rows if begin_s <= float(row.split(",")[0]) <= end_s]
        (folder / name).write_text("\n".join([header, *kept]) + "\n")
    return run_odometry(folder, model=classifier, terrain="gravel")


def test_every_image_has_a_row_in_order(result):
    stamps_s = [image_label.stamp_s for image_label in result.watcher.image_labels]
    np.testing.assert_array_equal(stamps_s, result.run.images.stamps_s)
    assert len(result.watcher.in_force) == len(stamps_s)


@pytest.mark.parametrize(
    ("begin_s", "end_s", "reason"),
    [
        (0.0, 0.5, "before the first row of odometry.csv"),
        (0.5, 1.0, "before the first pose"),
        (3.2, 9.0, "after the end of odometry.csv"),
    ],
)
def test_an_image_outside_of_the_replay_says_why_it_was_not_read(result, begin_s, end_s, reason):
    within = [s for s in result.watcher.image_labels if begin_s <= s.stamp_s < end_s]
    assert within
    assert {(s.label, s.reason, s.region) for s in within} == {("", reason, None)}


def test_the_terrain_in_force_is_the_first_before_and_the_last_after(result):
    rows = list(zip(result.watcher.image_labels, result.watcher.in_force, strict=True))
    assert {name for s, name in rows if s.stamp_s < 1.0} == {"gravel"}
    assert {name for s, name in rows if s.stamp_s > 3.2} == {result.replay.terrains[-1]}


def test_images_within_the_replay_were_read(result):
    within = [s for s in result.watcher.image_labels if 1.0 <= s.stamp_s <= 3.0]
    assert len(within) > 5
    assert all(image_label.label for image_label in within)
