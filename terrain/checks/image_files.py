"""Image files that are damaged, too large or repeated, and stamps without odometry."""

import hashlib
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, spread
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.recording.run import Run
from terrain.checks.image_values import FLAT, grey_of
from terrain.image_size import PIXELS, is_whole, stated_size

FILES = 100  # read whole: at most some hundred megabytes from the disk, one at a time
DECODED = 20  # of them, which takes about a second at two megapixels
MOST_BYTES = 64 * 1024**2  # of a file; a compressed image of PIXELS pixels is smaller

MANY = 0.1  # of the images: more are no accident at the end of a recording
OTHER_VIEW_M = 0.2  # of wheel travel, after which noise alone makes every real image another
FEW_OUTSIDE = 0.02  # of the stamps: a recorder starts and ends its files at slightly other times


@dataclass(frozen=True)
class SampledImage:
    """One image file.

    Attributes
    ----------
    row : int
        Of images.csv.
    stamp_s : float
    file : Path
    size : (int, int) or None
        Width and height in pixels that the file states.
    damage : str
        Why it cannot be used whole, or "".
    digest : bytes
        Equal for files of equal bytes.
    """

    row: int
    stamp_s: float
    file: Path
    size: tuple[int, int] | None
    damage: str
    digest: bytes


def sample_images(run: Run) -> tuple[SampledImage, ...]:
    """Look at the headers and ends of at most FILES images; nothing is decoded."""
    if run.images is None:
        return ()
    names, stamps_s = run.images["file"], run.images.stamps_s
    return tuple(
        _sampled(int(row), float(stamps_s[row]), run.folder / str(names[row]))
        for row in spread(len(run.images), FILES)
    )


def decode(image: SampledImage) -> AnyArray | None:
    """Pixels as they are stored, 16 bits kept; None where OpenCV cannot decode them."""
    if image.damage:
        return None
    try:
        encoded = np.frombuffer(image.file.read_bytes(), np.uint8)
        decoded: AnyArray | None = cv2.imdecode(encoded, cv2.IMREAD_UNCHANGED)
    except (OSError, cv2.error):
        return None
    return decoded


def _sampled(row: int, stamp_s: float, file: Path) -> SampledImage:
    try:
        count = file.stat().st_size
        encoded = file.read_bytes() if count <= MOST_BYTES else b""
    except OSError as error:
        return SampledImage(row, stamp_s, file, None, f"cannot be opened ({error.strerror})", b"")
    size = stated_size(encoded)
    damage = "too large" if count > MOST_BYTES else _damage(encoded, size)
    return SampledImage(row, stamp_s, file, size, damage, hashlib.sha256(encoded).digest())


def _damage(encoded: bytes, size: tuple[int, int] | None) -> str:
    if not encoded:
        return "empty"
    if size is None:
        return "no image"
    if size[0] * size[1] > PIXELS:
        return "too large"
    return "" if is_whole(encoded) else "truncated"


def damaged(images: Sequence[SampledImage]) -> Iterator[Finding]:
    """Images that are empty, truncated, too large or no images."""
    kinds = Counter(image.damage for image in images if image.damage)
    if not kinds:
        return
    count = sum(kinds.values())
    first = next(image for image in images if image.damage)
    words = ", ".join(f"{number} {damage}" for damage, number in kinds.most_common())
    (most, _), *_ = kinds.most_common()
    cause, remedy = _CAUSES.get(most, _CAUSES["no image"])
    yield Finding(
        "images_damaged",
        Level.WARNING if count > MANY * len(images) else Level.NOTE,
        f"{count} of {len(images)} images that were read cannot be used: {words} (the first is "
        f"{first.file.name})",
        cause,
        remedy,
    )


_CAUSES = {
    "truncated": (
        "Files are truncated: the recorder stopped, or a copy broke off, before they were written",
        "Copy the images again, or leave these rows out",
    ),
    "empty": (
        "Files are empty: the disk was full, or the recorder made them and wrote nothing",
        "Copy the images again, or leave these rows out",
    ),
    "too large": (
        f"Images of more than {PIXELS // 10**6} megapixels are not decoded: no robot's camera has "
        "as many, so that the file is damaged or a map",
        "Reduce the images together with image_size and matrix",
    ),
    "no image": (
        "Files are unreadable: no JPEG, PNG, TIFF or BMP (raw pixels, another format, or damaged)",
        "Convert the images to JPEG or PNG",
    ),
}


def frozen(run: Run, images: Sequence[SampledImage]) -> Iterator[Finding]:
    """Images of equal bytes though the treads moved meanwhile: noise alone differs in real ones."""
    groups = [list(group) for _, group in groupby(images, key=lambda image: image.digest)]
    begin_s = float(run.odometry.stamps_s[0])
    held = [group for group in groups if _travel_m(run, group) > OTHER_VIEW_M]
    held = [group for group in held if _has_content(group[0])]
    if not held:
        return
    spans = tuple((group[0].stamp_s - begin_s, group[-1].stamp_s - begin_s) for group in held)
    yield Finding(
        "images_frozen",
        Level.WARNING,
        f"{sum(map(len, held))} of {len(images)} images that were read are identical to the one "
        f"before or after, though the treads moved by {max(_travel_m(run, g) for g in held):.3g} m "
        f"meanwhile (from {spans[0][0]:.1f} s of run time)",
        "The camera was frozen: it repeats its last image, or one file was copied to many names",
        "Leave these rows out of images.csv, and check the camera's driver",
        spans,
    )


def _has_content(image: SampledImage) -> bool:
    """Whether an image shows something: black ones of a dark scene or a shut lens are equal too."""
    pixels = decode(image)
    return pixels is None or float(grey_of(pixels).std()) > FLAT


def _travel_m(run: Run, group: Sequence[SampledImage]) -> float:
    """Wheel travel from the first to the last image of a group; damaged ones do not count."""
    if group[0].damage:
        return 0.0
    stamps_s = [group[0].stamp_s, group[-1].stamp_s]
    return float(np.ptp(np.interp(stamps_s, run.odometry.stamps_s, run.wheel_travel_m)))


def outside_of_odometry(run: Run) -> Iterator[Finding]:
    """Images before or after the treads were recorded; half and more is a matter of clocks."""
    if run.images is None:
        return
    stamps_s = run.images.stamps_s
    first_s, last_s = float(run.odometry.stamps_s[0]), float(run.odometry.stamps_s[-1])
    before, after = int(np.sum(stamps_s < first_s)), int(np.sum(stamps_s > last_s))
    share = (before + after) / len(stamps_s)
    if FEW_OUTSIDE < share <= 0.5:  # above, odometry.checks.stamps.stamps reports it
        yield Finding(
            "images_outside",
            Level.NOTE,
            f"{counted(before, 'image')} before and {after} after the stamps of odometry.csv (of "
            f"{len(stamps_s)})",
            "The camera was recorded for longer than the treads, or odometry.csv was cut",
            "Nothing to do: these images are not used",
        )
