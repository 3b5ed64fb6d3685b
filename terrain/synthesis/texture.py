"""A photograph laid on the terrain by mirror tiling, for look-up without aliasing."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import AnyArray, ByteImage, FloatArray


@dataclass(frozen=True, eq=False)
class Texture:
    """Mirror-tiled photograph with an image pyramid.

    Attributes
    ----------
    levels : tuple of float32 arrays
        (H, W) or (H, W, 3); each level averages 2 x 2 pixels of the one before.
    metres_per_pixel : float
        Scale of the first level on the terrain.
    origin_world : (2,) array
        World point under the photograph's top left corner [m].
    angle_rad : float
        Direction of the photograph's columns (its x axis) in the world.
    """

    levels: tuple[AnyArray, ...]
    metres_per_pixel: float
    origin_world: FloatArray
    angle_rad: float

    @classmethod
    def laid(
        cls,
        photo: ByteImage,
        metres_per_pixel: float,
        *,
        angle_rad: float,
        photo_point_px: ArrayLike,
        world_point: ArrayLike,
    ) -> Self:
        """Lay a photograph so that one of its points lies on a point of the world.

        Parameters
        ----------
        photo : (H, W) or (H, W, 3) array of uint8
        metres_per_pixel : float
        angle_rad : float
            Direction of the photograph's columns in the world; its rows lead to the right of it.
        photo_point_px : (2,) array_like
            Distance along columns and rows from the photograph's top left corner.
        world_point : (2,) array_like
            Where that point lies [m].
        """
        levels: list[AnyArray] = [photo.astype(np.float32)]
        while min(levels[-1].shape[:2]) > 8:
            height, width = levels[-1].shape[:2]
            half = ((width + 1) // 2, (height + 1) // 2)
            levels.append(cv2.resize(levels[-1], half, interpolation=cv2.INTER_AREA))
        across, down = np.asarray(photo_point_px, dtype=np.float64) * metres_per_pixel
        cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
        offset = np.array([cosine * across + sine * down, sine * across - cosine * down])
        origin = np.asarray(world_point, dtype=np.float64) - offset
        return cls(tuple(levels), metres_per_pixel, origin, angle_rad)

    @classmethod
    def laid_at_random(
        cls, photo: ByteImage, metres_per_pixel: float, rng: np.random.Generator
    ) -> Self:
        """Lay a photograph at a random angle, any of its points on the world's origin."""
        height, width = photo.shape[:2]
        return cls.laid(
            photo,
            metres_per_pixel,
            angle_rad=rng.uniform(-np.pi, np.pi),
            photo_point_px=rng.uniform((0, 0), (width, height)),
            world_point=(0.0, 0.0),
        )

    def look_up(self, points_world: AnyArray, detail_m: AnyArray) -> AnyArray:
        """Brightness at world points, averaged over about the size of a camera pixel there.

        Parameters
        ----------
        points_world : (H, W, 2) array
            Ground points [m].
        detail_m : (H, W) array
            Size of the patch of terrain to average over [m].

        Returns
        -------
        (H, W) or (H, W, 3) float32 array
        """
        across, down = self._photo_coordinates(points_world)
        level = np.log2(np.maximum(detail_m / self.metres_per_pixel, 1.0))
        level = np.minimum(level, len(self.levels) - 1)
        result = np.zeros(points_world.shape[:2] + self.levels[0].shape[2:], np.float32)
        for i in range(int(level.min()), int(np.ceil(level.max())) + 1):
            weight = np.maximum(0.0, 1.0 - np.abs(level - i)).astype(np.float32)
            used = np.flatnonzero(weight.any(axis=1))
            if used.size:
                rows = slice(used[0], used[-1] + 1)
                seen = self._tiled(i, across[rows], down[rows])
                share = weight[rows]
                result[rows] += seen * (share if seen.ndim == 2 else share[..., None])
        return result

    def _photo_coordinates(self, points_world: AnyArray) -> tuple[AnyArray, AnyArray]:
        """Distance along columns and rows of the photograph, in pixels from its corner."""
        cosine, sine = np.cos(self.angle_rad), np.sin(self.angle_rad)
        x = (points_world[..., 0] - self.origin_world[0]) / self.metres_per_pixel
        y = (points_world[..., 1] - self.origin_world[1]) / self.metres_per_pixel
        return cosine * x + sine * y, sine * x - cosine * y

    def _tiled(self, i: int, across: AnyArray, down: AnyArray) -> AnyArray:
        """Level `i` at mirror-tiled photo coordinates; its first pixel's centre is at a half."""
        (height, width), (rows, columns) = self.levels[0].shape[:2], self.levels[i].shape[:2]
        u = _fold(across * (columns / width), columns) - 0.5
        v = _fold(down * (rows / height), rows) - 0.5
        u, v = u.astype(np.float32), v.astype(np.float32)
        return np.asarray(
            cv2.remap(self.levels[i], u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
        )


def _fold(distance: AnyArray, length: int) -> AnyArray:
    """Walk to and fro between 0 and `length`."""
    return np.asarray(length - np.abs(np.mod(distance, 2 * length) - length))
