"""Parameters in the terms of ordinary differential drives and of filters that take them in."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.terrain_beliefs import icr_form
from odometry.identification.fitted import NORMAL
from odometry.models.catalogue import model_named
from odometry.parameters import TerrainParameters
from odometry.windows.window_errors import WindowErrors


@dataclass(frozen=True)
class Stated:
    """A number with its 95 % interval; the ends are NaN where nothing identified it."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class DriveNumbers:
    """One terrain in the numbers of a differential drive.

    Attributes
    ----------
    terrain, model : str
    track_width_m : float
        The wheel separation b that `separation` multiplies.
    separation : Stated
        (y_left - y_right) / b.
    left, right : Stated
        Factors on the wheel radii: alpha_left, alpha_right.
    x_icr_m, y_middle_m : Stated
        Where the differential drive is exact, in the robot frame: x_icr and c.
    turning_slip : Stated
        Share of the yaw rate of wheels that do not slip which is lost on the spot:
        1 - (alpha_left + alpha_right) / (2 s).
    effects : tuple of str
        Names of effects of the table, which these numbers leave out.
    """

    terrain: str
    model: str
    track_width_m: float
    separation: Stated
    left: Stated
    right: Stated
    x_icr_m: Stated
    y_middle_m: Stated
    turning_slip: Stated
    effects: tuple[str, ...] = ()


def drive_numbers(
    terrain: str, table: TerrainParameters, track_width_m: float | None
) -> DriveNumbers:
    """The numbers of a terrain, intervals by the table's covariance to first order.

    Parameters
    ----------
    terrain : str
    table : TerrainParameters
        Of a model with constant ICRs.
    track_width_m : float or None
        None takes that of the table's model.

    Raises
    ------
    ParameterError
        If the model has no constant ICRs, or the track width is not known.
    """
    form = icr_form(table, f"[terrain.{terrain}]")
    width_m = table.values.get("track_width") if track_width_m is None else track_width_m
    if width_m is None:
        raise ParameterError(
            f"[terrain.{terrain}]: the model {table.model!r} does not give the track width, which "
            "the wheel separation is a multiple of: give --track-width METRES"
        )
    y_left, y_right, x_icr = form.icrs.tolist()
    alpha_left, alpha_right = form.alphas.tolist()
    separation = (y_left - y_right) / width_m
    kept = (alpha_left + alpha_right) / 2 / separation
    by_icrs = np.array([1.0, -1.0, 0.0, 0.0, 0.0])
    by_alphas = np.array([0.0, 0.0, 0.0, 0.5, 0.5]) / separation
    of_form = {
        "separation": (separation, by_icrs / width_m),
        "left": (alpha_left, np.eye(5)[3]),
        "right": (alpha_right, np.eye(5)[4]),
        "x_icr_m": (x_icr, np.eye(5)[2]),
        "y_middle_m": ((y_left + y_right) / 2, np.array([0.5, 0.5, 0.0, 0.0, 0.0])),
        "turning_slip": (1 - kept, kept * by_icrs / (y_left - y_right) - by_alphas),
    }
    numbers = {
        name: _stated(value, table, gradient @ form.by_parameters)
        for name, (value, gradient) in of_form.items()
    }
    effects = tuple(str(effect.get("name", "")) for effect in table.effects)
    return DriveNumbers(terrain, table.model, float(width_m), **numbers, effects=effects)


def _stated(value: float, table: TerrainParameters, gradient: FloatArray) -> Stated:
    """A number whose derivative by the model's own parameters (P,) is given.

    A parameter that the table may leave out, and states no uncertainty of, was held.
    """
    slopes = {
        parameter.name: slope
        for parameter, slope in zip(model_named(table.model).parameters, gradient, strict=True)
        if slope and not parameter.known
        if parameter.default is None or parameter.name in table.covariance_order
    }
    if not slopes or not set(slopes) <= set(table.covariance_order):
        return Stated(value, np.nan, np.nan)
    by = np.array(list(slopes.values()))
    half = NORMAL * float(np.sqrt(max(by @ table.covariance_of(tuple(slopes)) @ by, 0.0)))
    return Stated(value, value - half, value + half)


@dataclass(frozen=True)
class Pace:
    """How fast a robot drove: mean wheel speed, and mean size of its yaw rate."""

    wheel_speed_m_s: float
    yaw_rate_rad_s: float


@dataclass(frozen=True)
class MotionErrors:
    """Standard deviations of the error of motions, per metre of wheel travel.

    Attributes
    ----------
    along_m_per_m : float
        Along each axis.
    yaw_rad_per_m : float
    horizon_m : float
        Wheel travel of the windows.
    source : str
        What they were measured on.
    """

    along_m_per_m: float
    yaw_rad_per_m: float
    horizon_m: float
    source: str

    @classmethod
    def of_windows(cls, errors: WindowErrors, horizon_m: float, source: str) -> "MotionErrors":
        """From errors of windows: half of a squared distance belongs to each axis."""
        along, yaw = (
            float(np.mean(np.square(each)))
            for each in (errors.translation_per_m, errors.rotation_per_m)
        )
        return cls(sqrt(along / 2), sqrt(yaw), horizon_m, source)

    @classmethod
    def of_means(
        cls, translation_m_per_m: float, rotation_rad_per_m: float, horizon_m: float, source: str
    ) -> "MotionErrors":
        """From mean errors, as of normal ones: a distance (Rayleigh), and an absolute value."""
        along, yaw = translation_m_per_m / sqrt(pi / 2), rotation_rad_per_m * sqrt(pi / 2)
        return cls(along, yaw, horizon_m, source)

    def twist_variances(self, pace: Pace, left_over_m: tuple[float, float]) -> FloatArray:
        """Variances (3,) of v_x, v_y [m^2/s^2] and omega [rad^2/s^2] at a pace.

        Parameters
        ----------
        pace : Pace
        left_over_m : (2,)
            Of v_x and v_y over the yaw rate, where the odometry has no such term: the middle of
            the ICRs and `x_icr`.
        """
        own = np.array([self.along_m_per_m, self.along_m_per_m, self.yaw_rad_per_m])
        left_over = np.array([*left_over_m, 0.0]) * pace.yaw_rate_rad_s
        return np.asarray((own * pace.wheel_speed_m_s) ** 2 + left_over**2)

    def pose_variances_per_s(self, pace: Pace) -> FloatArray:
        """Growth (3,) of the variances of x, y [m^2/s] and yaw [rad^2/s] at a pace."""
        own = np.array([self.along_m_per_m, self.along_m_per_m, self.yaw_rad_per_m])
        return np.asarray(own**2 * self.horizon_m * pace.wheel_speed_m_s)
