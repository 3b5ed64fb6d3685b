"""A pitch by which the image shows the region ahead, for a camera that stays where it is."""

from dataclasses import dataclass

import numpy as np

from odometry.run import Robot
from terrain.calibration.look_ahead import LookAhead, look_ahead_whole
from terrain.camera import Camera
from terrain.classification.classifier import Classifier

PITCHES_DEG = np.arange(0, 81)
MARGIN_DEG = 3.0  # the robot rocks by so much


@dataclass(frozen=True)
class SuggestedPitch:
    """Pitches by which the image shows the whole region.

    Attributes
    ----------
    least_deg, most_deg : float
    suggested_deg : float
        That of them, with a margin, which is nearest to the present one.
    ahead : LookAhead
        With the pitch suggested.
    """

    least_deg: float
    most_deg: float
    suggested_deg: float
    ahead: LookAhead


def suggest_pitch(
    camera: Camera, robot: Robot, classifier: Classifier | None = None
) -> SuggestedPitch | None:
    """Find a pitch by which the image shows the whole region; None where no pitch does.

    Parameters
    ----------
    camera : Camera
        With a mount; its place, roll and yaw stay.
    robot : Robot
    classifier : Classifier, optional

    Raises
    ------
    ValueError
        If the camera has no mount.
    """
    if camera.mount is None:
        raise ValueError("a camera without a mount has no pitch")
    found = {}
    for pitch_deg in map(float, PITCHES_DEG):
        ahead = look_ahead_whole(pitched(camera, pitch_deg), robot, classifier)
        if ahead is not None:
            found[pitch_deg] = ahead
    if not found:
        return None
    least, most = _longest_run(sorted(found))
    margin = min(MARGIN_DEG, np.floor((most - least) / 2))
    present_deg = float(np.degrees(camera.mount[4]))
    wanted = float(np.clip(np.rint(present_deg), least + margin, most - margin))
    return SuggestedPitch(least, most, wanted, found[wanted])


def pitched(camera: Camera, pitch_deg: float) -> Camera:
    """The same camera with another pitch of its mount."""
    if camera.mount is None:
        raise ValueError("a camera without a mount has no pitch")
    mount = camera.mount.copy()
    mount[4] = np.radians(pitch_deg)
    return Camera.from_mount(camera.image_size, camera.matrix, camera.distortion, mount)


def _longest_run(values: list[float]) -> tuple[float, float]:
    """First and last of the longest stretch of whole numbers without a hole."""
    parts = np.split(values, np.flatnonzero(np.diff(values) > 1.5) + 1)
    longest = max(parts, key=len)
    return float(longest[0]), float(longest[-1])
