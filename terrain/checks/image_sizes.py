"""Images of another size than the camera's, and a matrix of another resolution."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.checks.findings.finding import Finding, Level
from terrain.camera.camera import Camera
from terrain.checks.image_files import SampledImage

Size = tuple[int, int]

SAME = 0.02  # of a ratio: sizes are rounded to whole pixels, often to even ones
# Principal points lie within some per cent of the centre; resolutions differ by 1.5 and more.
CENTRE = (0.75, 1.33)
# Of the width: a focal length that is longer, after dividing, is rather of a part of larger images
LONGEST = 1.2
ALIKE = 1.15  # ratio of the two coordinates of a principal point that is only scaled


@dataclass(frozen=True)
class Scaled:
    """A finding, and the `[camera]` table with what it says mended; None where it cannot be."""

    finding: Finding
    mended: dict[str, Any] | None = None


def other_sizes(
    camera: Camera, table: Mapping[str, Any], images: Sequence[SampledImage]
) -> Iterator[Scaled]:
    """Sizes of the images against `image_size`, and of `image_size` against the principal point."""
    sizes = Counter(image.size for image in images if image.size and not image.damage)
    odd = {size: count for size, count in sizes.items() if size != camera.image_size}
    if not odd:
        yield from _matrix(camera, table)
        return
    usual, _ = sizes.most_common(1)[0]
    seen = (
        f"{sum(odd.values())} of {sum(sizes.values())} images have another size than image_size "
        f"{_words(camera.image_size)}: "
        + ", ".join(f"{count} of {_words(size)}" for size, count in odd.items())
    )
    if usual == camera.image_size:
        yield Scaled(_finding(
            Level.NOTE, seen, "Some images are of another camera or setting",
            "Nothing to do: they get no label",
        ))  # fmt: skip
    else:
        yield _whole_run(camera, table, usual, seen)


def _whole_run(camera: Camera, table: Mapping[str, Any], size: Size, seen: str) -> Scaled:
    fits_images = bool(np.all(_within(_off_centre(camera, size), CENTRE)))
    fits_table = bool(np.all(_within(_off_centre(camera, camera.image_size), CENTRE)))
    factors = np.array(size) / camera.image_size
    by = f"{factors[0]:.4g}"
    mended = dict(table) | {"image_size": list(size)}
    if size == camera.image_size[::-1] and fits_images and not fits_table:
        return Scaled(_finding(
            Level.WARNING, seen, "image_size is swapped: it holds height and width",
            f"Write image_size = [{size[0]}, {size[1]}]: width, then height",
        ), mended)  # fmt: skip
    if size == camera.image_size[::-1]:
        return Scaled(_finding(
            Level.WARNING, seen, "Images were rotated by 90 degrees after the calibration, or "
            "image_size is swapped (height and width)",
            "Rotate the images back, or calibrate the rotated ones",
        ))  # fmt: skip
    if abs(factors[0] / factors[1] - 1) < SAME:
        if fits_images and not fits_table:
            return Scaled(_finding(
                Level.WARNING, f"{seen}, {by} times as large; the principal point fits the images",
                "image_size is of another resolution than images and matrix",
                f"Write image_size = [{size[0]}, {size[1]}]",
            ), mended)  # fmt: skip
        return Scaled(_finding(
            Level.WARNING, f"{seen}, {by} times as large",
            f"Images were scaled by a factor of {by} after the calibration, or image_size and "
            "matrix are of another resolution",
            f"Multiply image_size, and the first two rows of matrix (and ground_to_image), by {by}",
        ))  # fmt: skip
    return Scaled(_finding(
        Level.WARNING, seen, "Images are of another camera, or were cropped, so that matrix does "
        "not hold for them",
        "Calibrate the camera of these images",
    ))  # fmt: skip


def _matrix(camera: Camera, table: Mapping[str, Any]) -> Iterator[Scaled]:
    """A principal point far from the centre, by the same factor in both directions."""
    off = _off_centre(camera, camera.image_size)
    if np.all(_within(off, CENTRE)):
        return
    (u, v), factor = camera.matrix[:2, 2], float(np.sqrt(np.prod(np.maximum(off, 1e-6))))
    seen = (
        f"the principal point of matrix is ({u:.4g}, {v:.4g}), the centre of images of "
        f"{_words(camera.image_size)} is ({(camera.image_size[0] - 1) / 2:.4g}, "
        f"{(camera.image_size[1] - 1) / 2:.4g})"
    )
    mended = None
    if not np.all(off > 0) or off.max() / off.min() >= ALIKE:
        cause = "matrix is wrong, or images were cropped or shifted after the calibration"
        remedy = "Calibrate with images of this size"
    elif factor > 1 and camera.matrix[0, 0] / factor > LONGEST * camera.image_size[0]:
        cause = (
            "Images are a part that was cut out of larger ones (a region of interest, whose "
            f"offset matrix lacks), or matrix is of a resolution {factor:.3g} times as large"
        )
        remedy = (
            "Take the offset of the part from the principal point; nothing, if that was done and "
            "the part lies aside of the lens's middle"
        )
    else:
        matrix = np.array(camera.matrix)
        matrix[:2] /= factor
        mended = dict(table) | {"matrix": matrix.tolist()}
        cause = (
            f"matrix is of another resolution, {factor:.3g} times as large (focal length and "
            "principal point are scaled), or images were cropped"
        )
        remedy = f"Divide the first two rows of matrix by {factor:.3g}"
        if factor > 1:
            remedy += (
                ", if images were scaled; if they were cut out of larger ones, take the offset of "
                "the part from the principal point"
            )
    yield Scaled(Finding("camera_matrix", Level.WARNING, seen, cause, remedy), mended)


def _off_centre(camera: Camera, size: Size) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Principal point (2,) in units of the image's centre: about 1, 1."""
    return np.asarray(camera.matrix[:2, 2] / (np.maximum(np.array(size) - 1, 1) / 2))


def _within(values: np.ndarray[Any, Any], bounds: tuple[float, float]) -> np.ndarray[Any, Any]:
    return np.asarray((values > bounds[0]) & (values < bounds[1]))


def _words(size: Size) -> str:
    return f"{size[0]}x{size[1]}"


def _finding(level: Level, seen: str, cause: str, remedy: str) -> Finding:
    return Finding("image_size", level, seen, cause, remedy)
