"""The images of a run that are drawn, and the terrain that they show by the camera's numbers."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.run import Run
from terrain.camera import Camera
from terrain.checks.run_regions import image_rows, motion_at, whole_region
from terrain.checks.sampled_images import spread
from terrain.errors import CameraError, ImageError
from terrain.images import read_image
from terrain.region import NoRegion, Region

TRIES = 5  # images that are opened until one can be read


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
    return [
        whole_region(camera, run.robot, twist, speed) if camera is not None else NoRegion(reason)
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
