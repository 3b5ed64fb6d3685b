"""Grid, footprint and region on an image, against a pinhole that looks straight down."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from odometry.recording.run import Robot
from terrain.camera.camera import Camera
from terrain.region.region import Rectangle, Region
from terrain.report.ground_plots import (
    draw_footprint,
    draw_ground_grid,
    draw_region_ahead,
    ground_legend,
)

FOCAL_PX, HEIGHT_M = 200.0, 2.0
# Straight down, top of the image ahead: u = 160 - f y / z, v = 120 - f x / z.
DOWN = Camera.from_mount(
    (321, 241),
    [[FOCAL_PX, 0, 160], [0, FOCAL_PX, 120], [0, 0, 1]],
    [],
    [0.0, 0.0, HEIGHT_M, 0.0, np.pi / 2, 0.0],
)
UP = Camera.from_mount((321, 241), DOWN.matrix, [], [0.0, 0.0, HEIGHT_M, 0.0, -1.0, 0.0])


@pytest.fixture
def image_axes():
    figure = Figure()
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set(xlim=(-0.5, 320.5), ylim=(240.5, -0.5))
    return axes


def pixel(x, y):
    return [160 - FOCAL_PX * y / HEIGHT_M, 120 - FOCAL_PX * x / HEIGHT_M]


def region(rectangle):
    return Region((rectangle,), 1.0, 0.5, np.zeros(3))


def test_lines_of_the_grid_are_half_a_metre_apart(image_axes):
    assert draw_ground_grid(image_axes, DOWN, None) == 0.5
    across = {round(float(line.get_ydata()[0]), 3) for line in image_axes.lines
              if np.ptp(line.get_ydata()) < 1e-6}  # fmt: skip
    assert across == {pixel(x, 0)[1] for x in (-1.0, -0.5, 0.0, 0.5, 1.0)}
    along = {round(float(line.get_xdata()[0]), 3) for line in image_axes.lines
             if np.ptp(line.get_xdata()) < 1e-6}  # fmt: skip
    assert along == {pixel(0, y)[0] for y in (-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5)}
    written = {text.get_text(): text.xy for text in image_axes.texts}
    assert written["1 m"] == pytest.approx(pixel(1.0, 0.0))


def test_a_far_region_gets_whole_metres(image_axes):
    assert draw_ground_grid(image_axes, DOWN, region(Rectangle(5.0, 6.0, -0.5, 0.5))) == 1.0


def test_footprint_and_region_are_outlined_where_they_are(image_axes):
    draw_footprint(image_axes, DOWN, Robot(0.4, length=0.8, width=0.6))
    draw_region_ahead(image_axes, DOWN, region(Rectangle(0.2, 1.0, -0.3, 0.3)))
    shapes = {patch.get_gid(): patch.get_xy() for patch in image_axes.patches}
    for name, (x_min, x_max) in {"footprint": (-0.4, 0.4), "region ahead": (0.2, 1.0)}.items():
        assert shapes[name].min(axis=0) == pytest.approx(pixel(x_max, 0.3))
        assert shapes[name].max(axis=0) == pytest.approx(pixel(x_min, -0.3))
    draw_ground_grid(image_axes, DOWN, None)
    ground_legend(image_axes, 0.5)
    assert [text.get_text() for text in image_axes.get_legend().get_texts()] == [
        "grid of 0.5 m",
        "footprint",
        "region ahead",
    ]


def test_a_camera_that_looks_up_shows_nothing(image_axes):
    draw_ground_grid(image_axes, UP, None)
    draw_footprint(image_axes, UP, Robot(0.4))
    assert not image_axes.lines
    assert not image_axes.patches
