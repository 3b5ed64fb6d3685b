"""Whether the camera sees the ground where the robot will be."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.finding import Finding, Level
from odometry.run import Robot, Run
from terrain.camera import Camera
from terrain.checks.other_cameras import (
    Reading,
    angles_in_degrees,
    looks_up,
    other_readings,
    tilted,
    too_far,
)
from terrain.checks.sampled import spread
from terrain.errors import CameraError
from terrain.region import Region, RegionConfig, predict_region

FRAMES = 40  # moments of a run, some milliseconds each
MOST = 0.5
MOVING = 0.05  # of the fastest tread speed
ORDINARY_WIDTH = 1.8  # effective width in track widths, the middle of robots that were measured
SMALLEST_PX = 16  # of a side of the region: SFTA of smaller patches says nothing of texture
HORIZON_M = 1e4
USUAL_HEIGHT_M = (0.2, 3.0)  # of cameras on skid-steer robots
OUTSIDE, TINY = "outside the image", f"smaller than {SMALLEST_PX} pixels"


@dataclass(frozen=True)
class Looks:
    """What the camera sees of the region ahead over a run.

    Attributes
    ----------
    frames : int
        Moments tried, at stamps of images while the robot moved.
    unseen : Mapping of reason to count
    ahead : Region or str
        When driving straight ahead; the reason where there is none.
    """

    frames: int
    unseen: Mapping[str, int]
    ahead: Region | str

    @property
    def in_vain(self) -> bool:
        """Whether the region is unseen in most frames."""
        return self.frames > 0 and sum(self.unseen.values()) > MOST * self.frames


def looks(run: Run, camera: Camera) -> Looks:
    """Predict the region at moments of a run, by an ordinary effective width."""
    twists, speeds_m_s = motion_at(run, image_rows(run))
    reasons = [
        seen_region(camera, run.robot, twist, speed_m_s)
        for twist, speed_m_s in zip(twists, speeds_m_s, strict=True)
    ]
    unseen = Counter(reason for reason in reasons if isinstance(reason, str))
    return Looks(len(reasons), unseen, straight_ahead(camera, run.robot))


def straight_ahead(camera: Camera, robot: Robot) -> Region | str:
    """The region of a robot that drives straight on."""
    return seen_region(camera, robot, np.array([1.0, 0.0, 0.0]), 1.0)


def seen_region(camera: Camera, robot: Robot, twist: FloatArray, speed_m_s: float) -> Region | str:
    """The region by a twist (3,) if the image shows it large enough, else the reason."""
    region = predict_region(robot, camera, twist, speed_m_s, RegionConfig())
    if isinstance(region, str):
        return OUTSIDE
    pixels = camera.ground_to_pixels(region.rectangle.corners)
    return region if float(np.ptp(pixels, axis=0).min()) >= SMALLEST_PX else TINY


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


def region_ahead(run: Run, table: Mapping[str, Any]) -> Iterator[Finding]:
    """A mount or homography that shows the region ahead nowhere, or that cannot be read."""
    try:
        camera = Camera.from_table(table)
    except CameraError as error:
        yield _unreadable(str(error), _fitting(run.robot, table))
        return
    found = looks(run, camera)
    seen = f"the region ahead is {_counts(found)}; {_seen(camera, table)}"
    impossible = _impossible(table)
    if not impossible and not found.in_vain:
        return
    if not (impossible or isinstance(found.ahead, str) or tilted(_mount(table))):
        yield _where_it_goes(seen, found.ahead)
        return
    fitting = _fitting(run.robot, table)
    yield Finding(
        "region_outside",
        Level.WARNING,
        seen,
        _cause(fitting),
        fitting[0].remedy if fitting else "Check [camera] with check --picture, or calibrate anew",
    )


def _unreadable(seen: str, fitting: list[Reading]) -> Finding:
    return Finding(
        "camera_unreadable",
        Level.WARNING,
        seen,
        _cause(fitting) if fitting else "A value of [camera] is missing or not as the format says",
        fitting[0].remedy if fitting else "Mend [camera] in run.toml",
    )


def _impossible(table: Mapping[str, Any]) -> bool:
    mount = _mount(table)
    return angles_in_degrees(mount) or too_far(mount) or looks_up(mount)


def _mount(table: Mapping[str, Any]) -> FloatArray:
    """Of a table that was read; zeros where it has a homography."""
    return np.array(table.get("mount", np.zeros(6)), dtype=np.float64)


def _fitting(robot: Robot, table: Mapping[str, Any]) -> list[Reading]:
    """Readings by which the image shows the region of a robot that drives straight on.

    Those that put the camera near the ground or very high come last.
    """
    found: list[tuple[bool, Reading]] = []
    for reading in _readings(robot, table):
        try:
            camera = Camera.from_table(reading.table)
        except CameraError:
            continue
        if not isinstance(straight_ahead(camera, reading.robot), str):
            usual = USUAL_HEIGHT_M[0] <= height_m(camera) <= USUAL_HEIGHT_M[1]
            found.append((not usual, reading))
    return [reading for _, reading in sorted(found, key=lambda pair: pair[0])]


def height_m(camera: Camera) -> float:
    """Height above the ground: H = s K R [e1 e2 -c] has the determinant -s^3 fx fy c_z."""
    rays = np.linalg.solve(camera.matrix, camera.ground_to_image)
    scale = float(np.mean(np.linalg.norm(rays[:, :2], axis=0)))
    return float(-np.linalg.det(rays) / scale**3)


def _readings(robot: Robot, table: Mapping[str, Any]) -> list[Reading]:
    try:
        return list(other_readings(table, robot))
    except (KeyError, TypeError, ValueError, IndexError, OverflowError):
        return []  # what is wrong is no number: the reader's message says it


def _cause(fitting: list[Reading]) -> str:
    if not fitting:
        return (
            "The cause cannot be told: no mistake that was tried (degrees, mm, signs, axes, an "
            "inverse, a turned camera) brings the region into the image"
        )
    first, *others = fitting
    return first.cause + (f"; less likely: {others[0].cause}" if others else "")


def _where_it_goes(seen: str, ahead: Region) -> Finding:
    return Finding(
        "region_seldom_seen",
        Level.NOTE,
        f"{seen}; it would be seen {ahead.distance_ahead_m:.2g} m ahead when driving straight on",
        "The robot turns or reverses most of the time, where the camera does not look",
        "Nothing to do: images get labels where the robot drives ahead",
    )


def _counts(found: Looks) -> str:
    if found.frames == 0:
        return (
            f"{found.ahead} when driving straight on"
            if isinstance(found.ahead, str)
            else "in the image when driving straight on"
        )
    words = [f"{reason} in {count}" for reason, count in found.unseen.items()]
    return f"{', '.join(words) or 'unseen in 0'} of {found.frames} images while the robot moved"


def _seen(camera: Camera, table: Mapping[str, Any]) -> str:
    """Where the camera looks, by its own numbers."""
    (ground,) = camera.pixels_to_ground([(np.array(camera.image_size) - 1) / 2])
    centre = (
        f"the middle of the image shows the ground at x = {ground[0]:.2f}, y = {ground[1]:.2f} m"
        if np.abs(ground).max() < HORIZON_M  # False for NaN
        else "the middle of the image shows no ground"
    )
    if camera.mount is None:
        return f"by ground_to_image {centre}"
    return f"by mount = {[float(f'{value:.4g}') for value in table['mount']]} {centre}"
