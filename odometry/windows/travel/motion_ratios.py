"""How far a robot turned and went in windows, over what given parameters predict."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.windows.travel.motion import Moving, window_motion
from odometry.windows.travel.windows import Windows

HORIZON_M = 1.0  # of a window
FEWEST_WINDOWS = 5
LEAST_TURN_RAD = 0.05  # of windows, root mean square: where both have less nothing is known
LEAST_WAY_M = 0.2  # the same; less has a robot that spins on the spot, and noise alone is a way
TURNS, WAY = 0.25, 0.15  # relative: one terrain differs by less from day to day
CERTAIN = 4.0  # standard deviations
TINY = 1e-12


@dataclass(frozen=True)
class MotionRatios:
    """Measured over predicted, and standard deviations; 1 where they agree.

    Attributes
    ----------
    turn, turn_sd, way, way_sd : float
        Of turns, and of the distance between the ends of windows; NaN where nothing says it.
    """

    turn: float
    turn_sd: float
    way: float
    way_sd: float

    @property
    def turns_otherwise(self) -> bool:
        """Whether the robot surely turned farther or less far than predicted."""
        return _differs(self.turn, self.turn_sd, TURNS)

    @property
    def goes_otherwise(self) -> bool:
        """Whether the robot surely went farther or less far than predicted."""
        return _differs(self.way, self.way_sd, WAY)

    @property
    def words(self) -> str:
        """What differs for certain: turned 1.77 +- 0.01 times; empty where nothing does."""
        parts = [f"turned {self.turn:.2f} +- {self.turn_sd:.2f} times"] * self.turns_otherwise
        parts += [f"went {self.way:.2f} +- {self.way_sd:.2f} times"] * self.goes_otherwise
        return " and ".join(parts)


def motion_ratios(model: Moving, values: FloatArray, windows: Windows) -> MotionRatios:
    """The ratios over windows (K) of HORIZON_M, of a model with packed parameters (P,)."""
    predicted = window_motion(model, values, windows)
    turns_rad = predicted[:, 2], windows.measured[:, 2]
    predicted_m, measured_m = (np.hypot(*of[:, :2].T) for of in (predicted, windows.measured))
    return MotionRatios(
        *_ratio(*turns_rad, LEAST_TURN_RAD), *_ratio(predicted_m, measured_m, LEAST_WAY_M)
    )


def _ratio(predicted: FloatArray, measured: FloatArray, least: float) -> tuple[float, float]:
    """Measured over predicted (K) and its standard deviation; NaN where both are small."""
    if max(float(np.sqrt(np.mean(each**2))) for each in (predicted, measured)) > least:
        return _slope(predicted, measured)
    return float("nan"), float("nan")


def _differs(ratio: float, sd: float, share: float) -> bool:
    """Whether a ratio is surely more than 1 + share, or less than one over it."""
    far = ratio > 1 + share or ratio * (1 + share) < 1
    return far and abs(ratio - 1) > CERTAIN * sd


def _slope(predicted: FloatArray, measured: FloatArray) -> tuple[float, float]:
    """Slope through the origin and its standard deviation, by leaving out each window once."""
    products, squares = predicted * measured, predicted**2
    slopes = (products.sum() - products) / np.maximum(squares.sum() - squares, TINY)
    count = len(slopes)
    spread = float(np.sqrt((count - 1) / count * np.sum((slopes - slopes.mean()) ** 2)))
    return float(products.sum() / max(squares.sum(), TINY)), spread
