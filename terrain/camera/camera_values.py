"""The values that describe a camera, checked one by one, and what a mount amounts to."""

from collections.abc import Mapping, Sized
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import FloatArray
from terrain.camera.distortion import COEFFICIENT_COUNTS
from terrain.errors import CameraError
from terrain.image_size import PIXELS

LARGEST = 1e9  # of a value in pixels, metres or radians
SHORTEST_FOCUS_PX = 1e-3  # also where matrix is that of an image of one unit

# The optical frame (x right, y down, z viewing direction) from the camera's own (x, y left, z up)
_OPTICAL_FROM_CAMERA = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def finite_array(name: str, values: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """Read-only copy of `values`, or a CameraError that calls them `name`."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise CameraError(f"{name} must hold numbers of shape {shape}: {error}") from error
    if array.shape != shape:
        raise CameraError(f"{name} has shape {array.shape}, expected {shape}")
    if not (np.abs(array) <= LARGEST).all():
        raise CameraError(
            f"{name} holds values that are not finite or above {LARGEST:g}: {array.tolist()}"
        )
    array.setflags(write=False)
    return array


def intrinsic_matrix(matrix: ArrayLike) -> FloatArray:
    """Intrinsic matrix (3, 3) without skew, which OpenCV's lens model does not know."""
    array = finite_array("matrix", matrix, (3, 3))
    pattern = np.array([[0, 1, 0], [1, 0, 0], [1, 1, 1]], dtype=bool)
    if (
        min(array[0, 0], array[1, 1]) < SHORTEST_FOCUS_PX
        or (array[pattern] != [0, 0, 0, 0, 1]).any()
    ):
        raise CameraError(
            f"matrix must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]] with positive fx and fy, "
            f"found {array.tolist()}"
        )
    return array


def lens_coefficients(distortion: ArrayLike) -> FloatArray:
    """Distortion coefficients (n,) of a length that OpenCV knows."""
    count = len(distortion) if isinstance(distortion, Sized) else 1
    if count not in COEFFICIENT_COUNTS:
        raise CameraError(
            f"distortion has {count} values, OpenCV's models have {COEFFICIENT_COUNTS}"
        )
    return finite_array("distortion", distortion, (count,))


def size_in_pixels(image_size: tuple[int, int]) -> tuple[int, int]:
    """Width and height as whole, positive numbers."""
    size = finite_array("image_size", image_size, (2,))
    if (size < 1).any() or (size != np.floor(size)).any() or size.prod() > PIXELS:
        raise CameraError(
            f"image_size must be two positive whole numbers, found {size.tolist()}, and the image "
            f"have at most {PIXELS} pixels"
        )
    return int(size[0]), int(size[1])


def pose_key(table: Mapping[str, Any]) -> str:
    """Name of the key of a camera table that gives the ground plane."""
    missing = [key for key in ("image_size", "matrix", "distortion") if key not in table]
    if missing:
        raise CameraError(f"{', '.join(missing)} missing; found: {sorted(table)}")
    poses = [key for key in ("mount", "ground_to_image") if key in table]
    if len(poses) != 1:
        raise CameraError(
            "exactly one of mount and ground_to_image is needed; "
            f"found: {' and '.join(poses) or 'neither'}"
        )
    return poses[0]


def homography_of_mount(matrix: FloatArray, mount: FloatArray) -> FloatArray:
    """Homography (3, 3) from robot-frame ground points to undistorted pixels, depth positive."""
    if mount[2] <= 0:
        raise CameraError(f"mount has z = {mount[2]:g} m; the camera must be above the ground")
    # p_optical = O R^T (p - c), and a ground point is p = (x, y, 0)
    ground_from_plane = np.column_stack([np.eye(3)[:, :2], -mount[:3]])
    return np.asarray(matrix @ _OPTICAL_FROM_CAMERA @ _rotation(mount).T @ ground_from_plane)


def _rotation(mount: FloatArray) -> FloatArray:
    """Attitude R = Rz(yaw) Ry(pitch) Rx(roll) of a mount."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(mount[3:]), np.cos(mount[3:])
    roll = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    pitch = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    yaw = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(yaw @ pitch @ roll)


def signed_homography(ground_to_image: ArrayLike, intrinsics: FloatArray) -> FloatArray:
    """A homography (3, 3) of any scale and sign with the sign of positive depth."""
    homography = finite_array("ground_to_image", ground_to_image, (3, 3))
    condition = float(np.linalg.cond(np.linalg.solve(intrinsics, homography)))
    if not condition < 1e8:
        raise CameraError(f"ground_to_image is singular (condition number {condition:.1e})")
    # H = s K R [e1 e2 -c] has the determinant -s^3 fx fy c_z: s > 0 above the ground
    return np.asarray(homography * -np.sign(np.linalg.det(homography)))
