"""What `camera` advises where the image misses the region ahead, or a part of it."""

from collections.abc import Iterator

import click
import numpy as np

from odometry.checks.finding import Level
from odometry.geometry.angles import wrap
from odometry.run import Robot, Run
from terrain.calibration.look_ahead import look_ahead
from terrain.calibration.mount_sources import MountSource
from terrain.calibration.suggested_mount import suggest_pitch
from terrain.camera import Camera
from terrain.checks.region_ahead import no_mount, region_ahead
from terrain.classification.classifier import Classifier
from terrain.region import NoRegion, RegionConfig

ASIDE_RAD = np.radians(60.0)  # a camera that points farther aside does not show the way ahead


def advice(camera: Camera, robot: Robot, classifier: Classifier | None) -> Iterator[str]:
    """What to change: the pitch, the scale of the model, the camera."""
    if camera.mount is None:
        return
    yaw_rad = float(wrap(camera.mount[5]))
    if abs(yaw_rad) > ASIDE_RAD:
        yield (
            f"the camera points aside or back (yaw {np.degrees(yaw_rad):.0f} degrees): it shows "
            "regions only where the robot drives that way, such as in reverse"
        )
        return
    found = suggest_pitch(camera, robot, classifier)
    if found is not None:
        now_deg = round(float(np.degrees(camera.mount[4])), 0) + 0.0
        yield (
            f"a pitch of {found.suggested_deg:.0f} degrees down "
            f"({np.radians(found.suggested_deg):.3f} rad; now {now_deg:.0f}) shows the whole "
            f"region after {found.ahead.region.distance_ahead_m:.2f} m; so do pitches from "
            f"{found.least_deg:.0f} to {found.most_deg:.0f} degrees"
        )
        return
    geometry = suggest_pitch(camera, robot)
    if geometry is None:
        yield (
            "no pitch at this place shows the whole region; mount the camera higher or nearer to "
            "the front, or use a wider lens"
        )
    elif classifier is not None:
        yield _coarser_model(camera, robot, classifier)


def _coarser_model(camera: Camera, robot: Robot, classifier: Classifier) -> str:
    """A pitch shows the whole region, but not with the resolution that the model needs."""
    ahead = look_ahead(camera, robot)
    if isinstance(ahead, NoRegion) or classifier.metres_per_pixel is None:
        return (
            "the image shows no region as large as the model's patches; use a camera of more "
            "pixels, or train on smaller patches"
        )
    coarsest_mm = 1000 / min(ahead.along_px, ahead.across_px)
    return (
        f"the image shows the terrain there at {coarsest_mm:.2g} mm a pixel, the model compares it "
        f"at {1000 * classifier.metres_per_pixel:.2g} mm; train on photographs of "
        f"{coarsest_mm / RegionConfig.coarsest:.2g} mm a pixel or coarser, or use a camera of more "
        "pixels"
    )


def print_doubts(run: Run, source: MountSource) -> None:
    """Say what the check of a run would say of this mount, before it is in run.toml."""
    if source.fit is not None:
        return
    for finding in region_ahead(run, source.camera.to_table()):
        if finding.level is Level.WARNING:
            click.echo(f"Warning: {finding.line.partition(': ')[2]}", err=True)


def is_no_mount(source: MountSource) -> bool:
    """Whether the mount is one that no camera for the terrain has: degrees, mm, points upwards."""
    return source.fit is None and no_mount(source.camera.to_table())
