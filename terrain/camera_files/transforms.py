"""Where a camera sits, from a file of transforms between named frames."""

from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se3
from odometry.geometry.se3 import mount_of_optical
from terrain.camera_files.values import matrix, read_values
from terrain.errors import CameraError

DIGITS = 9  # of metres and radians: what is left out is rounding
ROBOT = "base_footprint"  # REP-120: base_link's projection on the terrain


def read_transforms(file: Path) -> dict[tuple[str, str], FloatArray]:
    """Read transforms named T_PARENT__CHILD, which turn points of the child into the parent's.

    Raises
    ------
    CameraError
        Naming the file and the transform that is none; or where there is none at all.
    """
    found = {}
    for key, value in read_values(file).items():
        parent, apart, child = str(key).removeprefix("T_").partition("__")
        if apart and str(key).startswith("T_"):
            name = f"{file}: {key}"
            found[parent, child] = rigid(matrix(_data(value), name, (4, 4)), name)
    if not found:
        raise CameraError(f"{file}: no transforms, expected names such as T_base_link__camera")
    return found


def mount_in(
    transforms: Mapping[tuple[str, str], FloatArray], camera: str, robot: str = ROBOT
) -> FloatArray:
    """The `mount` (6,) of the optical frame `camera` in the frame `robot` on the terrain.

    Parameters
    ----------
    transforms : Mapping of (parent, child) to (4, 4)
    camera : str
        A frame with x right, y down, z along the viewing direction.
    robot : str
        A frame with x forward, y left, z up, its origin on the terrain.

    Raises
    ------
    CameraError
        If a frame is not there, or no transforms lead from the one to the other.
    """
    frames = sorted({frame for pair in transforms for frame in pair})
    for frame in (robot, camera):
        if frame not in frames:
            raise CameraError(f"no frame {frame!r}; found: {', '.join(frames)}{_advice(frame)}")
    reached = {robot: np.eye(4)}
    waiting = deque([robot])
    while waiting:  # by width, so that the fewest rounded transforms are chained
        here = waiting.popleft()
        for (parent, child), pose in transforms.items():
            for one, other, step in ((parent, child, pose), (child, parent, se3.inverse(pose))):
                if one == here and other not in reached:
                    reached[other] = np.asarray(reached[here] @ step)
                    waiting.append(other)
    if camera not in reached:
        raise CameraError(f"no transforms lead from {robot!r} to {camera!r}")
    return np.round(mount_of_optical(reached[camera]), DIGITS) + 0.0  # no -0.0


def _advice(frame: str) -> str:
    if frame != ROBOT:
        return ""
    return (
        f". The height of the camera above the terrain is needed: add T_base_link__{ROBOT} (the "
        "terrain below base_link), or name a frame on the terrain"
    )


def _data(value: Any) -> Any:
    return value.get("data") if isinstance(value, Mapping) else value


ROUNDED = 0.005  # of the entries of a rotation: files write three digits


def rigid(transform: FloatArray, name: str) -> FloatArray:
    """The rigid transform (4, 4) nearest to a matrix that was rounded.

    Raises
    ------
    CameraError
        Naming it, if it is no rotation with a translation.
    """
    rotation = transform[:3, :3]
    if not np.isfinite(transform).all() or (transform[3] != [0, 0, 0, 1]).any():
        raise CameraError(f"{name} is no transform: its last row must be 0 0 0 1")
    u, _, v = np.linalg.svd(rotation)
    nearest = np.asarray(u @ v)
    if np.linalg.det(nearest) < 0 or np.abs(nearest - rotation).max() > ROUNDED:
        raise CameraError(f"{name} is no transform: its 3 x 3 part is no rotation")
    return se3.pose(transform[:3, 3], nearest)
