"""The camera: ground plane to image pixels and back, from any calibration."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import AnyArray, BoolArray, FloatArray
from terrain.camera.camera_values import (
    finite_array,
    homography_of_mount,
    intrinsic_matrix,
    lens_coefficients,
    pose_key,
    signed_homography,
    size_in_pixels,
)
from terrain.camera.distortion import distort, undistort
from terrain.camera.robot_outlines import checked_outlines, covered
from terrain.errors import CameraError


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera with lens distortion above flat terrain.

    Make one with `from_mount`, `from_homography` or `from_table`. Pixels are (u, v), u to the
    right, v down, with (0, 0) at the centre of the top left pixel. Ground points are (x, y) in
    metres in the robot frame (x forward, y left, z = 0).

    Attributes
    ----------
    image_size : (int, int)
        Width and height in pixels.
    matrix : (3, 3) array
        Intrinsic matrix, shared by raw and undistorted pixels.
    distortion : (n,) array
        Lens coefficients in OpenCV's order, n one of 0, 4, 5, 8, 12, 14.
    ground_to_image : (3, 3) array
        Homography from ground (x, y, 1) to undistorted pixels (u, v, 1), signed so that its
        third component is positive in front of the camera.
    mount : (6,) array or None
        x, y, z [m], roll, pitch, yaw [rad] of the camera in the robot frame, if known.
    robot_outlines : tuple of (n, 2) arrays
        Polygons in raw pixels of parts of the image that show the robot itself.

    Examples
    --------
    >>> import numpy as np
    >>> import terrain
    >>> matrix = np.array([[460.0, 0.0, 319.5], [0.0, 460.0, 239.5], [0.0, 0.0, 1.0]])
    >>> mount = (0.1, 0.0, 1.0, 0.0, 0.6, 0.0)  # 1 m high, looking 34 degrees down
    >>> camera = terrain.Camera.from_mount((640, 480), matrix, np.zeros(5), mount)
    >>> print(camera.ground_to_pixels([[1.5, 0.0]]).round(1))
    [[319.5 248.8]]
    """

    image_size: tuple[int, int]
    matrix: FloatArray
    distortion: FloatArray
    ground_to_image: FloatArray
    mount: FloatArray | None = None
    robot_outlines: tuple[FloatArray, ...] = ()

    @classmethod
    def from_mount(
        cls,
        image_size: tuple[int, int],
        matrix: ArrayLike,
        distortion: ArrayLike,
        mount: ArrayLike,
    ) -> Self:
        """Camera whose place and attitude in the robot frame are known.

        Parameters
        ----------
        image_size : (int, int)
            Width and height in pixels.
        matrix : (3, 3) array_like
            Intrinsic matrix without skew.
        distortion : (n,) array_like
            Lens coefficients in OpenCV's order; empty for none.
        mount : (6,) array_like
            x, y, z [m], roll, pitch, yaw [rad]; R = Rz(yaw) Ry(pitch) Rx(roll). The camera's own
            x is its viewing direction, y left, z up, so that a positive pitch points down.

        Raises
        ------
        CameraError
            If a shape or value is wrong, or the camera is not above the ground.
        """
        intrinsics = intrinsic_matrix(matrix)
        place = finite_array("mount", mount, (6,))
        homography = homography_of_mount(intrinsics, place)
        return cls(
            size_in_pixels(image_size), intrinsics, lens_coefficients(distortion), homography, place
        )

    @classmethod
    def from_homography(
        cls,
        image_size: tuple[int, int],
        matrix: ArrayLike,
        distortion: ArrayLike,
        ground_to_image: ArrayLike,
    ) -> Self:
        """Camera known by its homography from the ground, of any scale and sign.

        Parameters
        ----------
        image_size, matrix, distortion
            As for `from_mount`.
        ground_to_image : (3, 3) array_like
            From robot-frame ground (x, y, 1) in metres to undistorted pixels (u, v, 1).

        Raises
        ------
        CameraError
            If a shape or value is wrong, or the homography is singular.
        """
        intrinsics = intrinsic_matrix(matrix)
        homography = signed_homography(ground_to_image, intrinsics)
        return cls(
            size_in_pixels(image_size), intrinsics, lens_coefficients(distortion), homography
        )

    @classmethod
    def from_table(cls, table: Mapping[str, Any], where: str = "run.toml") -> Self:
        """Camera from the `[camera]` table of a run folder; keys it does not name are ignored.

        Raises
        ------
        CameraError
            If a key is missing or wrong, or not exactly one of `mount` and `ground_to_image` is
            there; the message names `where`. `robot_outlines` may be missing.
        """
        if not isinstance(table, Mapping):
            raise CameraError(f"{where}: camera = {table!r}, expected a table [camera]")
        try:
            pose = pose_key(table)
            make = cls.from_mount if pose == "mount" else cls.from_homography
            camera = make(table["image_size"], table["matrix"], table["distortion"], table[pose])
            outlines = checked_outlines(table.get("robot_outlines", ()), camera.image_size)
            return replace(camera, robot_outlines=outlines)
        except CameraError as error:
            raise CameraError(f"{where}: [camera] {error}") from error

    def to_table(self) -> dict[str, Any]:
        """Plain values of the `[camera]` table; the inverse of `from_table`."""
        table: dict[str, Any] = {
            "image_size": list(self.image_size),
            "matrix": self.matrix.tolist(),
            "distortion": self.distortion.tolist(),
        }
        if self.robot_outlines:
            table["robot_outlines"] = [outline.tolist() for outline in self.robot_outlines]
        if self.mount is None:
            return table | {"ground_to_image": self.ground_to_image.tolist()}
        return table | {"mount": self.mount.tolist()}

    @cached_property
    def ground_to_ray(self) -> FloatArray:
        """Matrix (3, 3) from ground (x, y, 1) to rays in the optical frame, z the depth."""
        return np.asarray(np.linalg.solve(self.matrix, self.ground_to_image))

    @cached_property
    def height_m(self) -> float:
        """Height of the camera above the ground [m], of a mount or of a homography.

        H = s K R [e1 e2 -c] has the determinant -s^3 fx fy c_z.
        """
        scale = float(np.mean(np.linalg.norm(self.ground_to_ray[:, :2], axis=0)))
        return float(-np.linalg.det(self.ground_to_ray) / scale**3)

    def ground_to_pixels(self, points: ArrayLike) -> FloatArray:
        """Where ground points appear in the raw (distorted) image (Chen 2023 eq. 17).

        Parameters
        ----------
        points : (..., 2) array_like
            Robot-frame ground points [m].

        Returns
        -------
        (..., 2) array
            Raw pixels (u, v), inside the image or not (see `in_image`). NaN for points behind
            the camera, or so far off its axis that the lens model no longer holds.
        """
        ground = np.asarray(points, dtype=np.float64)
        matrix = self.ground_to_ray
        rays = ground.reshape(-1, 2) @ matrix[:, :2].T + matrix[:, 2]
        depth = np.where(rays[:, 2] > 0, rays[:, 2], np.nan)
        raw = distort(rays[:, :2] / depth[:, None], self.distortion)
        return _apply(self.matrix, raw).reshape(ground.shape)

    def pixels_to_ground(self, pixels: ArrayLike) -> FloatArray:
        """Ground points at raw (distorted) pixels; the inverse of `ground_to_pixels`.

        Parameters
        ----------
        pixels : (..., 2) array_like
            Raw pixels (u, v).

        Returns
        -------
        (..., 2) array
            Robot-frame ground points [m]. NaN at or above the horizon, and where the lens model
            has no inverse.
        """
        raw = np.asarray(pixels, dtype=np.float64)
        normalised = _apply(np.asarray(np.linalg.inv(self.matrix)), raw.reshape(-1, 2))
        rays = undistort(normalised, self.distortion)
        ground = np.column_stack([rays, np.ones(len(rays))]) @ np.linalg.inv(self.ground_to_ray).T
        weight = np.where(ground[:, 2] > 0, ground[:, 2], np.nan)
        return np.asarray(ground[:, :2] / weight[:, None]).reshape(raw.shape)

    def in_image(self, pixels: ArrayLike) -> BoolArray:
        """Whether pixels (..., 2) lie in the image, as (...) booleans; NaN does not."""
        places = np.asarray(pixels, dtype=np.float64)
        u, v = places[..., 0], places[..., 1]
        width, height = self.image_size
        return np.asarray((u >= 0) & (u <= width - 1) & (v >= 0) & (v <= height - 1))

    def shows_terrain(self, pixels: ArrayLike) -> BoolArray:
        """Whether pixels (..., 2) lie in the image, outside of `robot_outlines`, as booleans."""
        inside = self.in_image(pixels)
        if not self.robot_outlines:
            return inside
        at = np.where(inside[..., None], np.asarray(pixels, dtype=np.float64), 0.0)
        u, v = np.moveaxis(np.rint(at).astype(np.int64), -1, 0)
        return np.asarray(inside & ~self._robot[v, u])

    @cached_property
    def _robot(self) -> BoolArray:
        return covered(self.robot_outlines, self.image_size)

    def check_size(self, image: AnyArray) -> None:
        """Raise CameraError unless the image (H, W, ...) is of the camera's size."""
        height, width = image.shape[:2]
        if (width, height) != self.image_size:
            seen, expected = f"{width}x{height}", "{}x{}".format(*self.image_size)
            raise CameraError(f"the image is {seen} pixels, the camera's are {expected}")


def _apply(matrix: FloatArray, points: FloatArray) -> FloatArray:
    """Affine 3x3 matrix applied to points (N, 2)."""
    return np.asarray(points @ matrix[:2, :2].T + matrix[:2, 2])
