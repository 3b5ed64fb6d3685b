"""What a calibration file says of one camera."""

from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from odometry.arrays import FloatArray
from terrain.camera_values import intrinsic_matrix, lens_coefficients, size_in_pixels
from terrain.distortion import distort, undistort


@dataclass(frozen=True, eq=False)
class Lens:
    """Matrix and distortion, in the order and pixels of `[camera]`; see `terrain.camera.Camera`."""

    image_size: tuple[int, int]
    matrix: FloatArray
    distortion: FloatArray

    @classmethod
    def of(cls, image_size: tuple[int, int], matrix: ArrayLike, distortion: ArrayLike = ()) -> Self:
        """A lens of checked values; raises CameraError as `Camera.from_mount`."""
        coefficients = np.asarray(distortion, dtype=np.float64)
        return cls(
            size_in_pixels(image_size), intrinsic_matrix(matrix), lens_coefficients(coefficients)
        )

    def rays(self, pixels: FloatArray) -> FloatArray:
        """Normalised coordinates (N, 2) without distortion of pixels (N, 2); NaN where none is."""
        return undistort((pixels - self.matrix[:2, 2]) / self.focus_px, self.distortion)

    def pixels(self, rays: FloatArray) -> FloatArray:
        """Pixels (N, 2) of normalised coordinates; the inverse of `rays`."""
        return np.asarray(distort(rays, self.distortion) * self.focus_px + self.matrix[:2, 2])

    @property
    def focus_px(self) -> FloatArray:
        """Focal lengths (2,) along u and v."""
        return self.matrix[[0, 1], [0, 1]]

    def to_table(self) -> dict[str, Any]:
        """Its keys of `[camera]`."""
        return {
            "image_size": list(self.image_size),
            "matrix": self.matrix.tolist(),
            "distortion": self.distortion.tolist(),
        }


@dataclass(frozen=True, eq=False)
class Calibration:
    """One camera of a calibration file.

    Attributes
    ----------
    name : str
        As the file calls it; "" where it does not.
    lens : Lens
    camera_from_imu : (4, 4) or None
        Points of an IMU's frame into the optical frame (Kalibr's T_cam_imu).
    mount : (6,) or None
        In the robot frame, where the file says it.
    notes : tuple of str
        What a reader should know of how it was read.
    """

    name: str
    lens: Lens
    camera_from_imu: FloatArray | None = None
    mount: FloatArray | None = None
    notes: tuple[str, ...] = field(default=())
