"""The one image of a run that is drawn, and what the camera says of the ground there."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import ByteImage
from odometry.run import Run
from terrain.camera import Camera
from terrain.checks.looks import image_rows, motion_at, seen_region
from terrain.errors import CameraError, ImageError
from terrain.images import read_image
from terrain.region import Region

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
    """An image in the middle of the motion in which the region ahead is seen, else any one."""
    stamps_s = image_rows(run)
    if run.images is None or not len(stamps_s):
        return None
    camera, reason = _camera(run)
    twists, speeds_m_s = motion_at(run, stamps_s)
    regions: list[Region | str] = [
        seen_region(camera, run.robot, twist, speed) if camera is not None else reason
        for twist, speed in zip(twists, speeds_m_s, strict=True)
    ]
    by_middle = np.argsort(np.abs(np.arange(len(stamps_s)) - len(stamps_s) / 2), kind="stable")
    best_first = sorted(by_middle, key=lambda place: isinstance(regions[place], str))
    for place in best_first[:TRIES]:
        stamp_s = float(stamps_s[place])
        row = int(np.searchsorted(run.images.stamps_s, stamp_s))
        try:
            image = read_image(run.folder / str(run.images["file"][row]))
        except ImageError:
            continue
        run_time_s = stamp_s - float(run.odometry.stamps_s[0])
        return _shown(run_time_s, image, camera, regions[place])
    return None


def _shown(
    run_time_s: float, image: ByteImage, camera: Camera | None, region: Region | str
) -> ShownImage:
    if camera is None:
        return ShownImage(run_time_s, image, None, None, str(region))
    height, width = image.shape[:2]
    if (width, height) != camera.image_size:
        reason = "image of {}x{}, [camera] of {}x{}".format(width, height, *camera.image_size)
        return ShownImage(run_time_s, image, None, None, reason)
    if isinstance(region, str):
        return ShownImage(run_time_s, image, camera, None, f"the region ahead is {region}")
    return ShownImage(run_time_s, image, camera, region, "")


def _camera(run: Run) -> tuple[Camera | None, str]:
    table = run.settings.get("camera")
    if table is None:
        return None, "no [camera] in run.toml"
    try:
        return Camera.from_table(table), ""
    except CameraError:
        return None, "[camera] cannot be read"
