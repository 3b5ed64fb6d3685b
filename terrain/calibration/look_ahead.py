"""The region of `run` for a robot that drives straight on, and a pitch that shows it."""

from dataclasses import dataclass, replace
from math import inf

import numpy as np

from odometry.arrays import FloatArray
from odometry.recording.run import Robot
from terrain.camera.camera import Camera
from terrain.classification.answer import Classifier
from terrain.region.footprint_parts import Rectangle
from terrain.region.region import NoRegion, Region, RegionConfig, predict_region
from terrain.region.warp import coarsest_m, scale_mismatch

Motion = tuple[FloatArray, float]  # body twist (3,) and mean tread speed [m/s]
STRAIGHT_ON: Motion = (np.array([1.0, 0.0, 0.0]), 1.0)
WHERE_RUN_LOOKS = RegionConfig()
WHOLE = replace(WHERE_RUN_LOOKS, least_share=1.0)
FARTHEST_M, STEP_M = 20.0, 0.01


@dataclass(frozen=True)
class LookAhead:
    """The region ahead of a robot that drives straight on.

    Attributes
    ----------
    region : Region
    whole : bool
        Whether the image shows all of the footprint there, not a part.
    across_px, along_px : float
        A metre at its middle, across and along the way, in pixels.
    """

    region: Region
    whole: bool
    across_px: float
    along_px: float


def look_ahead(
    camera: Camera, robot: Robot, classifier: Classifier | None = None
) -> LookAhead | NoRegion:
    """The region that `run` would classify, or why there is none.

    Parameters
    ----------
    camera : Camera
    robot : Robot
    classifier : Classifier, optional
        The region is no farther than the image is fine enough for it.
    """
    whole = look_ahead_whole(camera, robot, classifier)
    if whole is not None:
        return whole
    region = run_region(camera, robot, classifier)
    if isinstance(region, NoRegion):
        return region
    return LookAhead(region, False, *metre_px(camera, region.place))


def look_ahead_whole(
    camera: Camera, robot: Robot, classifier: Classifier | None = None
) -> LookAhead | None:
    """The same where the image shows all of the footprint, else None."""
    region = run_region(camera, robot, classifier, config=WHOLE)
    if isinstance(region, NoRegion):
        return None
    return LookAhead(region, True, *metre_px(camera, region.place))


def metre_px(camera: Camera, place_m: FloatArray) -> tuple[float, float]:
    """Length of a metre in the image [px] at a place (2,): across (y) and along the way (x)."""
    step = 1e-4
    here = camera.ground_to_pixels(place_m)
    by_y, by_x = (
        float(np.linalg.norm(camera.ground_to_pixels(place_m + step * axis) - here)) / step
        for axis in (np.array([0.0, 1.0]), np.array([1.0, 0.0]))
    )
    return by_y, by_x


def nearest_seen_m(camera: Camera) -> float | None:
    """X of the nearest terrain straight ahead that the image shows, None where it shows none."""
    x = np.arange(0.0, FARTHEST_M, STEP_M)
    seen = camera.shows_terrain(camera.ground_to_pixels(np.stack([x, 0 * x], axis=-1)))
    return float(x[seen.argmax()]) if seen.any() else None


def run_region(
    camera: Camera,
    robot: Robot,
    classifier: Classifier | None,
    motion: Motion = STRAIGHT_ON,
    config: RegionConfig = WHERE_RUN_LOOKS,
) -> Region | NoRegion:
    """The region that `run` would classify in a motion, or why there is none."""

    def misfit(rectangle: Rectangle) -> str:
        if classifier is None:
            return ""
        return scale_mismatch(classifier, camera, rectangle, config.coarsest)

    coarsest = inf if classifier is None else coarsest_m(classifier, config.coarsest)
    return predict_region(
        robot, camera, *motion, config, coarsest_m=coarsest, scale_mismatch=misfit
    )


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
