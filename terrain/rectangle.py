"""Rectangles on the ground plane, along the axes of the robot frame."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray


@dataclass(frozen=True)
class Rectangle:
    """A rectangle on the ground plane, its sides along the axes of the robot frame now [m].

    Examples
    --------
    >>> import terrain
    >>> ahead = terrain.Rectangle(x_min=0.8, x_max=1.4, y_min=-0.3, y_max=0.3)
    >>> ahead.corners.shape
    (4, 2)
    """

    x_min: float
    x_max: float
    y_min: float
    y_max: float

    @classmethod
    def round(cls, centre: FloatArray, half_size: FloatArray) -> "Rectangle":
        """From its middle (2,) and half its sides (2,) along x and y."""
        (x_min, y_min), (x_max, y_max) = centre - half_size, centre + half_size
        return cls(float(x_min), float(x_max), float(y_min), float(y_max))

    @property
    def corners(self) -> FloatArray:
        """Corners (4, 2), far left first, clockwise in the image."""
        return np.array(
            [
                [self.x_max, self.y_max],
                [self.x_max, self.y_min],
                [self.x_min, self.y_min],
                [self.x_min, self.y_max],
            ]
        )

    @property
    def middle(self) -> FloatArray:
        """Its middle (2,)."""
        return np.array([self.x_min + self.x_max, self.y_min + self.y_max]) / 2
