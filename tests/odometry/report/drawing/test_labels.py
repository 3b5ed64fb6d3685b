"""Labels that do not overlap: an optimum has no better neighbour."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.text import Text

from odometry.report.drawing.figure import LineStyle
from odometry.report.drawing.labels import label_points, spread

NUMBERS = st.lists(
    st.tuples(st.floats(-100, 100), st.floats(1, 20)),
    min_size=1,
    max_size=8,
    unique_by=lambda p: p[0],
)


@given(NUMBERS)
def test_labels_neither_overlap_nor_change_places(pairs):
    positions, heights = np.array(pairs).T
    placed = spread(positions, heights)
    order = np.argsort(positions, kind="stable")
    gaps = np.diff(placed[order])
    assert np.all(gaps >= (heights[order][1:] + heights[order][:-1]) / 2 - 1e-9)


@given(NUMBERS)
def test_labels_stay_around_where_they_were(pairs):
    """The mean of a least squares fit with free offset is that of the data."""
    positions, heights = np.array(pairs).T
    assert spread(positions, heights).mean() == pytest.approx(positions.mean(), abs=1e-9)


def test_labels_with_room_stay():
    positions = np.array([30.0, 0.0, 12.0])
    assert spread(positions, np.full(3, 10.0)) == pytest.approx(positions)


def test_two_labels_in_one_place_share_the_way():
    assert spread(np.array([5.0, 5.0]), np.array([10.0, 20.0])) == pytest.approx([-2.5, 12.5])


def test_labels_stand_apart_on_the_axes(axes):
    axes.set(xlim=(0, 1), ylim=(0, 1))
    points = {"one $x^$": (1.0, 0.5), "two": (1.0, 0.5), "three": (1.0, 0.52)}
    label_points(axes, points, {name: LineStyle("#000000") for name in points})
    axes.figure.canvas.draw()
    boxes = sorted(map(Text.get_window_extent, axes.texts), key=lambda box: box.y0)
    assert [text.get_text() for text in axes.texts] == list(points)
    assert all(low.y1 <= high.y0 + 1 for low, high in pairwise(boxes))


@given(NUMBERS, st.floats(-50, 50))
def test_no_label_reaches_below_a_bound(pairs, low):
    """Labels that were above it stay."""
    positions, heights = np.array(pairs).T
    free, bound = spread(positions, heights), spread(positions, heights, low)
    assert np.all(bound - heights / 2 >= low - 1e-9)
    if np.all(free - heights / 2 >= low):
        np.testing.assert_allclose(bound, free)


def test_labels_of_points_at_the_bottom_stand_above_the_tick_labels(axes):
    axes.set(xlim=(0, 1), ylim=(0, 1))
    points = {"one": (1.0, 0.0), "two": (1.0, 0.01)}
    label_points(axes, points, {name: LineStyle("#000000") for name in points})
    axes.figure.canvas.draw()
    lowest = min(text.get_window_extent().y0 for text in axes.texts)
    assert lowest >= axes.bbox.y0 - 1


def test_no_leader_crosses_another_label(axes):
    """Lines that end in nearly one place, but not at the same x, as paths do."""
    axes.set(xlim=(0, 1), ylim=(0, 1))
    points = {"one": (0.90, 0.45), "another one": (0.99, 0.46), "a third": (0.96, 0.44)}
    label_points(axes, points, {name: LineStyle("#000000") for name in points})
    axes.figure.canvas.draw()
    for text in axes.texts:
        leader = text.arrow_patch.get_path().transformed(text.arrow_patch.get_transform())
        others = [other for other in axes.texts if other is not text]
        for box in map(Text.get_window_extent, others):
            assert not leader.intersects_bbox(box.padded(-1))


def test_a_label_far_to_one_side_stays_beside_its_point(axes):
    """Two lines end at one height, far apart: neither label moves."""
    axes.set(xlim=(0, 1), ylim=(0, 1))
    points = {"one": (0.1, 0.5), "two": (0.9, 0.5)}
    label_points(axes, points, {name: LineStyle("#000000") for name in points})
    one, two = (text.xyann for text in axes.texts)
    assert one == pytest.approx(two)
    assert one[1] == pytest.approx(0.0, abs=1e-9)
