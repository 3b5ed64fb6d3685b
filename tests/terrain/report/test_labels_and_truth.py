"""Labels against what was there, and the images that show it."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from terrain.image_labels.image_label import ImageLabel
from terrain.region.region import Rectangle, Region
from terrain.report.labels_and_truth import around_switches, confusion
from terrain.switch.place_labels import PlaceLabel
from terrain.switch.switch import SwitchEvent

STAMPS_S = np.arange(0.0, 20.5, 0.5)  # at 0.5 m/s; snow from 10 s on
ROWS = np.arange(len(STAMPS_S)) + 2
RECTANGLE = Rectangle(0.8, 1.2, -0.2, 0.2)
REGION = Region((RECTANGLE,), 2.0, 1.0, np.array([1.0, 0.0, 0.0]))


def seen(stamp_s, label):
    return ImageLabel(stamp_s, f"{stamp_s}.png", label, 0.9, REGION)


def result_of(image_labels, truth=True):
    speeds = np.full(len(STAMPS_S), 0.5)
    odometry = Table(Path("o.csv"), {"t": STAMPS_S, "v_left": speeds, "v_right": speeds}, ROWS)
    names = np.where(STAMPS_S < 10, "ice", "snow").astype(object)
    table = Table(Path("t.csv"), {"t": STAMPS_S, "terrain": names}, ROWS) if truth else None
    return SimpleNamespace(
        run=Run(Path("run"), Robot(0.4), {}, odometry, truth=table),
        initial_terrain="ice",
        replay=SimpleNamespace(stamps_s=STAMPS_S),
        watcher=SimpleNamespace(image_labels=image_labels),
    )


def test_a_label_is_judged_by_the_place_that_it_speaks_of():
    """One metre ahead at 0.5 m/s is two seconds later."""
    found = confusion(result_of([seen(7.0, "ice"), seen(9.0, "ice"), seen(9.5, "snow")]))
    assert found.names == ("ice", "snow")
    assert found.counts.tolist() == [[1, 1], [0, 1]]


def test_other_labels_have_rows_and_unknown_is_the_last():
    image_labels = [seen(1.0, "unknown"), seen(2.0, "mud"), seen(3.0, "zinc"), seen(9.0, "unknown")]
    found = confusion(result_of(image_labels))
    assert found.said == ("ice", "snow", "mud", "zinc", "unknown")
    assert found.counts.tolist() == [[0, 0], [0, 0], [1, 0], [1, 0], [1, 1]]


def test_places_that_are_not_reached_are_left_out():
    assert confusion(result_of([seen(18.5, "snow")])) is None
    assert confusion(result_of([seen(18.0, "snow")])).counts.sum() == 1


@pytest.mark.parametrize(
    "result",
    [
        result_of([seen(7.0, "ice")], truth=False),
        result_of([]),
        result_of([ImageLabel(7.0, "a.png", reason="the robot is stationary")]),
    ],
)
def test_nothing_to_compare(result):
    assert confusion(result) is None


def switch_at(stamp_s):
    place_label = PlaceLabel("snow", stamp_s, 0.0, np.zeros(2), 1.0)
    return SwitchEvent("snow", stamp_s + 2, place_label, 2.0, 1.0)


def test_images_stand_around_the_first_sight_of_a_change():
    image_labels = [seen(float(t), "ice") for t in range(10)]
    image_labels[5] = ImageLabel(5.0, "5.png", reason="the robot is stationary")
    chosen = around_switches(image_labels, [switch_at(6.0)])
    assert [image_label.stamp_s for image_label in chosen] == [4.0, 6.0, 7.0]


def test_every_change_is_shown_before_any_neighbour():
    image_labels = [seen(float(t), "ice") for t in range(20)]
    chosen = around_switches(image_labels, [switch_at(t) for t in (3.0, 9.0, 15.0)], most=4)
    assert [image_label.stamp_s for image_label in chosen] == [2.0, 3.0, 9.0, 15.0]


def test_without_a_change_images_are_spread_over_the_run():
    image_labels = [seen(float(t), "ice") for t in range(11)]
    assert [s.stamp_s for s in around_switches(image_labels, [], most=3)] == [0.0, 5.0, 10.0]
    assert around_switches([], []) == []
