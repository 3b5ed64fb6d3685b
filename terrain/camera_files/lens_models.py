"""What a calibration file says of one camera, and the lens of a distortion model's name."""

from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from odometry.arrays import FloatArray
from terrain.camera.camera_values import intrinsic_matrix, lens_coefficients, size_in_pixels
from terrain.camera.distortion import distort, radius_limit, undistort
from terrain.errors import CameraError

WIDEST_DEG = 80.0  # of rays off the axis: at 90 degrees a pinhole's image is infinitely large
WORST_PX = 0.25
SAMPLES = 400
MARGIN = 1.02  # the fit goes a little beyond the corners


@dataclass(frozen=True, eq=False)
class Lens:
    """Matrix and distortion, in the order and pixels of `[camera]`; see `terrain.Camera`."""

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


def pinhole_of_equidistant(
    image_size: tuple[int, int], matrix: FloatArray, coefficients: FloatArray
) -> tuple[Lens, float]:
    """Fit the eight coefficients of the rational model to an equidistant lens.

    The lens is theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), theta the
    angle off the axis (Kannala and Brandt 2006; cv2.fisheye; Kalibr's `equidistant`).

    Parameters
    ----------
    image_size : (int, int)
    matrix : (3, 3)
    coefficients : (4,)
        k1 to k4.

    Returns
    -------
    Lens
    float
        The largest error of the fit over the image [px].

    Raises
    ------
    CameraError
        If the image shows rays of more than WIDEST_DEG off the axis, the model turns back on
        itself within the image, or the fit is off by more than WORST_PX.
    """
    corners = np.array([[0, 0], [1, 0], [0, 1], [1, 1]]) * (np.array(image_size) - 1)
    focus = matrix[[0, 1], [0, 1]]
    reach = float(np.linalg.norm((corners - matrix[:2, 2]) / focus, axis=1).max())
    theta = np.linspace(0.0, _angle_of(reach, coefficients) * MARGIN, SAMPLES)
    radius, bent = np.tan(theta), _bent(theta, coefficients)
    points = np.column_stack([radius, np.zeros(SAMPLES)])
    for terms in (3, 2):  # three may fit with a pole within the image, where two have none
        distortion = _rational(radius, bent, terms)
        if radius_limit(distortion) < radius[-1]:
            continue
        worst_px = float(np.abs(distort(points, distortion)[:, 0] - bent).max() * focus.max())
        if worst_px <= WORST_PX:
            return Lens.of(image_size, matrix, distortion), worst_px
    raise CameraError(_refused(f"no rational distortion comes within {WORST_PX:g} px of it"))


def _bent(theta: FloatArray, coefficients: FloatArray) -> FloatArray:
    square = theta * theta
    k1, k2, k3, k4 = coefficients
    return np.asarray(theta * (1 + square * (k1 + square * (k2 + square * (k3 + square * k4)))))


def _angle_of(reach: float, coefficients: FloatArray) -> float:
    """The angle off the axis [rad] of the farthest corner, whose distorted radius is `reach`."""
    theta = np.linspace(0.0, np.radians(WIDEST_DEG), 20 * SAMPLES)
    bent = _bent(theta, coefficients)
    rising = np.diff(bent) > 0
    if not rising.all() and bent[: int(rising.argmin()) + 1].max() < reach:
        raise CameraError(_refused("its model turns back on itself within the image"))
    if bent.max() < reach:
        raise CameraError(
            _refused(f"the image shows rays of more than {WIDEST_DEG:g} degrees off its axis")
        )
    return float(np.interp(reach, bent[: int(bent.argmax()) + 1], theta[: int(bent.argmax()) + 1]))


def _rational(radius: FloatArray, bent: FloatArray, terms: int) -> FloatArray:
    """Coefficients in OpenCV's order of bent = r (1 + k1 s + k2 s^2 + ...) / (1 + k4 s + ...)."""
    powers = radius[:, None] ** (2 * np.arange(1, terms + 1))

    def errors(coefficients: FloatArray) -> FloatArray:
        above, below = (1 + powers @ part for part in np.split(coefficients, 2))
        return np.asarray(radius * above / below - bent)

    # the linear form of the same, each row weighted by the size of its terms, starts the search
    linear = np.hstack([radius[:, None] * powers, -bent[:, None] * powers])
    weights = 1 / np.maximum(np.abs(linear).sum(axis=1), 1e-9)
    start, *_ = np.linalg.lstsq(linear * weights[:, None], (bent - radius) * weights, rcond=None)
    found = least_squares(errors, start, method="lm", x_scale=np.maximum(np.abs(start), 1e-6))
    above, below = (np.pad(part, (0, 3 - terms)) for part in np.split(found.x, 2))
    return np.array([above[0], above[1], 0.0, 0.0, above[2], *below])


def _refused(why: str) -> str:
    return (
        f"the lens is a fisheye (equidistant) that [camera] cannot express: {why}. Undistort the "
        "images first (cv2.fisheye.undistortImage, or image_proc) and give the matrix of the "
        "undistorted images with no distortion"
    )


# names of ROS, Kalibr and OpenCV; "" is OpenCV's, which writes none
PINHOLE = ("", "plumb_bob", "radtan", "rational_polynomial", "thin_prism", "none", "pinhole")
FISHEYE = ("equidistant", "fisheye", "kannala_brandt4")


def lens_of(
    model: str, image_size: tuple[int, int], matrix: FloatArray, coefficients: FloatArray
) -> tuple[Lens, tuple[str, ...]]:
    """A lens of `[camera]`, and notes on how it came about.

    Parameters
    ----------
    model : str
        Name of the distortion model.
    image_size : (int, int)
    matrix : (3, 3)
    coefficients : (n,)

    Raises
    ------
    CameraError
        If the model is unknown, or `[camera]` cannot express it.
    """
    name = model.strip().lower()
    if name in FISHEYE:
        if coefficients.size != 4:
            raise CameraError(f"distortion model {name!r} has 4 values, found {coefficients.size}")
        if not np.isfinite(coefficients).all():
            raise CameraError(f"distortion holds values that are not finite: {coefficients}")
        # Lens.of checks size and matrix before they are computed with
        plain = Lens.of(image_size, matrix)
        lens, worst_px = pinhole_of_equidistant(plain.image_size, plain.matrix, coefficients)
        return lens, (
            f"the fisheye ({name}) is expressed by OpenCV's rational distortion, which differs by "
            f"{worst_px:.2g} px at most",
        )
    if name not in PINHOLE:
        raise CameraError(
            f"distortion model {model!r} is not one of {', '.join(PINHOLE[1:] + FISHEYE)}"
        )
    if name == "none":
        return Lens.of(image_size, matrix), ()
    return Lens.of(image_size, matrix, coefficients), ()
