"""Distortion coefficients that fold the image."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.finding import Finding, Level
from terrain.camera import Camera
from terrain.distortion import undistort

GRID = 21  # pixels tried along each side
FOLDED = 0.02  # share of pixels without a ray: a good calibration has none, or a few in the corners
TANGENTIAL = 0.02  # |p1|, |p2| of real lenses are about 0.001


def lens(camera: Camera) -> Iterator[Finding]:
    """Pixels that no ray reaches, and tangential coefficients that are radial ones."""
    if not camera.distortion.any():
        return
    width, height = camera.image_size
    u, v = np.meshgrid(np.linspace(0, width - 1, GRID), np.linspace(0, height - 1, GRID))
    rays = np.stack([u.ravel(), v.ravel(), np.ones(u.size)], axis=-1)
    normalised = np.asarray(np.linalg.solve(camera.matrix, rays.T).T[:, :2])
    folded = float(np.isnan(undistort(normalised, camera.distortion)).any(axis=1).mean())
    tangential = float(np.abs(camera.distortion[2:4]).max())
    if folded <= FOLDED and tangential <= TANGENTIAL:
        return
    seen = f"distortion = {[float(f'{value:.4g}') for value in camera.distortion]}"
    if folded > FOLDED:
        seen += f" folds the image: {100 * folded:.0f} % of its pixels are of no ray"
    if tangential > TANGENTIAL:
        cause = (
            "Coefficients are in another order than k1, k2, p1, p2, k3 (the third and the fourth "
            "are about 0.001 in real lenses), or of another lens model (fisheye)"
        )
    else:
        cause = (
            "Coefficients are of another lens model (fisheye, division), of another camera, or "
            "matrix has too short a focal length"
        )
    yield Finding("distortion", Level.WARNING, seen, cause, "Calibrate with OpenCV's lens model")
