"""What is believed of a terrain's ICRs before any measurement there."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.estimate import IcrBelief
from odometry.models.catalogue import ICR_NAMES
from odometry.parameters import ParameterSet, TerrainParameters

ICR_FORM_MODELS = ("icr", "icr_symmetric", "differential_drive", "traction_mode")
WIDTH_NAMES = {"icr_symmetric": "b_hat", "differential_drive": "track_width"}
BROAD_SIGMA_WIDTHS = 0.5  # standard deviation of the broad prior, in track widths


def prior_belief(
    parameters: ParameterSet, terrain: str, track_width: float, reset_sigma_m: float
) -> IcrBelief:
    """ICRs of a terrain from its table, or a broad prior centred on the track width.

    Parameters
    ----------
    parameters : ParameterSet
    terrain : str
    track_width : float
        [m]
    reset_sigma_m : float
        Standard deviation where the table states none [m].

    Raises
    ------
    ParameterError
        If the table's model has no constant ICRs.
    """
    table = parameters.terrains.get(terrain)
    if table is None:
        sigma = BROAD_SIGMA_WIDTHS * track_width
        return IcrBelief(
            np.array([track_width / 2, -track_width / 2, 0.0]), np.ones(2), sigma**2 * np.eye(3)
        )
    icrs, alphas = icr_form(table, f"[terrain.{terrain}]")
    return IcrBelief(icrs, alphas, _covariance(table, reset_sigma_m))


def _covariance(table: TerrainParameters, reset_sigma_m: float) -> FloatArray:
    """Covariance (3, 3) of the ICRs: what the table states, `reset_sigma_m` for the rest."""
    covariance = reset_sigma_m**2 * np.eye(3)
    stated = tuple(name for name in ICR_NAMES[:3] if name in table.covariance_order)
    places = [ICR_NAMES.index(name) for name in stated]
    covariance[np.ix_(places, places)] = table.covariance_of(stated)
    width = WIDTH_NAMES.get(table.model)
    if width in table.covariance_order:  # y_left = -y_right = width / 2
        covariance[[0, 1], [0, 1]] = table.covariance_of((width,))[0, 0] / 4
    return covariance


def icr_form(table: TerrainParameters, where: str) -> tuple[FloatArray, FloatArray]:
    """ICRs (3,) and slip factors (2,) of a model that has constant ones, its effects left out.

    Raises
    ------
    ParameterError
        If the model has none.
    """
    values = table.values
    match table.model:
        case "icr":
            icrs = [values["y_left"], values["y_right"], values["x_icr"]]
            alphas = [values.get("alpha_left", 1.0), values.get("alpha_right", 1.0)]
        case "icr_symmetric":
            icrs = [values["b_hat"] / 2, -values["b_hat"] / 2, 0.0]
            alphas = [values["alpha"], values["alpha"]]
        case "differential_drive":
            icrs = [values["track_width"] / 2, -values["track_width"] / 2, 0.0]
            alphas = [1.0, 1.0]
        case "traction_mode":  # alpha_left = alpha_right = k, y_left - y_right = b k / m
            if values["m"] * values["k"] <= 0:
                raise ParameterError(
                    f"{where}: k = {values['k']} and m = {values['m']}, expected both above 0"
                )
            width = values["track_width"] * values["k"] / values["m"]
            icrs = [width / 2, -width / 2, 0.0]
            alphas = [values["k"], values["k"]]
        case _:
            raise ParameterError(
                f"{where}: the model {table.model!r} has no constant ICRs; the ICR filter takes "
                f"{', '.join(ICR_FORM_MODELS)}"
            )
    return np.array(icrs), np.array(alphas)
