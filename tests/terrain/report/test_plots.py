"""What is drawn on the images, and along time."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from odometry.evaluation.stretches import Stretch
from terrain.camera.camera import Camera
from terrain.classification.answer import Classification
from terrain.image_labels.image_label import ImageLabel
from terrain.region.region import Rectangle, Region
from terrain.region.whole_image import Cell
from terrain.report.plots import (
    NO_LABEL,
    draw_cells,
    draw_region,
    plot_confusion,
    plot_image,
    plot_labels,
)

TINTS = {"$ice^$": "#112233", "snow": "#445566", "unknown": "#dddddd"}
RECTANGLE = Rectangle(0.6, 0.9, -0.15, 0.15)
REGION = Region((RECTANGLE,), 2.0, 1.0, np.array([0.75, 0.0, 0.0]))


@pytest.fixture
def axes():
    figure = Figure(figsize=(6.0, 4.0), dpi=100)
    FigureCanvasAgg(figure)
    return figure.add_axes((0.1, 0.1, 0.8, 0.8))


@pytest.fixture
def camera(world):
    return Camera.from_table(world.camera)


def polygons(axes):
    return [patch for patch in axes.patches if isinstance(patch, Polygon)]


def ground_of(pixels, world):
    """Where the rays of pixels meet the ground, by the nearest rays cast without the package."""
    seen = world.ground_seen(world.camera, 4)
    rows, columns = np.rint(4 * pixels.T[::-1] + 1.5).astype(int)
    inside = (rows >= 0) & (rows < seen.shape[0]) & (columns >= 0) & (columns < seen.shape[1])
    return seen[rows[inside], columns[inside]]


def test_an_image_is_shown_as_it_is(axes):
    image = np.arange(60, dtype=np.uint8).reshape(4, 5, 3)
    plot_image(axes, image, "at $5^$")
    (shown,) = axes.images
    assert np.array_equal(shown.get_array(), image)
    assert axes.get_title() == "at $5^$"
    left, right, bottom, top = shown.get_extent()
    assert (left, right, bottom, top) == (-0.5, 4.5, 3.5, -0.5)  # pixel (0, 0) at the origin
    axes.figure.canvas.draw()


def test_the_region_is_outlined_where_its_border_is_seen(axes, camera, world):
    plot_image(axes, np.zeros((120, 160), np.uint8), "")
    draw_region(axes, camera, ImageLabel(1.0, "a.png", "$ice^$", 0.875, REGION), TINTS)
    inner = polygons(axes)[-1]
    assert to_hex(inner.get_edgecolor()) == TINTS["$ice^$"]
    points = ground_of(inner.get_xy(), world)
    assert len(points) > 30
    on_x = np.minimum(abs(points[:, 0] - 0.6), abs(points[:, 0] - 0.9))
    on_y = np.minimum(abs(points[:, 1] - 0.15), abs(points[:, 1] + 0.15))
    assert np.minimum(on_x, on_y).max() < 0.006
    assert [text.get_text() for text in axes.texts] == ["$ice^$ 88 %"]
    draw_region(axes, camera, ImageLabel(1.0, "a.png", "unknown", 0.97, REGION), TINTS)
    assert axes.texts[-1].get_text() == "unknown"  # the confidence is that of a known terrain
    axes.figure.canvas.draw()


def test_a_region_without_a_label_says_so_and_none_draws_nothing(axes, camera):
    draw_region(axes, camera, ImageLabel(1.0, "a.png", region=REGION, reason="too coarse"), TINTS)
    assert [text.get_text() for text in axes.texts] == [NO_LABEL]
    before = len(axes.patches)
    draw_region(axes, camera, ImageLabel(1.0, "a.png", reason="the robot is stationary"), TINTS)
    assert len(axes.patches) == before


def test_cells_are_tinted_by_what_they_were_taken_for(axes, camera):
    cells = [
        Cell(Rectangle(0.6, 0.7, 0.0, 0.1), Classification("snow", 0.9, 0.1, {})),
        Cell(Rectangle(0.7, 0.8, 0.0, 0.1), Classification("unknown", 0.4, 9.0, {})),
    ]
    draw_cells(axes, camera, cells, TINTS)
    tinted = [patch for patch in polygons(axes) if patch.get_fill()]
    assert [to_hex(patch.get_facecolor()) for patch in tinted] == ["#445566", "#dddddd"]
    for patch, cell in zip(tinted, cells, strict=True):
        corners = camera.ground_to_pixels(cell.rectangle.corners)
        assert patch.get_xy()[:-1:16] == pytest.approx(corners)
    assert [text.get_text() for text in axes.texts] == ["snow", "unknown"]


def test_labels_stand_at_their_time_and_row_and_fade_with_doubt(axes):
    image_labels = [
        ImageLabel(1.0, "a.png", "snow", 1.0, REGION),
        ImageLabel(2.0, "b.png", "$ice^$", 0.5, REGION),
        ImageLabel(3.0, "c.png", reason="the robot is stationary"),
        ImageLabel(4.0, "d.png", "snow", 0.2, REGION),
    ]
    force = (Stretch("$ice^$", 0.0, 2.5), Stretch("snow", 2.5, 5.0))
    truth = (Stretch("$ice^$", 0.0, 2.0), Stretch("snow", 2.0, 4.9), Stretch("$ice^$", 4.9, 5.0))
    plot_labels(axes, image_labels, force, truth, TINTS)
    rows = [label.get_text() for label in axes.get_yticklabels()]
    assert rows == ["$ice^$", "snow", NO_LABEL, "in force", "truth"]
    points = {c.get_gid(): c.get_offsets().tolist() for c in axes.collections}
    assert points == {"$ice^$": [[2, 0]], "snow": [[1, 1], [4, 1]], NO_LABEL: [[3, 2]]}
    (snow,) = [c for c in axes.collections if c.get_gid() == "snow"]
    sure, doubtful = snow.get_facecolor()[:, 3]
    assert sure > doubtful > 0
    bars = [(b.get_x(), b.get_x() + b.get_width(), to_hex(b.get_facecolor())) for b in axes.patches]
    tints = [TINTS["$ice^$"], TINTS["snow"]]
    assert bars[:2] == [(0.0, 2.5, tints[0]), (2.5, 5.0, tints[1])]
    assert [bar[2] for bar in bars[2:]] == [*tints, tints[0]]
    assert len(axes.texts) == 4  # the last stretch of truth is too short for its name
    axes.figure.canvas.draw()


def test_without_truth_there_is_no_row_for_it(axes):
    plot_labels(axes, [], (Stretch("snow", 0.0, 5.0),), (), TINTS)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["$ice^$", "snow", "in force"]


def test_a_column_of_the_confusion_is_a_true_terrain(axes):
    plot_confusion(axes, np.array([[3, 0], [1, 0], [0, 0]]), ["$ice^$", "b"], ["$ice^$", "b", "c"])
    (shares,) = axes.images
    assert np.asarray(shares.get_array()).tolist() == [[0.75, 0], [0.25, 0], [0, 0]]
    texts = {tuple(text.get_position()): text.get_text() for text in axes.texts}
    assert texts[0, 0] == "75 %\n3"
    assert texts[0, 1] == "25 %\n1"
    assert texts[1, 2] == "0 %\n0"
    assert [label.get_text() for label in axes.get_xticklabels()] == ["$ice^$", "b"]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("true terrain", "label")
    axes.figure.canvas.draw()


def test_a_long_title_stays_above_its_image():
    axes = Figure(figsize=(9, 3)).subplots(1, 2)[0]
    reason = "unlike the training photographs, and not right with a probability of 0.7 or more"
    plot_image(axes, np.zeros((120, 160), np.uint8), f"8.75 s: {reason}")
    axes.figure.draw_without_rendering()
    image, title = axes.get_window_extent(), axes.title.get_window_extent()
    assert title.width < 1.1 * image.width
    assert axes.get_title().replace("\n", " ") == f"8.75 s: {reason}"
