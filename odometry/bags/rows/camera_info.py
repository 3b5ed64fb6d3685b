"""The table [camera] of run.toml from a CameraInfo."""

from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry.se3 import mount_of_optical

MODELS = ("plumb_bob", "rational_polynomial", "")
FISHEYE = ("equidistant", "fisheye", "kannala_brandt4")  # `camera --file` takes these
STEEP = 0.5  # sine of 30 degrees
COUNTS = (0, 4, 5, 8, 12, 14)  # of coefficients that OpenCV knows


def camera_table(
    info: Any, robot_from_optical: FloatArray | None, *, rectified: bool
) -> tuple[dict[str, Any], list[str]]:
    """The table, without `mount` where that is not known, and what is to be said of it.

    Parameters
    ----------
    info : CameraInfo
        Of either version of ROS.
    robot_from_optical : (4, 4) or None
        Pose of the optical frame (x right, y down, z viewing direction) in the robot frame.
    rectified : bool
        Whether the images are rectified: then P is their matrix, and they have no distortion.
    """
    values = {key: numbers_of(info, key) for key in ("k", "d", "p")}
    matrix, distortion = values["k"].reshape(3, 3), values["d"]
    if rectified:
        matrix, distortion = values["p"].reshape(3, 4)[:, :3], np.zeros(0)
    if not matrix[0, 0] > 0:
        return {}, ["camera: its CameraInfo is not calibrated (the matrix is zero)"]
    if info.distortion_model in FISHEYE and not rectified:
        return {}, [_fisheye(info.distortion_model, robot_from_optical)]
    if info.distortion_model not in MODELS or len(distortion) not in COUNTS:
        return {}, [
            f"camera: the distortion model {info.distortion_model!r} with {len(distortion)} "
            "coefficients is none of OpenCV's order; rectify the images, or calibrate the camera"
        ]
    matrix, size = _of_region(info, matrix)
    table: dict[str, Any] = {
        "image_size": size,
        "matrix": matrix.tolist(),
        "distortion": distortion.tolist() if np.any(distortion) else [],
    }
    if robot_from_optical is not None:
        table["mount"] = list(mount_of_optical(robot_from_optical))
    if info.distortion_model or not table["distortion"]:
        return table, []
    return table, [
        "camera: its CameraInfo does not state the distortion model; the "
        f"{len(distortion)} coefficients are read as plumb_bob (k1, k2, p1, p2, ...). If they are "
        "those of a fisheye lens (equidistant), the table is wrong: calibrate the camera"
    ]


def _fisheye(model: str, robot_from_optical: FloatArray | None) -> str:
    """What to do with a lens that the table cannot state as the message does."""
    mount = ""
    if robot_from_optical is not None:
        numbers = (f"{round(x, 4) + 0.0:g}" for x in mount_of_optical(robot_from_optical))
        mount = f" --mount {' '.join(numbers)}"
    return (
        f"camera: its lens is a fisheye ({model!r}), so that run.toml has no [camera] yet. Print "
        "the CameraInfo into a file (ros2 topic echo --once, rostopic echo -n 1), and convert it: "
        f"terrain-odometry camera RUN --file camera_info.yaml{mount} --out camera --write"
    )


def looks_along_z(robot_from_frame: FloatArray) -> bool:
    """Whether a frame may be an optical one: its z axis points no higher than its x axis.

    Some drivers name the frame of the camera's body, x ahead and z upwards, in their images.
    """
    up = robot_from_frame[2, :3]  # the height of each axis
    return bool(up[2] < STEEP or up[0] > STEEP)


def numbers_of(info: Any, key: str) -> FloatArray:
    """Numbers of a field of a CameraInfo, which ROS 1 writes as a capital letter."""
    values = getattr(info, key, None)
    return np.asarray(getattr(info, key.upper()) if values is None else values, dtype=np.float64)


def _of_region(info: Any, matrix: FloatArray) -> tuple[FloatArray, list[int]]:
    """Matrix and size of the images as sent: cut to the region of interest, then binned."""
    roi = info.roi
    width, height = roi.width or info.width, roi.height or info.height
    moved = matrix.copy()
    moved[:2, 2] -= [roi.x_offset, roi.y_offset]
    binning = np.array([max(1, info.binning_x), max(1, info.binning_y)])
    # pixel 0 of the binned image is the mean of the first pixels: its centre lies between them
    moved[:2, 2] = (moved[:2, 2] + 0.5) / binning - 0.5
    moved[0, 0], moved[1, 1] = moved[0, 0] / binning[0], moved[1, 1] / binning[1]
    return moved, [int(width // binning[0]), int(height // binning[1])]
