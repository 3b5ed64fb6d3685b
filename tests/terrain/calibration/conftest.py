"""Photographs of a chessboard by a camera that is known."""

import cv2
import numpy as np
import pytest

from tests.terrain.calibration.rendered import board_photo, board_poses, optical_rays

BOARD, SQUARE_M = (7, 5), 0.04
CAMERA = {
    "image_size": [320, 240],
    "matrix": [[231.0, 0.0, 163.0], [0.0, 233.0, 118.0], [0.0, 0.0, 1.0]],
    "distortion": [-0.22, 0.06, 0.0008, -0.0005],
    "mount": [0.2, -0.05, 0.7, 0.02, 0.6, 0.03],
}


@pytest.fixture(scope="session")
def board_folder(tmp_path_factory):
    """Ten photographs of the board; read only."""
    folder = tmp_path_factory.mktemp("boards")
    rng = np.random.default_rng(5)
    rays = optical_rays(CAMERA)
    for number, pose in enumerate(board_poses(CAMERA, 10, BOARD, SQUARE_M, rng)):
        photo = board_photo(rays, pose, BOARD, SQUARE_M, rng)
        assert cv2.imwrite(str(folder / f"{number:02d}.png"), photo)
    return folder
