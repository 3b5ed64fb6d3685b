"""The region ahead in the images of a run."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.run import Robot, Run
from terrain.camera import Camera
from terrain.checks.sampled_images import spread
from terrain.region import NoRegion, Region, RegionConfig, predict_region

FRAMES = 40  # moments of a run, some milliseconds each
MOST = 0.5
MOVING = 0.05  # of the fastest tread speed
ORDINARY_WIDTH = 1.8  # effective width in track widths, the middle of robots that were measured
SMALLEST_PX = 16  # of a side of the region: SFTA of smaller patches says nothing of texture
WHOLE = RegionConfig(least_share=1.0)  # a camera as it should be shows all of it
OUTSIDE, TINY = "outside the image", f"smaller than {SMALLEST_PX} pixels"


@dataclass(frozen=True)
class RunRegions:
    """The region ahead in the images of a run.

    Attributes
    ----------
    frames : int
        Moments tried, at stamps of images while the robot moved.
    unseen : Mapping of reason to count
    ahead : Region or NoRegion
        When driving straight ahead.
    """

    frames: int
    unseen: Mapping[str, int]
    ahead: Region | NoRegion

    @property
    def in_vain(self) -> bool:
        """Whether the region is unseen in most frames."""
        return self.frames > 0 and sum(self.unseen.values()) > MOST * self.frames


def run_regions(run: Run, camera: Camera) -> RunRegions:
    """Predict the region at moments of a run, by an ordinary effective width."""
    twists, speeds_m_s = motion_at(run, image_rows(run))
    regions = [
        whole_region(camera, run.robot, twist, speed_m_s)
        for twist, speed_m_s in zip(twists, speeds_m_s, strict=True)
    ]
    unseen = Counter(region.reason for region in regions if isinstance(region, NoRegion))
    return RunRegions(len(regions), unseen, straight_ahead(camera, run.robot))


def straight_ahead(camera: Camera, robot: Robot) -> Region | NoRegion:
    """The region of a robot that drives straight on."""
    return whole_region(camera, robot, np.array([1.0, 0.0, 0.0]), 1.0)


def whole_region(
    camera: Camera, robot: Robot, twist: FloatArray, speed_m_s: float
) -> Region | NoRegion:
    """The region by a twist (3,) if the image shows all of it, large enough."""
    region = predict_region(robot, camera, twist, speed_m_s, WHOLE)
    if isinstance(region, NoRegion):
        return NoRegion(OUTSIDE)
    pixels = camera.ground_to_pixels(region.rectangle.corners)
    return region if float(np.ptp(pixels, axis=0).min()) >= SMALLEST_PX else NoRegion(TINY)


def image_rows(run: Run) -> FloatArray:
    """Stamps (F,) of at most FRAMES images, while the treads were recorded and moved."""
    if run.images is None:
        return np.empty(0)
    stamps_s: FloatArray = run.images.stamps_s
    _, speeds_m_s = motion_at(run, stamps_s)
    moving = stamps_s[speeds_m_s > MOVING * max(float(np.max(speeds_m_s, initial=0.0)), 1e-9)]
    return moving[spread(len(moving), FRAMES)] if len(moving) else moving


def motion_at(run: Run, stamps_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Body twists (F, 3) and mean tread speeds (F,) [m/s]; zero outside of odometry.csv."""
    odometry_s = run.odometry.stamps_s
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    speeds = np.nan_to_num(run.odometry.stack("v_left", "v_right"))[np.maximum(rows, 0)]
    speeds[(rows < 0) | (stamps_s > odometry_s[-1])] = 0.0
    left, right = speeds.T
    width_m = ORDINARY_WIDTH * run.robot.track_width
    twists = np.stack([(left + right) / 2, np.zeros(len(left)), (right - left) / width_m], axis=-1)
    return twists, np.abs(speeds).mean(axis=1)
