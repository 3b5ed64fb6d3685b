"""Size and scale of the patches: what the footprint covers, and what the cameras resolve."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from math import ceil, floor, inf, log10

import numpy as np

from odometry.config import require, require_positive
from terrain.classification.training import LARGEST_PATCH_PX
from terrain.errors import PatchError
from terrain.labelling.squares import SquareFinder
from terrain.region.region import RegionConfig
from terrain.region.warp import ground_sampling_m

SIDE = 0.6  # of the width of the footprint
SMALLEST_PX = 32
IMAGES = 50  # of a run from which the scale is chosen


@dataclass(frozen=True)
class LabelConfig:
    """Settings of `label`.

    Attributes
    ----------
    patch_size_px : int or None
        Side of a patch; None takes 0.6 of the width of the robot, at most 128 pixels.
    metres_per_pixel : float or None
        None takes what a camera resolves of the nearest terrain that is driven over.
    per_place : int
        Patches of one terrain at one place, at the most.
    place_m : float
        Distance between the centres of places, at the least; five sides of a patch if that is more.

    Examples
    --------
    >>> import terrain
    >>> terrain.LabelConfig(patch_size_px=96).per_place
    24
    """

    patch_size_px: int | None = None
    metres_per_pixel: float | None = None
    per_place: int = 24
    place_m: float = 2.0

    def __post_init__(self) -> None:
        require_positive(self, "per_place", "place_m")
        for name in ("patch_size_px", "metres_per_pixel"):
            if getattr(self, name) is not None:
                require_positive(self, name)
        size = self.patch_size_px
        require(size is None or size >= 8, f"patch_size_px = {size}, expected 8 or more")


@dataclass(frozen=True)
class PatchScale:
    """Side and scale of square patches."""

    size_px: int
    metres_per_pixel: float

    @property
    def side_m(self) -> float:
        """Side on the terrain."""
        return self.size_px * self.metres_per_pixel

    @property
    def coarsest_m(self) -> float:
        """An image may resolve the terrain this much more coarsely, as a region."""
        return RegionConfig.coarsest * self.metres_per_pixel


def patch_scale(finders: Sequence[SquareFinder], config: LabelConfig) -> PatchScale:
    """One size and scale for the patches of all runs.

    Raises
    ------
    PatchError
        If no image shows terrain that the robot then drove over, or a patch would have too few
        pixels, or would be wider than a robot.
    """
    width_m = min(finder.way.footprint.width_m for finder in finders)
    side_m, size_px, scale = SIDE * width_m, config.patch_size_px, config.metres_per_pixel
    if scale is None:
        resolved_m = max(_resolved_m(finder, side_m) for finder in finders)
        largest_m = side_m / (size_px or SMALLEST_PX)
        scale = min(_rounded_up(max(resolved_m, side_m / (size_px or LARGEST_PATCH_PX))), largest_m)
    if size_px is None:
        size_px = min(LARGEST_PATCH_PX, floor(side_m / scale + 1e-9))
        if size_px < SMALLEST_PX:
            raise PatchError(
                f"0.6 of the robot's width, {side_m:.2f} m, is {size_px} pixels of {scale:g} m, "
                f"expected {SMALLEST_PX} or more; choose a smaller scale, or give the patch size"
            )
    chosen = PatchScale(size_px, scale)
    if chosen.side_m > width_m:
        raise PatchError(
            f"{size_px} pixels of {scale:g} m are {chosen.side_m:.2f} m, more than the width of "
            f"the robot, {width_m:.2f} m: no such patch is driven over whole"
        )
    return chosen


def _resolved_m(finder: SquareFinder, side_m: float) -> float:
    """Median over images of how much the coarsest pixel covers of the nearest driven square."""
    rows = finder.image_rows(side_m)
    chosen = (
        rows[np.unique(np.linspace(0, len(rows) - 1, IMAGES).astype(int))] if len(rows) else rows
    )
    squares = finder.squares(side_m, inf, chosen)
    coarsest = [
        min(ground_sampling_m(finder.camera, square.rectangle)[1] for square in of_image)
        for _, of_image in groupby(squares, key=lambda square: square.stamp_s)
    ]
    if not coarsest:
        raise PatchError(
            f"{finder.run.folder}: none of {len(chosen)} images shows terrain of "
            f"{side_m:.2f} x {side_m:.2f} m that the robot then drove over; see [camera] of "
            "run.toml, and `terrain-odometry check`"
        )
    return float(np.median(coarsest))


def _rounded_up(scale: float) -> float:
    """To two digits."""
    unit = 10.0 ** (floor(log10(scale)) - 1)
    return float(f"{ceil(scale / unit - 1e-9) * unit:.2g}")
