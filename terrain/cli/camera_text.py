"""What `camera` prints of a lens, a mount, and the terrain in the image."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click
import numpy as np

from odometry.run import Robot
from terrain.calibration.look_ahead import LookAhead, look_ahead, nearest_seen_m
from terrain.calibration.mount_fit import NAMES
from terrain.camera import Camera
from terrain.cli.camera_advice import advice
from terrain.region import NoRegion

if TYPE_CHECKING:
    from terrain.calibration.lens_sources import LensSource
    from terrain.calibration.mount_sources import MountSource
    from terrain.classification.classifier import TerrainClassifier


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
        click.echo(f"  {name:5s} {_told(name, value, width)}")
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


def _told(name: str, value: float, half: float) -> str:
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
