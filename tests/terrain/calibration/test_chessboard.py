"""A lens from rendered photographs of a chessboard, against the lens that rendered them."""

import cv2
import numpy as np
import pytest

from terrain.calibration.chessboard import (
    BoardView,
    BoardViews,
    Chessboard,
    find_boards,
    photo_files,
)
from terrain.calibration.lens_from_boards import lens_from_boards, what_next
from terrain.errors import CalibrationError
from tests.terrain.calibration.conftest import BOARD, CAMERA, SQUARE_M
from tests.terrain.calibration.rendered import bend, board_poses

CHESSBOARD = Chessboard(*BOARD, SQUARE_M)


def projected(poses, size=(320, 240)):
    """Exact corners of boards at poses, as views without photographs."""
    (fx, _, cx), (_, fy, cy), _ = CAMERA["matrix"]
    flat = CHESSBOARD.corners_m - CHESSBOARD.corners_m.mean(axis=0)
    views = []
    for number, (turn, middle) in enumerate(poses):
        x, y, z = (flat @ turn.T + middle).T
        x, y = bend(x / z, y / z, CAMERA["distortion"])
        views.append(BoardView(f"{number}.png", np.column_stack([fx * x + cx, fy * y + cy])))
    return BoardViews(size, tuple(views), {})


@pytest.mark.slow
def test_the_lens_of_rendered_photographs(board_folder):
    seen = find_boards(photo_files(board_folder), CHESSBOARD)
    assert len(seen.views) + len(seen.without) == 10
    assert len(seen.views) >= 9
    fit = lens_from_boards(seen, CHESSBOARD)
    true = np.array(CAMERA["matrix"])[[0, 1, 0, 1], [0, 1, 2, 2]]
    found = fit.lens.matrix[[0, 1, 0, 1], [0, 1, 2, 2]]
    assert (np.abs(found - true) < 2 * fit.half_interval).all()
    np.testing.assert_allclose(found, true, rtol=0.005)
    assert fit.rms_px < 0.2
    assert fit.rms_px == pytest.approx(np.sqrt(np.mean(fit.photo_rms_px**2)))
    u, v = np.meshgrid(np.linspace(-0.6, 0.6, 9), np.linspace(-0.45, 0.45, 7))
    corner_rays = np.stack([u, v, np.ones_like(u)], axis=-1).reshape(-1, 3)
    pixels, _ = cv2.projectPoints(
        corner_rays, np.zeros(3), np.zeros(3), fit.lens.matrix, fit.lens.distortion
    )
    expected = np.column_stack(bend(u.ravel(), v.ravel(), CAMERA["distortion"]))
    expected = expected * true[:2] + true[2:]
    assert np.abs(pixels[:, 0] - expected).max() < 1.0


def test_exact_corners_give_the_exact_lens():
    seen = projected(board_poses(CAMERA, 14, BOARD, SQUARE_M, np.random.default_rng(1)))
    fit = lens_from_boards(seen, CHESSBOARD)
    np.testing.assert_allclose(fit.lens.matrix, CAMERA["matrix"], atol=0.02)
    assert fit.rms_px < 1e-3


def test_distances_are_in_metres():
    poses = board_poses(CAMERA, 8, BOARD, SQUARE_M, np.random.default_rng(2))
    fit = lens_from_boards(projected(poses), CHESSBOARD)
    true = [np.linalg.norm(middle) for _, middle in poses]
    np.testing.assert_allclose(fit.distances_m, true, rtol=1e-3)


def test_too_few_views_say_what_to_photograph():
    poses = board_poses(CAMERA, 3, BOARD, SQUARE_M, np.random.default_rng(1))
    with pytest.raises(
        CalibrationError, match=r"3 photographs show the board.*Next: .*take 9 more"
    ):
        lens_from_boards(projected(poses), CHESSBOARD)


def test_the_same_view_again_counts_once():
    poses = board_poses(CAMERA, 4, BOARD, SQUARE_M, np.random.default_rng(1)) * 3
    with pytest.raises(CalibrationError, match="12 photographs show the board, 4 of them differ"):
        lens_from_boards(projected(poses), CHESSBOARD)


def test_parallel_boards_leave_the_focal_length_open():
    aims = np.array([(x, y) for x in (-0.3, 0, 0.3) for y in (-0.2, 0.2)])
    poses = [(np.eye(3), np.array([*aim * 0.9, 0.9])) for aim in aims]
    with pytest.raises(CalibrationError, match=r"nearly parallel.*Next: .*tilt the board"):
        lens_from_boards(projected(poses), CHESSBOARD)


def test_boards_in_one_corner_leave_the_distortion_open():
    poses = board_poses(CAMERA, 150, BOARD, SQUARE_M, np.random.default_rng(1))
    views = [v for v in projected(poses).views if (v.corners_px.max(axis=0) < [213, 160]).all()]
    assert len(views) >= 5
    with pytest.raises(CalibrationError, match=r"of 9 parts.*bottom right"):
        lens_from_boards(BoardViews((320, 240), tuple(views), {}), CHESSBOARD)


def test_a_part_without_corners_is_named():
    poses = board_poses(CAMERA, 40, BOARD, SQUARE_M, np.random.default_rng(3))
    left = [pose for pose in projected(poses).views if pose.corners_px[:, 0].max() < 213]
    assert "top right, middle right, bottom right" in what_next(
        BoardViews((320, 240), tuple(left), {}), 45.0
    )[0].replace("top left, ", "").replace("bottom left, ", "")


def test_squares_counted_for_corners(board_folder):
    counted = Chessboard(BOARD[0] + 1, BOARD[1] + 1, SQUARE_M)
    with pytest.raises(CalibrationError, match="but one of 7 x 5: count the corners"):
        lens_from_boards(find_boards(photo_files(board_folder)[:2], counted), counted)


def test_photographs_without_a_board(tmp_path):
    grey = np.full((240, 320), 90, np.uint8)
    cv2.imwrite(str(tmp_path / "a.png"), grey)
    (tmp_path / "b.jpg").write_bytes(b"no image")
    seen = find_boards(photo_files(tmp_path), CHESSBOARD)
    assert len(seen.without) == 2
    with pytest.raises(CalibrationError, match="0 photographs show the board"):
        lens_from_boards(seen, CHESSBOARD)
    cv2.imwrite(str(tmp_path / "c.png"), grey[:100])
    with pytest.raises(CalibrationError, match=r"320 x 100 pixels.*one camera"):
        find_boards(photo_files(tmp_path), CHESSBOARD)
    with pytest.raises(CalibrationError, match="no such folder"):
        photo_files(tmp_path / "nowhere")


@pytest.mark.parametrize("sizes", [(2, 6, 0.03), (9, 6, 0.0), (9, 6, 30.0), (200, 200, 0.03)])
def test_boards_that_are_none(sizes):
    with pytest.raises(CalibrationError):
        Chessboard(*sizes)
