"""How many details of the same terrain an image shows, compared with the one before it."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from terrain.camera.camera import Camera
from terrain.image_labels.carried_image import carried_back, places_of_squares
from terrain.images import to_grey

WIDTH_PX = 320  # of the images that are compared: larger ones are reduced to it
OCTAVES, SMOOTHED_PX = 3, 3  # finest first: what a mean over so many pixels takes away of each
LESS_MEAN = -np.full((SMOOTHED_PX, SMOOTHED_PX), SMOOTHED_PX**-2.0, np.float32)
LESS_MEAN[SMOOTHED_PX // 2, SMOOTHED_PX // 2] += 1.0
TILE_PX, FEWEST_TILES = 32, 8
LEAST_GREY, LEAST_DETAIL = 5.0, 0.5  # so that darkness and noise do not count
LEAST_SHARE = 0.5  # of the tiles of common terrain: the median of few of them is uncertain
DISTINCT = 1.0  # grey levels of details: tiles with less may show noise alone
# Logarithm of a change on the same terrain from an image to the next, of 15 rocking and noisy
# cameras. Of the contrast -0.19 and more; fog of 0.5 of the contrast -0.5 and less in 95 of 100,
# gamma 0.6 never. Of the focus -0.47 and more; blur of 2 px of 640 -0.35 to -0.9, blur by motion
# of 9 px below -0.4 in 2 of 100
LOSS = float(np.log(0.6))
# The change in place of a quarter of the tiles, from which on images are compared on the same
# terrain. It was lower in all of 1918 images of four cameras that lost details, and in 0 to 14 % of
# clear ones; held out in all of 3514, and in 1 to 3 %
QUARTER, IN_PLACE = 0.25, -0.3


@dataclass(frozen=True, eq=False)
class TileDetails:
    """What each tile of a grey image (h, w) shows, row by row.

    Attributes
    ----------
    image : (h, w)
    octaves : (OCTAVES, K)
        Logarithms of the details, finest octave first.
    light : (K,)
        Logarithms of the light.
    """

    image: AnyArray
    octaves: FloatArray
    light: FloatArray

    @classmethod
    def of(cls, image: AnyArray) -> Self:
        """Details of a grey image (h, w)."""
        values = whole = _whole_tiles(image.astype(np.float32))
        octaves = []
        for octave in range(OCTAVES):
            values = cv2.pyrDown(values) if octave else values
            fine = cv2.filter2D(values, cv2.CV_32F, LESS_MEAN)
            octaves.append(0.5 * np.log(_mean_squares(fine, TILE_PX >> octave) + LEAST_DETAIL**2))
        return cls(image, np.array(octaves), np.log(_means(whole, TILE_PX) + LEAST_GREY))

    @property
    def level(self) -> float:
        """Mean logarithm of details over light, whatever the image shows."""
        return float((self.octaves.mean(axis=0) - self.light).mean())


def reduced(image: AnyArray) -> AnyArray:
    """An image (H, W) or (H, W, 3) in grey, at most WIDTH_PX wide."""
    if image.shape[1] > WIDTH_PX:
        height = max(1, round(image.shape[0] * WIDTH_PX / image.shape[1]))
        image = cv2.resize(image, (WIDTH_PX, height), interpolation=cv2.INTER_AREA)
    return to_grey(image)


def _whole_tiles(image: AnyArray) -> AnyArray:
    rows, columns = (length // TILE_PX * TILE_PX for length in image.shape)
    return image[:rows, :columns]


def _means(values: AnyArray, size_px: int) -> FloatArray:
    """Means (K,) of the squares of an image (h, w), row by row."""
    size = values.shape[1] // size_px, values.shape[0] // size_px
    means = cv2.resize(values, size, interpolation=cv2.INTER_AREA)
    return np.asarray(means.ravel(), dtype=np.float64)


def _mean_squares(values: AnyArray, size_px: int) -> FloatArray:
    """Means (K,) of the squared values of the squares of an image (h, w), row by row."""
    rows, columns = values.shape[0] // size_px, values.shape[1] // size_px
    strips = values.reshape(rows, size_px, -1)
    sums = np.einsum("spc,spc->sc", strips, strips).reshape(rows, columns, size_px).sum(axis=2)
    return np.asarray(sums.ravel() / size_px**2, dtype=np.float64)


def change_of_details(
    camera: Camera, before: TileDetails, after: AnyArray, step: FloatArray
) -> FloatArray | None:
    """How details of one image have changed in another.

    A veil (fog) takes from the details, and more from the details over the light. Light alone
    leaves the second as they are, another gamma leaves most of the first: only what both have lost,
    or gained, is a change of contrast. The finest details, which noise hides first, say more of
    the focus; no blur leaves more of them than there were.

    Parameters
    ----------
    camera : Camera
    before : TileDetails
    after : (h, w)
        Grey, of the same size.
    step : (3,)
        x, y [m], yaw [rad] of the second robot frame in the first.

    Returns
    -------
    (2,) or None
        Logarithms of the changes of contrast (geometric mean of the changes of coarser details and
        of these over light; 0 where one rises and one falls), and of focus (the finest details over
        those of the next octave, and no more than the finest have lost themselves): medians over
        tiles of terrain that both show, and of which one shows details. None where these are too
        few.
    """
    if before.image.shape != after.shape:
        return None
    carried, in_block, common = carried_back(camera, after, step, TILE_PX)
    if np.count_nonzero(common) < FEWEST_TILES:
        return None
    there = TileDetails.of(carried)
    octaves, light = before.octaves[:, in_block], before.light[in_block]
    levels = np.maximum(octaves.mean(axis=0), there.octaves.mean(axis=0))
    compared = common & (levels > np.log(DISTINCT))
    fewest = max(FEWEST_TILES, LEAST_SHARE * np.count_nonzero(common))
    if np.count_nonzero(compared) < fewest:
        return None
    return _changes(there.octaves - octaves, there.light - light, compared, 0.5)


def may_have_lost(camera: Camera, before: TileDetails, after: TileDetails) -> bool:
    """Whether an image shows fewer details in place than one before, whatever terrain is there.

    A quarter of the tiles do after a loss, unless nearly all terrain in sight has become another
    one that shows more. This takes a fifth of the time of `change_of_details`.
    """
    if before.image.shape != after.image.shape:
        return True
    places = places_of_squares(camera, after.image.shape, TILE_PX)
    levels = np.maximum(before.octaves.mean(axis=0), after.octaves.mean(axis=0))
    compared = np.isfinite(places[:, 0]) & (levels > np.log(DISTINCT))
    if np.count_nonzero(compared) < FEWEST_TILES:
        return True
    octaves, light = after.octaves - before.octaves, after.light - before.light
    return bool(_changes(octaves, light, compared, QUARTER).min() < IN_PLACE)


def _changes(
    octaves: FloatArray, light: FloatArray, compared: BoolArray, share: float
) -> FloatArray:
    """Changes (2,) of contrast and focus by those of octaves (OCTAVES, K) and light (K,).

    So large a share of the compared tiles has these changes or lower ones.
    """
    finest, *coarser = octaves[:, compared]
    details = np.mean(coarser, axis=0)
    over_light = light[compared]
    of_tiles = np.array(
        [details, details - over_light, finest, finest - over_light, finest - coarser[0]]
    )
    *changes, focus = np.quantile(of_tiles, share, axis=1)
    contrast, of_finest = (_of_both(*changes[i : i + 2]) for i in (0, 2))
    return np.array([contrast, max(focus, min(of_finest, 0.0))])


def _of_both(of_details: float, over_light: float) -> float:
    """What details and details over light both have lost, or gained; else 0."""
    return float(np.sign(of_details) * np.sqrt(max(of_details * over_light, 0.0)))
