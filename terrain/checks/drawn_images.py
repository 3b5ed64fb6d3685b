"""The region ahead in the images of a run, and the images that are drawn."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import ByteImage, FloatArray, spread
from odometry.recording.run import Robot, Run
from terrain.camera.camera import Camera
from terrain.errors import CameraError, ImageError
from terrain.images import read_image
from terrain.region.region import NoRegion, Region, RegionConfig, predict_region

TRIES = 5  # images that are opened until one can be read

FRAMES = 40  # moments of a run, some milliseconds each
MOST = 0.5
MOVING = 0.05  # of the fastest tread speed
ORDINARY_WIDTH = 1.8  # effective width in track widths, the middle of robots that were measured
SMALLEST_PX = 16  # of a side of the region: SFTA of smaller patches says nothing of texture
WHOLE = RegionConfig(least_share=1.0)  # a camera as it should be shows all of it
OUTSIDE, TINY = "outside the image", f"smaller than {SMALLEST_PX} pixels"


@dataclass(frozen=True)
class ShownImage:
    """An image and the region ahead in it.

    Attributes
    ----------
    run_time_s : float
    image : (H, W) or (H, W, 3)
    camera : Camera or None
        None where the image is not of its size, or there is none.
    region : Region or None
    reason : str
        Why camera or region is None, else "".
    """

    run_time_s: float
    image: ByteImage
    camera: Camera | None
    region: Region | None
    reason: str


def shown_image(run: Run) -> ShownImage | None:
    """An image in the middle of the motion that shows the region ahead, else any one."""
    camera, reason = _camera(run)
    stamps_s = image_rows(run)
    regions = _regions(run, stamps_s, camera, reason)
    by_middle = np.argsort(np.abs(np.arange(len(stamps_s)) - len(stamps_s) / 2), kind="stable")
    best_first = sorted(by_middle, key=lambda place: isinstance(regions[place], str))
    for place in best_first[:TRIES]:
        image = _image_at(run, float(stamps_s[place]))
        if image is not None:
            return _shown(_run_time_s(run, stamps_s[place]), image, camera, regions[place])
    return None


def shown_images(
    run: Run, camera: Camera, most: int, region_at: Callable[[FloatArray, float], Region | NoRegion]
) -> list[ShownImage]:
    """Up to so many images spread over the motion of a run, or over all of it if stationary.

    Parameters
    ----------
    run : Run
    camera : Camera
    most : int
    region_at : callable
        The region ahead by a twist (3,) and a mean tread speed, or why there is none.
    """
    stamps_s = image_rows(run)
    if not len(stamps_s) and run.images is not None:
        stamps_s = run.images.stamps_s
    stamps_s = stamps_s[spread(len(stamps_s), most)] if len(stamps_s) else stamps_s
    found = []
    for stamp_s, twist, speed in zip(stamps_s, *motion_at(run, stamps_s), strict=True):
        image, run_time_s = _image_at(run, float(stamp_s)), _run_time_s(run, stamp_s)
        if image is None:
            continue
        camera.check_size(image)
        region = region_at(twist, float(speed))
        if isinstance(region, NoRegion):
            found.append(ShownImage(run_time_s, image, camera, None, region.reason))
        else:
            found.append(ShownImage(run_time_s, image, camera, region, ""))
    return found


def _regions(
    run: Run, stamps_s: FloatArray, camera: Camera | None, reason: str
) -> list[Region | NoRegion]:
    twists, speeds_m_s = motion_at(run, stamps_s)
    if camera is None:
        return [NoRegion(reason)] * len(stamps_s)
    whole = isinstance(straight_ahead(camera, run.robot), Region)
    config = WHOLE if whole else RegionConfig()
    return [
        shown_region(camera, run.robot, twist, speed, config)
        for twist, speed in zip(twists, speeds_m_s, strict=True)
    ]


def _image_at(run: Run, stamp_s: float) -> ByteImage | None:
    if run.images is None:
        return None
    row = int(np.searchsorted(run.images.stamps_s, stamp_s))
    try:
        return read_image(run.folder / str(run.images["file"][row]))
    except ImageError:
        return None


def _run_time_s(run: Run, stamp_s: float) -> float:
    return float(stamp_s) - float(run.odometry.stamps_s[0])


def _shown(
    run_time_s: float, image: ByteImage, camera: Camera | None, region: Region | NoRegion
) -> ShownImage:
    if camera is None:
        reason = region.reason if isinstance(region, NoRegion) else ""
        return ShownImage(run_time_s, image, None, None, reason)
    height, width = image.shape[:2]
    if (width, height) != camera.image_size:
        reason = "image of {}x{}, [camera] of {}x{}".format(width, height, *camera.image_size)
        return ShownImage(run_time_s, image, None, None, reason)
    if isinstance(region, NoRegion):
        return ShownImage(run_time_s, image, camera, None, f"the region ahead is {region.reason}")
    return ShownImage(run_time_s, image, camera, region, "")


def _camera(run: Run) -> tuple[Camera | None, str]:
    table = run.settings.get("camera")
    if table is None:
        return None, "no [camera] in run.toml"
    try:
        return Camera.from_table(table), ""
    except CameraError:
        return None, "[camera] cannot be read"


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
        shown_region(camera, run.robot, twist, speed_m_s)
        for twist, speed_m_s in zip(twists, speeds_m_s, strict=True)
    ]
    unseen = Counter(region.reason for region in regions if isinstance(region, NoRegion))
    return RunRegions(len(regions), unseen, straight_ahead(camera, run.robot))


def straight_ahead(camera: Camera, robot: Robot, config: RegionConfig = WHOLE) -> Region | NoRegion:
    """The region of a robot that drives straight on."""
    return shown_region(camera, robot, np.array([1.0, 0.0, 0.0]), 1.0, config)


def shown_region(
    camera: Camera,
    robot: Robot,
    twist: FloatArray,
    speed_m_s: float,
    config: RegionConfig = WHOLE,
) -> Region | NoRegion:
    """The region by a twist (3,) if the image shows enough of it, usually all, large enough."""
    region = predict_region(robot, camera, twist, speed_m_s, config)
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
