"""Check a recording with its camera before anything is fitted to it, and refuse what cannot be."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from odometry.arrays import spread
from odometry.checks.copies.copied_columns import NO_GYROSCOPES
from odometry.checks.copies.copied_turns import without_gyroscope
from odometry.checks.findings.finding import CheckReport, Finding, Level
from odometry.checks.recording import check_recording
from odometry.checks.stamps.bursts import in_bursts
from odometry.checks.velocity.velocity import VELOCITY_FAULTS
from odometry.errors import RunFolderError
from odometry.recording.run import Run
from odometry.recording.run_span import Span, cut_run
from terrain.camera.camera import Camera
from terrain.camera.distortion import undistort
from terrain.checks.drawn_images import straight_ahead
from terrain.checks.image_files import (
    DECODED,
    SampledImage,
    damaged,
    decode,
    frozen,
    outside_of_odometry,
    sample_images,
)
from terrain.checks.image_gaps import image_gaps
from terrain.checks.image_motion import image_motion
from terrain.checks.image_sizes import other_sizes
from terrain.checks.image_values import Values, grey_of, image_values, values_of
from terrain.checks.region_ahead import region_ahead, vision_model
from terrain.errors import CameraError
from terrain.region.region import Region
from terrain.region.warp import pixel_view

if TYPE_CHECKING:
    from terrain.classification.classifier import TerrainClassifier


def check_run(
    run: Run | str | Path, model: "TerrainClassifier | str | Path | None" = None
) -> CheckReport:
    """What is odd about a recording and its camera: likeliest cause, remedy, most important first.

    Beside what `odometry.check_recording` finds: the camera's numbers are tried on the motion of
    the run, at most 100 images spread over it are read, 20 of them decoded, and the terrain in 32
    pairs of images is compared with the motion of the treads.

    Parameters
    ----------
    run : Run or path of a run folder
        A folder that cannot be read is a finding, not an error.
    model : TerrainClassifier or path, optional
        The classifier that is going to read the images.

    Raises
    ------
    ModelFileError
        If the model cannot be read.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> terrain.check_run(odometry.shipped_data() / "runs" / "demo").misleads
    False
    """
    classifier = _loaded(model) if isinstance(model, str | Path) else model
    if not isinstance(run, Run):
        try:
            run = Run.read(run)
        except RunFolderError:
            return check_recording(run)
    report = check_recording(run)
    if report.at(Level.REFUSED):
        return report.with_more((), ("the camera: the recording is refused",))
    report = report.with_more(_findings(run, classifier), _skipped(run))
    return report.with_more(*_motion(run, report))


def _loaded(model: str | Path) -> "TerrainClassifier":
    from terrain.classification.classifier import TerrainClassifier  # noqa: PLC0415 - slow to load

    return TerrainClassifier.load(Path(model))


def _findings(run: Run, classifier: "TerrainClassifier | None") -> Iterator[Finding]:
    table = run.settings.get("camera")
    if run.images is None:
        if table is not None:
            yield Finding(
                "no_images",
                Level.NOTE,
                "run.toml has [camera], and there is no images.csv",
                "The images were not recorded or not copied",
                "Nothing to do where no vision is wanted",
            )
        return
    images = sample_images(run)
    yield from damaged(images)
    yield from frozen(run, images)
    yield from outside_of_odometry(run)
    yield from in_bursts("images.csv", run.images.stamps_s)
    yield from image_gaps(run)
    if not isinstance(table, Mapping):
        yield Finding(
            "no_camera",
            Level.WARNING,
            f"images.csv has {len(run.images)} images, and run.toml has no table [camera]",
            "The camera's calibration is missing: it is not known which terrain an image shows",
            "Write [camera] with image_size, matrix, distortion and mount, or leave images.csv out",
        )
        yield from image_values(_values(images, None, run))
        return
    camera = _camera(table)
    if camera is not None:
        yield from lens(camera)
        for scaled in other_sizes(camera, table, images):
            yield scaled.finding
            table = scaled.mended or table
    yield from region_ahead(run, table)
    yield from image_values(_values(images, camera, run))
    if classifier is not None:
        yield from vision_model(classifier, _camera(table), run.robot)


def _motion(run: Run, report: CheckReport) -> tuple[Sequence[Finding], Sequence[str]]:
    """Images against the motion of the treads, where nothing is wrong with either."""
    if run.images is None:
        return (), ()
    if any(f.level is not Level.NOTE and f.name not in VELOCITY_FAULTS for f in report.findings):
        return (), ("whether images show the motion of the treads: see the warnings",)
    findings, skipped = image_motion(run, Camera.from_table(run.settings["camera"]))
    return findings, (skipped,) if skipped else ()


def _camera(table: Mapping[str, Any]) -> Camera | None:
    try:
        return Camera.from_table(table)
    except CameraError:
        return None


def _values(images: Sequence[SampledImage], camera: Camera | None, run: Run) -> list[Values]:
    """Pixels of some images in the region ahead, of whole images where that is not known."""
    region = straight_ahead(camera, run.robot) if camera is not None else None
    found = []
    for place in spread(len(images), DECODED):
        pixels = decode(images[place])
        if pixels is None or pixels.dtype.itemsize > 2:
            continue
        grey = grey_of(pixels)
        if camera is not None and isinstance(region, Region):
            view = pixel_view(grey, camera, region.rectangle)
            grey = view if images[place].size == camera.image_size else grey
        found.append(values_of(pixels, grey))
    return found


def _skipped(run: Run) -> Iterator[str]:
    if run.images is None:
        yield "no images: the camera was not checked"


GRID = 21  # pixels tried along each side
FOLDED = 0.02  # share of pixels without a ray: a good calibration has none, or a few in the corners
TANGENTIAL = 0.02  # |p1|, |p2| of real lenses are about 0.001


def lens(camera: Camera) -> Iterator[Finding]:
    """Pixels that no ray reaches, and tangential coefficients that are radial ones."""
    if not camera.distortion.any():
        return
    width, height = camera.image_size
    u, v = np.meshgrid(np.linspace(0, width - 1, GRID), np.linspace(0, height - 1, GRID))
    rays = np.stack([u.ravel(), v.ravel(), np.ones(u.size)], axis=-1)
    normalised = np.asarray(np.linalg.solve(camera.matrix, rays.T).T[:, :2])
    folded = float(np.isnan(undistort(normalised, camera.distortion)).any(axis=1).mean())
    tangential = float(np.abs(camera.distortion[2:4]).max())
    if folded <= FOLDED and tangential <= TANGENTIAL:
        return
    seen = f"distortion = {[float(f'{value:.4g}') for value in camera.distortion]}"
    if folded > FOLDED:
        seen += f" folds the image: {100 * folded:.0f} % of its pixels are of no ray"
    if tangential > TANGENTIAL:
        cause = (
            "Coefficients are in another order than k1, k2, p1, p2, k3 (the third and the fourth "
            "are about 0.001 in real lenses), or of another lens model (fisheye)"
        )
    else:
        cause = (
            "Coefficients are of another lens model (fisheye, division), of another camera, or "
            "matrix has too short a focal length"
        )
    yield Finding("distortion", Level.WARNING, seen, cause, "Calibrate with OpenCV's lens model")


def checked_run(folder: Path, span: Span, *, images: bool = False) -> tuple[Run, CheckReport]:
    """Read one run folder, cut to the span, and check it.

    A yaw rate that was computed from treads or yaw is left out: they would confirm themselves.

    Parameters
    ----------
    folder : Path
    span : Span
    images : bool
        Whether the camera and its images are checked as well.

    Raises
    ------
    RunFolderError
        If it is not as the format says, cannot be used as it is, or nothing of it lies in the
        span.
    """
    run = cut_run(Run.read(folder), span)
    report = check_run(run) if images else check_recording(run)
    refused = report.at(Level.REFUSED)
    if refused:
        raise RunFolderError(f"{folder}: {refused[0].line.removeprefix('refused: ')}")
    if any(finding.name in NO_GYROSCOPES for finding in report.findings):
        run = without_gyroscope(run)
    return run, report
