"""Places of the image that are darker than those round them all the time."""

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from terrain.image_labels.carried_image import tiles
from terrain.image_labels.terrain_details import LEAST_GREY

DARKER = 0.35  # logarithm of light: terrain that the robot crosses has 0.33 at most
SURELY = 10.0  # standard errors of the mean of the images: such terrain has 5
ROUNDS, FAR = 30, 2.0  # of the fit, and deviations from which a tile counts less


def lasting_shade(images: AnyArray, near: BoolArray, tile_px: int) -> tuple[BoolArray, FloatArray]:
    """Tiles (K,) that are dark in all images, and how much the light of each varies.

    The light of terrain changes smoothly over the image, as that of a lens does: a quadratic in
    the place of a tile is fitted to the means, and tiles far below it stand out.

    Parameters
    ----------
    images : (N, h, w)
        In grey.
    near : (K,)
        Tiles of terrain, row by row; the others are not looked at.
    tile_px : int

    Returns
    -------
    (K,) booleans
    (K,)
        Standard deviation of the logarithm of the light, 0 where no terrain is near.
    """
    shaded, deviation = np.zeros(len(near), dtype=np.bool_), np.zeros(len(near))
    light = np.array([np.log(tiles(one, tile_px).mean(axis=1) + LEAST_GREY) for one in images])
    light = light[:, near] - np.median(light[:, near], axis=1, keepdims=True)
    rows, columns = (length // tile_px for length in images.shape[1:])
    mean, deviation[near] = light.mean(axis=0), light.std(axis=0)
    below = _fitted(_terms(rows, columns)[near], mean) - mean
    error = deviation[near] / np.sqrt(len(light)) + 1e-3
    shaded[near] = (below > DARKER) & (below > SURELY * error)
    return shaded, deviation


def _terms(rows: int, columns: int) -> FloatArray:
    """Terms (K, 6) of a quadratic in the place of each tile, row by row."""
    v, u = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1, 1, columns), indexing="ij")
    terms = [np.ones_like(u), u, v, u * u, u * v, v * v]
    return np.stack(terms, axis=-1).reshape(-1, len(terms))


def _fitted(terms: FloatArray, values: FloatArray) -> FloatArray:
    """Values (K,) of the quadratic that fits most of the tiles (weights of a Cauchy error)."""
    weights, fitted = np.ones(len(values)), values
    for _ in range(ROUNDS):
        found, *_ = np.linalg.lstsq(terms * weights[:, None], values * weights, rcond=None)
        fitted = terms @ found
        off = np.abs(values - fitted)
        deviation = 1.48 * float(np.median(off)) + 1e-6
        weights = 1 / np.sqrt(1 + (off / (FAR * deviation)) ** 2)
    return np.asarray(fitted)
