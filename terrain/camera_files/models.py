"""The lens that a distortion model's name and coefficients mean."""

import numpy as np

from odometry.arrays import FloatArray
from terrain.camera_files.calibration import Lens
from terrain.camera_files.equidistant import pinhole_of_equidistant
from terrain.errors import CameraError

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
            raise CameraError(f"distortion model {name!r} has 4 values, seen {coefficients.size}")
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
