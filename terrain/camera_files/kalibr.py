"""Kalibr's camchain files: several cameras, each with its lens and the place of an IMU."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from terrain.camera_files.calibration import Calibration
from terrain.camera_files.models import lens_of
from terrain.camera_files.transforms import rigid
from terrain.camera_files.values import matrix, numbers
from terrain.errors import CameraError


def is_kalibr(values: Mapping[str, Any]) -> bool:
    """Whether a file holds cameras as Kalibr describes them."""
    return bool(_cameras(values))


def read_kalibr(values: Mapping[str, Any], name: str | None = None) -> Calibration:
    """One camera of a camchain.

    Parameters
    ----------
    values : Mapping
        The file.
    name : str, optional
        `cam0`, ...; may be left out where there is one.

    Raises
    ------
    CameraError
        If there is no such camera, several and no name, or one that is no pinhole.
    """
    cameras = _cameras(values)
    if name is None and len(cameras) > 1:
        raise CameraError(f"several cameras: {', '.join(cameras)}; name one")
    chosen = name or next(iter(cameras))
    if chosen not in cameras:
        raise CameraError(f"no camera {chosen!r}; seen: {', '.join(cameras)}")
    camera = cameras[chosen]
    model = str(camera.get("camera_model", "pinhole"))
    if model != "pinhole":
        raise CameraError(
            f"{chosen}: camera_model {model!r}, which [camera] cannot express; calibrate with "
            "Kalibr's pinhole-radtan or pinhole-equi"
        )
    fx, fy, cx, cy = matrix(camera["intrinsics"], f"{chosen}: intrinsics", (1, 4))[0]
    width, height = matrix(camera.get("resolution"), f"{chosen}: resolution", (1, 2))[0]
    if not (np.isfinite([width, height]).all() and width == int(width) and height == int(height)):
        raise CameraError(f"{chosen}: resolution is {width:g} x {height:g}, expected whole numbers")
    lens, notes = lens_of(
        str(camera.get("distortion_model", "none")),
        (int(width), int(height)),
        np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]]),
        numbers(camera.get("distortion_coeffs", []), f"{chosen}: distortion_coeffs"),
    )
    pose = camera.get("T_cam_imu")
    from_imu = None if pose is None else rigid(matrix(pose, "T_cam_imu", (4, 4)), "T_cam_imu")
    return Calibration(chosen, lens, camera_from_imu=from_imu, notes=notes)


def _cameras(values: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    return {
        str(name): entry
        for name, entry in values.items()
        if isinstance(entry, Mapping) and "intrinsics" in entry
    }
