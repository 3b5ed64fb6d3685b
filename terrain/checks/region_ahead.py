"""Whether the image shows the terrain where the robot will be, and a classifier can read it."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Robot, Run
from terrain.camera.camera import Camera
from terrain.checks.drawn_images import RunRegions, run_regions, straight_ahead
from terrain.checks.other_cameras import (
    Reading,
    angles_in_degrees,
    looks_up,
    other_readings,
    tilted,
    too_far,
)
from terrain.errors import CameraError
from terrain.region.footprint_parts import footprint_parts, visible_shares
from terrain.region.region import NoRegion, Region, RegionConfig
from terrain.region.warp import scale_mismatch

if TYPE_CHECKING:
    from terrain.classification.classifier import TerrainClassifier

HORIZON_M = 1e4
USUAL_HEIGHT_M = (0.2, 3.0)  # of cameras on skid-steer robots


def region_ahead(run: Run, table: Mapping[str, Any]) -> Iterator[Finding]:
    """A mount or homography that shows the region ahead nowhere, or that cannot be read."""
    try:
        camera = Camera.from_table(table)
    except CameraError as error:
        yield _unreadable(str(error), _fitting(run.robot, table))
        return
    found = run_regions(run, camera)
    seen = f"the region ahead is {_counts(found)}; {_seen(camera, table)}"
    impossible = no_mount(table)
    if not impossible and not found.in_vain:
        return
    if not (impossible or isinstance(found.ahead, NoRegion) or tilted(_mount(table))):
        yield _where_it_goes(seen, found.ahead)
        return
    share = _share_ahead(camera, run.robot)
    if share > 0 and not (impossible or tilted(_mount(table)) or _all_shown(run.robot, table)):
        yield _in_part(share, _seen(camera, table))
        return
    fitting = _fitting(run.robot, table)
    yield Finding(
        "region_outside",
        Level.WARNING,
        seen,
        _cause(fitting),
        fitting[0].remedy if fitting else "Check [camera] with check --picture, or calibrate again",
    )


def _unreadable(seen: str, fitting: list[Reading]) -> Finding:
    return Finding(
        "camera_unreadable",
        Level.WARNING,
        seen,
        _cause(fitting) if fitting else "A value of [camera] is missing or not as the format says",
        fitting[0].remedy if fitting else "Mend [camera] in run.toml",
    )


def no_mount(table: Mapping[str, Any]) -> bool:
    """Whether the mount of a table that was read is one that no camera for the terrain has."""
    mount = _mount(table)
    return angles_in_degrees(mount) or too_far(mount) or looks_up(mount)


def _mount(table: Mapping[str, Any]) -> FloatArray:
    """Of a table that was read; zeros where it has a homography."""
    return np.array(table.get("mount", np.zeros(6)), dtype=np.float64)


def _all_shown(robot: Robot, table: Mapping[str, Any]) -> bool:
    """Whether the image shows all of the region by another reading."""
    return any(
        isinstance(straight_ahead(camera, reading.robot), Region)
        for reading, camera in _cameras(robot, table)
    )


def _fitting(robot: Robot, table: Mapping[str, Any]) -> list[Reading]:
    """Readings by which the image shows the region of a robot that drives straight on.

    Those that put the camera near the terrain or very high come last, before them those by which
    only a part is shown.
    """
    found: list[tuple[bool, bool, Reading]] = []
    for reading, camera in _cameras(robot, table):
        in_part = isinstance(straight_ahead(camera, reading.robot), NoRegion)
        if not in_part or _share_ahead(camera, reading.robot) > 0:
            usual = USUAL_HEIGHT_M[0] <= camera.height_m <= USUAL_HEIGHT_M[1]
            found.append((not usual, in_part, reading))
    return [reading for *_, reading in sorted(found, key=lambda each: each[:2])]


def _cameras(robot: Robot, table: Mapping[str, Any]) -> Iterator[tuple[Reading, Camera]]:
    """Other readings, none of which looks up."""
    for reading in _readings(robot, table):
        try:
            camera = Camera.from_table(reading.table)
        except CameraError:
            continue
        if not looks_up(_mount(reading.table)):
            yield reading, camera


def _readings(robot: Robot, table: Mapping[str, Any]) -> list[Reading]:
    try:
        return list(other_readings(table, robot))
    except (KeyError, TypeError, ValueError, IndexError, OverflowError):
        return []  # what is wrong is no number: the reader's message says it


def _cause(fitting: list[Reading]) -> str:
    if not fitting:
        return (
            "The cause cannot be determined: no mistake that was tried (degrees, mm, signs, axes, "
            "an inverse, a turned camera) brings the region into the image"
        )
    first, *others = fitting
    return first.cause + (f"; less likely: {others[0].cause}" if others else "")


def _where_it_goes(seen: str, ahead: Region) -> Finding:
    return Finding(
        "region_seldom_seen",
        Level.NOTE,
        f"{seen}; it would be visible {ahead.distance_ahead_m:.2g} m ahead when driving straight "
        "on",
        "The robot turns or reverses most of the time, where the camera does not point",
        "Nothing to do: images get labels where the robot drives ahead",
    )


def _share_ahead(camera: Camera, robot: Robot) -> float:
    """Most of the region that the image shows at once when driving straight on.

    0 where that is too little, or under the robot: no camera sees through it.
    """
    region = straight_ahead(camera, robot, RegionConfig())
    if isinstance(region, NoRegion) or region.place[0] < (robot.length or robot.track_width) / 2:
        return 0.0
    parts = footprint_parts(robot, RegionConfig().footprint_scale, per_tread=False)
    return float(visible_shares(camera, region.pose_ahead[None], parts)[0])


def _in_part(share: float, seen: str) -> Finding:
    return Finding(
        "region_in_part",
        Level.NOTE,
        f"the image shows {100 * share:.0f} % of the region ahead at once when driving straight "
        f"on; {seen}",
        "The robot with its margin is wider or longer than what the camera shows of the terrain",
        "Nothing to do if check --picture shows the terrain where it is: what is shown of the "
        "region gets labels; a higher camera, a wider lens or less pitch shows more",
    )


def _counts(found: RunRegions) -> str:
    if found.frames == 0:
        return (
            f"{found.ahead.reason} when driving straight on"
            if isinstance(found.ahead, NoRegion)
            else "in the image when driving straight on"
        )
    words = [f"{reason} in {count}" for reason, count in found.unseen.items()]
    return f"{', '.join(words) or 'unseen in 0'} of {found.frames} images while the robot moved"


def _seen(camera: Camera, table: Mapping[str, Any]) -> str:
    """Where the camera points, by its own numbers."""
    (ground,) = camera.pixels_to_ground([(np.array(camera.image_size) - 1) / 2])
    centre = (
        f"the middle of the image shows the terrain at x = {ground[0]:.2f}, y = {ground[1]:.2f} m"
        if np.abs(ground).max() < HORIZON_M  # False for NaN
        else "the middle of the image shows no terrain"
    )
    if camera.mount is None:
        return f"by ground_to_image {centre}"
    return f"by mount = {[float(f'{value:.4g}') for value in table['mount']]} {centre}"


def vision_model(
    classifier: "TerrainClassifier", camera: Camera | None, robot: Robot
) -> Iterator[Finding]:
    """No metric scale, or one at which this camera's images cannot be read."""
    scale = classifier.metres_per_pixel
    if scale is None:
        yield Finding(
            "model_without_scale",
            Level.NOTE,
            f"the model's training patches of {classifier.patch_size_px} pixels have no "
            "metres_per_pixel",
            "The model has no metric scale: pixels of the region are compared as they are, and "
            "texture is finer in the image the farther away it is",
            "Train with --metres-per-pixel, on patches in the view from above",
        )
    if camera is None:
        return
    region = straight_ahead(camera, robot)
    if isinstance(region, NoRegion):
        return
    reason = scale_mismatch(classifier, camera, region.rectangle, RegionConfig().coarsest)
    if reason:
        size = f"{scale:.3g} m" if scale is not None else "no stated scale"
        yield Finding(
            "model_unsuited",
            Level.WARNING,
            f"{reason}, when driving straight on ({region.distance_ahead_m:.2g} m ahead; patches "
            f"of {classifier.patch_size_px} pixels, {size} a pixel): vision will label nothing",
            "metres_per_pixel of the model is wrong (mm?), or the model is of another camera, "
            "nearer to the terrain",
            "Train with patches of this camera and their metres_per_pixel",
        )
