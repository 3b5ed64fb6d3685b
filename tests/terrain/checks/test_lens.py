"""Distortion that no lens has."""

import pytest

from terrain.camera.camera import Camera
from terrain.checks.recording import lens

MOUNT = [0.0, 0.0, 1.0, 0.0, 0.6, 0.0]


def camera(distortion, focal_px=500.0):
    matrix = [[focal_px, 0, 319.5], [0, focal_px, 239.5], [0, 0, 1]]
    return Camera.from_mount((640, 480), matrix, distortion, MOUNT)


@pytest.mark.parametrize(
    "distortion",
    [
        [],
        [0.0, 0.0, 0.0, 0.0],
        [-0.222735, 0.065242, -0.000148, -0.000156, 0.0],  # of a Husky
        [-0.12, 0.05, 0.0005, -0.0003, 0.0],
    ],
)
def test_real_lenses(distortion):
    assert list(lens(camera(distortion))) == []


def test_folded_pixels_are_counted():
    """r (1 - r^2) turns back at r = 1/sqrt(3), where it is 0.385: pixels beyond have no ray."""
    (finding,) = lens(camera([-1.0, 0.0, 0.0, 0.0]))
    assert "folds the image" in finding.seen
    u, v = [(i - 10) / 10 * 319.5 for i in range(21)], [(i - 10) / 10 * 239.5 for i in range(21)]
    beyond = sum((a * a + b * b) ** 0.5 / 500 > 0.3849 for a in u for b in v)
    assert f"{100 * beyond / 441:.0f} % of its pixels" in finding.seen
    assert "another lens model" in finding.cause


def test_coefficients_in_another_order():
    (finding,) = lens(camera([-0.25, 0.12, -0.03, 0.0005, -0.0003]))
    assert "another order" in finding.cause
