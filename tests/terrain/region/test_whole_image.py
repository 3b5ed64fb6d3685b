"""The whole image: its cells lie on the ground where rays that are cast here say so."""

import numpy as np
import pytest

from odometry.recording.run import UNKNOWN
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.errors import CameraError, TerrainError
from terrain.region.warp import ground_sampling_m
from terrain.region.whole_image import classify_ground, outline, visible_cells

SIZE_M = 0.1


@pytest.fixture
def camera(world):
    return Camera.from_table(world.camera)


def test_every_cell_is_a_square_that_the_image_shows(world, camera):
    seen = world.ground_seen(world.camera)
    step_m = 0.02
    cells = visible_cells(camera, SIZE_M, 1.0)
    assert len(cells) > 10
    for cell in cells:
        assert cell.x_max - cell.x_min == pytest.approx(SIZE_M)
        assert cell.y_max - cell.y_min == pytest.approx(SIZE_M)
        far = max(np.hypot(*corner) for corner in cell.corners)
        for corner in cell.corners:  # some pixel sees the ground close to it
            nearest = np.nanmin(np.hypot(*(seen - corner).transpose(2, 0, 1)))
            assert nearest < step_m * far**2 + 0.005


def test_no_part_of_a_cell_is_out_of_sight(camera):
    """The lens bends the far edge of the image: a gap opens in the middle of the last row."""
    share = np.linspace(0, 1, 15)
    for cell in visible_cells(camera, SIZE_M, 1.0):
        x = cell.x_min + share * (cell.x_max - cell.x_min)
        y = cell.y_min + share * (cell.y_max - cell.y_min)
        points = np.stack(np.meshgrid(x, y), axis=-1)
        assert camera.in_image(camera.ground_to_pixels(points)).all()


def test_cells_do_not_overlap_and_come_row_by_row(camera):
    cells = visible_cells(camera, SIZE_M, 1.0)
    order = [(cell.x_min, -cell.y_max) for cell in cells]
    assert order == sorted(order)
    for i, a in enumerate(cells):
        for b in cells[i + 1 :]:
            apart_x = min(a.x_max, b.x_max) - max(a.x_min, b.x_min) < 1e-9
            apart_y = min(a.y_max, b.y_max) - max(a.y_min, b.y_min) < 1e-9
            assert apart_x or apart_y


def test_a_row_leaves_no_room_for_another_cell(camera):
    """Where both edges of a row are shown without a gap, which the lens makes in the farthest."""
    cells = visible_cells(camera, SIZE_M, 1.0)
    checked = 0
    for x_min in sorted({cell.x_min for cell in cells}):
        row = [cell for cell in cells if cell.x_min == x_min]
        count = len(row)
        y = np.linspace(-3, 3, 6001)
        edges = [np.stack([np.full_like(y, x), y], axis=-1) for x in (x_min, x_min + SIZE_M)]
        seen = [camera.in_image(camera.ground_to_pixels(edge)) for edge in edges]
        held = y[seen[0] & seen[1]]
        if np.diff(held).max() < 0.0011:
            assert count <= np.ptp(held) / SIZE_M < count + 1.2
            middle = (row[0].y_max + row[-1].y_min) / 2
            assert middle == pytest.approx((held[0] + held[-1]) / 2, abs=0.011)
            checked += 1
    assert checked > 10


def test_ground_too_coarse_in_the_image_is_left_out(camera):
    fine = visible_cells(camera, SIZE_M, 0.008)
    assert 0 < len(fine) < len(visible_cells(camera, SIZE_M, 1.0))
    assert max(ground_sampling_m(camera, cell)[1] for cell in fine) <= 0.008
    assert visible_cells(camera, SIZE_M, 1e-6) == []


def test_cells_end_four_metres_ahead():
    level = Camera.from_mount(
        (640, 480), [[500, 0, 320], [0, 500, 240], [0, 0, 1]], [], [0, 0, 1, 0, 0.4, 0]
    )
    assert 3.5 < max(cell.x_max for cell in visible_cells(level, 0.4, 1.0)) <= 4.0


def test_a_camera_that_looks_up_or_back_sees_no_cell():
    for angles in ([0, -0.9, 0], [0, 0.6, np.pi]):
        camera = Camera.from_mount(
            (640, 480), [[500, 0, 320], [0, 500, 240], [0, 0, 1]], [], [0, 0, 1, *angles]
        )
        assert visible_cells(camera, 0.4, 1.0) == []


def test_the_classes_of_the_cells_are_those_of_the_terrain(world, camera, classifier):
    """The edge of boards lies across the image; cells that it cuts may be called anything."""
    edge_m = 0.6
    shift = [world.edges_m[0] - edge_m, 0.0]
    ground = world.ground_seen(world.camera, 3)
    grey = np.where(np.isnan(ground[..., 0]), 255.0, world.across(ground + shift))
    cells = classify_ground(world.shrink(grey, 3), camera, classifier)
    whole = [
        ("boards" if cell.rectangle.x_min > edge_m else "gravel", cell.classification.label)
        for cell in cells
        if not cell.rectangle.x_min < edge_m < cell.rectangle.x_max
    ]
    assert {true for true, _ in whole} == {"boards", "gravel"}
    named = [(true, label) for true, label in whole if label != UNKNOWN]
    assert len(named) >= 0.6 * len(whole)
    assert np.mean([true == label for true, label in named]) > 0.85


def test_the_outline_follows_the_border(camera):
    (cell, *_) = visible_cells(camera, SIZE_M, 1.0)
    points = outline(cell, 5)
    assert points.shape == (20, 2)
    assert points[::5] == pytest.approx(cell.corners)
    steps = np.linalg.norm(np.diff(np.vstack([points, points[:1]]), axis=0), axis=1)
    assert steps == pytest.approx(SIZE_M / 5)


def test_what_cannot_be_cut_is_refused(camera, classifier):
    image = np.zeros((120, 160), np.uint8)
    with pytest.raises(TerrainError, match="metres per pixel"):
        classify_ground(image, camera, TerrainClassifier())
    with pytest.raises(CameraError, match="160x100"):
        classify_ground(image[:100], camera, classifier)
