"""What a terrain's ICRs are in the numbers of an ordinary differential drive.

A differential drive with wheel separation s b and factors m_left, m_right on its wheel radii (the
odometry of ROS 2's `diff_drive_controller`) moves by

    v_x = (m_right v_right + m_left v_left) / 2,  v_y = 0,
    omega = (m_right v_right - m_left v_left) / (s b).

With e_left = alpha_left v_left and e_right = alpha_right v_right, W = y_left - y_right and
c = (y_left + y_right) / 2, the ICRs (Baril 2020 eq. 7) move the robot's origin by

    omega = (e_right - e_left) / W,
    v_x = (e_right y_left - e_left y_right) / W = (e_right + e_left) / 2 + c omega,
    v_y = -x_icr omega.

So m_left = alpha_left, m_right = alpha_right and s = W / b give the same omega. What is left over,
c omega of v_x and -x_icr omega of v_y, no multiplier can give. But a point at (x_icr, c) of the
robot moves by v_x - c omega and v_y + x_icr omega: there the differential drive is exact. A frame
fixed at that point, as the base frame of the controller's odometry, expresses the whole model.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.icr_prior import icr_form
from odometry.identification.fitted import NORMAL
from odometry.models.catalogue import model_named
from odometry.parameters import TerrainParameters


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
