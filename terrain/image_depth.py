"""Images of 16 bits that hold fewer, as 12-bit cameras store them: nearly black as they are."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, spread
from odometry.checks.findings.finding import counted
from odometry.errors import OdometryError

USUAL = (8, 10, 12, 14)  # bits
SAMPLED = 8  # files of a folder that are looked at
DEEP_SUFFIXES = frozenset({".png", ".tif", ".tiff"})


def bits_held(largest: int) -> int | None:
    """Bits of images of 16 whose largest value is this one: 8 to 14, or None where 16."""
    bits = max(largest.bit_length(), 1)
    return next((depth for depth in USUAL if bits <= depth), None)


def in_words(count: int, largest: int) -> str:
    """What images of 16 bits are when 65535 is white."""
    return (
        f"{counted(count, 'image')} of 16 bits, where the largest value is {largest}: read as 16 "
        f"bits, where 65535 is white, they have at most {largest // 257} of 256 grey levels"
    )


def check_depth(files: Sequence[Path], error: type[OdometryError]) -> None:
    """Refuse images of 16 bits that hold fewer.

    A few files of each folder are looked at. A dark image of 16 bits may have small values alone,
    so that all folders count together, and a folder alone where it has at most 12 bits.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming a folder.
    """
    of_folder: dict[Path, list[Path]] = {}
    for file in files:
        if file.suffix.lower() in DEEP_SUFFIXES:
            of_folder.setdefault(file.parent, []).append(file)
    values = {folder: _largest_values(within) for folder, within in sorted(of_folder.items())}
    values = {folder: found for folder, found in values.items() if found}
    together = max((max(found) for found in values.values()), default=0)
    for folder, found in values.items():
        bits = bits_held(max(found))
        if bits is not None and (bits <= 12 or bits_held(together) is not None):
            raise error(
                f"{folder}: {in_words(len(found), max(found))}. The files hold {bits}-bit data: "
                f"multiply the values by {2 ** (16 - bits)}, or store 8 bits"
            )


def _largest_values(files: Sequence[Path]) -> list[int]:
    """Of each image of 16 bits among some of the files; of no other."""
    found = []
    for place in spread(len(files), SAMPLED):
        image: AnyArray | None = cv2.imread(str(files[place]), cv2.IMREAD_UNCHANGED)
        if image is not None and image.dtype == np.uint16:
            found.append(int(image.max()))
    return found
