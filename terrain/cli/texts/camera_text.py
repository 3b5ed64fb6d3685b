"""What `camera` prints of a lens, a mount and the terrain in the image, and what it advises."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from odometry.checks.findings.finding import Level
from odometry.geometry.angles import wrap
from odometry.recording.run import Robot, Run
from terrain.calibration.look_ahead import LookAhead, look_ahead, nearest_seen_m, suggest_pitch
from terrain.calibration.mount_fit import NAMES
from terrain.calibration.mount_sources import MountSource
from terrain.camera.camera import Camera
from terrain.checks.image_motion import image_motion
from terrain.checks.region_ahead import no_mount, region_ahead
from terrain.classification.answer import Classifier
from terrain.region.region import NoRegion, RegionConfig

if TYPE_CHECKING:
    from terrain.calibration.lens_sources import LensSource
    from terrain.classification.classifier import TerrainClassifier


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
    if source.tracks is not None:
        found, _ = image_motion(run, source.camera)
    elif source.fit is None:
        found = list(region_ahead(run, source.camera.to_table()))
    else:
        return
    for finding in found:
        if finding.level is Level.WARNING:
            click.echo(f"Warning: {finding.line.partition(': ')[2]}", err=True)


def is_no_mount(source: MountSource) -> bool:
    """Whether the mount is one that no camera for the terrain has: degrees, mm, points upwards."""
    return source.fit is None and no_mount(source.camera.to_table())


def print_lens(source: "LensSource") -> None:
    """Size, matrix and distortion, with the errors of the photographs that gave them."""
    lens = source.lens
    (fx, _, cx), (_, fy, cy), _ = lens.matrix
    click.echo(f"Lens (from {source.where}): {lens.image_size[0]} x {lens.image_size[1]} pixels")
    click.echo(f"  fx {fx:.1f}, fy {fy:.1f}, cx {cx:.1f}, cy {cy:.1f} px")
    click.echo(f"  distortion {', '.join(f'{value:.4g}' for value in lens.distortion) or 'none'}")
    if source.file is not None:
        for note in source.file.notes:
            click.echo(f"Note: {note}", err=True)
    if source.boards is not None:
        _print_boards(source)


def print_mount(source: "MountSource") -> None:
    """Place and attitude, with intervals and errors where they were fitted."""
    camera, fit = source.camera, source.fit
    if camera.mount is None:
        click.echo(f"Mount (from {source.where}): the homography ground_to_image")
        return
    click.echo(f"Mount (from {source.where}):")
    half = np.full(6, np.nan) if fit is None else fit.half_interval
    for name, value, width in zip(NAMES, camera.mount, half, strict=True):
        click.echo(f"  {name:5s} {_with_interval(name, value, width)}")
    if fit is None:
        return
    what = "marked points" if source.points is not None else "features that move as terrain does"
    click.echo(
        f"  reprojection error {fit.rms_px:.2f} px RMS over {np.count_nonzero(fit.agrees)} {what}"
    )
    if source.points is not None:
        for line, error in zip(source.points.lines, fit.errors_px, strict=True):
            click.echo(f"    row {line}: {error:.2f} px")
    if fit.contradiction:
        click.echo(f"Warning: {fit.contradiction}", err=True)
    for note in fit.notes:
        click.echo(f"Note: {note}", err=True)


def print_seen(camera: Camera, robot: Robot, classifier: "TerrainClassifier | None") -> None:
    """Which terrain the image shows, how large a metre is there, and which pitch would do."""
    nearest_m = nearest_seen_m(camera)
    if nearest_m is None:
        click.echo("The image shows no terrain straight ahead.")
    else:
        click.echo(
            f"The nearest visible terrain straight ahead is {nearest_m:.2f} m ahead of the "
            "robot's centre."
        )
    ahead = look_ahead(camera, robot, classifier)
    if isinstance(ahead, NoRegion):
        click.echo(f"Warning: `run` would have no region straight ahead: {ahead.reason}.", err=True)
    else:
        _print_ahead(ahead)
    if classifier is not None:
        _print_model(ahead, classifier)
    if isinstance(ahead, NoRegion) or not ahead.whole:
        for line in advice(camera, robot, classifier):
            click.echo(f"Suggestion: {line}")


def print_written(out: Path, names: Sequence[str]) -> None:
    """The files, pictures first."""
    click.echo(f"Wrote {', '.join(str(out / name) for name in names)}")


def _print_boards(source: "LensSource") -> None:
    if source.boards is None:
        return
    seen, fit = source.boards
    names = ("fx", "fy", "cx", "cy")
    spans = (f"{n} +- {half:.1f}" for n, half in zip(names, fit.half_interval, strict=True))
    click.echo(f"  95 % intervals [px]: {', '.join(spans)}")
    near, far = float(fit.distances_m.min()), float(fit.distances_m.max())
    click.echo(
        f"  reprojection error {fit.rms_px:.3f} px RMS over {len(seen.views)} photographs; the "
        f"board was {near:.2f} to {far:.2f} m away"
    )
    for view, error in zip(seen.views, fit.photo_rms_px, strict=True):
        click.echo(f"    {view.file.name}: {error:.3f} px")
    for file, reason in seen.without.items():
        click.echo(f"    {file.name}: not used, {reason}")
    for photos in fit.next_photos:
        click.echo(f"Note: for a better lens, {photos}", err=True)


def _with_interval(name: str, value: float, half: float) -> str:
    if name in NAMES[:3]:
        return f"{value:.3f} m" + (f" +- {half:.3f} (95 %)" if np.isfinite(half) else "")
    words = f"{round(np.degrees(value), 2) + 0.0:.2f} degrees"
    return words + (f" +- {np.degrees(half):.2f} (95 %)" if np.isfinite(half) else "")


def _print_ahead(ahead: LookAhead) -> None:
    region = ahead.region
    part = "all of the footprint" if ahead.whole else "a part of the footprint"
    click.echo(
        f"Look-ahead place straight on: {part}, after {region.distance_ahead_m:.2f} m; "
        f"x = {region.rectangle.x_min:.2f} to {region.rectangle.x_max:.2f} m."
    )
    click.echo(
        f"  A metre is {ahead.across_px:.0f} px across and {ahead.along_px:.0f} px along the way "
        f"there; a pixel shows {_mm(ahead.across_px)} x {_mm(ahead.along_px)} mm."
    )


def _print_model(ahead: LookAhead | NoRegion, classifier: "TerrainClassifier") -> None:
    scale = classifier.metres_per_pixel
    if scale is None:
        size = "" if isinstance(ahead, NoRegion) else f" (here up to {_mm(ahead.along_px)} mm)"
        click.echo(
            "Warning: the model has no metric scale: it compares pixels of the image with pixels "
            f"of its training photographs, whatever they show{size}. Train with --metres-per-pixel "
            "on photographs of a known scale.",
            err=True,
        )
    elif not isinstance(ahead, NoRegion):
        coarsest = _mm(min(ahead.along_px, ahead.across_px))
        click.echo(
            f"  The model's patches have {1000 * scale:.3g} mm a pixel, the image there up to "
            f"{coarsest} mm."
        )


def _mm(pixels_per_metre: float) -> str:
    return f"{1000 / pixels_per_metre:.2g}"
