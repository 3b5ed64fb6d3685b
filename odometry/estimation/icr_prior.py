"""Prior estimate of a terrain's ICRs, before any measurement there."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.estimate import IcrBelief
from odometry.models.base import IcrForm
from odometry.models.catalogue import MODELS, model_named
from odometry.parameters import ParameterSet, TerrainParameters

ICR_FORM_MODELS = tuple(name for name, model in MODELS.items() if model.has_constant_icrs)
BROAD_SIGMA_WIDTHS = 0.5  # standard deviation of the broad prior, in track widths
BROAD_SIGMA_ALPHA = 0.2  # of the slip of both treads together
BROAD_SIGMA_SIDES = 0.05  # of the difference between their slip factors


def prior_belief(
    parameters: ParameterSet,
    terrain: str,
    track_width: float,
    reset_sigma_m: float,
    reset_sigma_alpha: float,
) -> IcrBelief:
    """ICRs of a terrain from its table, or a broad prior centred on the track width.

    Parameters
    ----------
    parameters : ParameterSet
    terrain : str
    track_width : float
        [m]
    reset_sigma_m, reset_sigma_alpha : float
        Standard deviation of an ICR [m] and of a slip factor where the table states none. With 0
        slip factors are known, whatever a table states.

    Raises
    ------
    ParameterError
        If the table's model has no constant ICRs.
    """
    table = parameters.terrains.get(terrain)
    if table is None:
        icrs = np.array([track_width / 2, -track_width / 2, 0.0])
        return IcrBelief(icrs, np.ones(2), _broad(track_width, reset_sigma_alpha > 0))
    form = icr_form(table, f"[terrain.{terrain}]")
    unstated = np.array([reset_sigma_m] * 3 + [reset_sigma_alpha] * 2)
    covariance = _covariance(table, form, unstated)
    if reset_sigma_alpha == 0:
        covariance[3:], covariance[:, 3:] = 0.0, 0.0
    return IcrBelief(form.icrs, form.alphas, covariance)


def _broad(track_width: float, slips: bool) -> FloatArray:
    covariance = np.zeros((5, 5))
    covariance[:3, :3] = (BROAD_SIGMA_WIDTHS * track_width) ** 2 * np.eye(3)
    if slips:
        covariance[3:, 3:] = BROAD_SIGMA_ALPHA**2 + BROAD_SIGMA_SIDES**2 / 2 * np.eye(2)
    return covariance


def _covariance(table: TerrainParameters, form: IcrForm, unstated: FloatArray) -> FloatArray:
    """Covariance (5, 5) of ICRs and slip factors: what the table states, else `unstated` (5,).

    An ICR is stated where the table states every parameter that it follows from and that is not
    known of the robot. ICRs that follow from one parameter are taken as independent all the same:
    that they move together is what the model supposes, not what was measured.
    """
    model = model_named(table.model)
    names = [parameter.name for parameter in model.parameters]
    stated = np.array([name in table.covariance_order for name in names])
    needed = np.array([not parameter.known for parameter in model.parameters])
    follows = form.by_parameters != 0
    is_stated = np.any(follows & stated, axis=1) & ~np.any(follows & needed & ~stated, axis=1)
    order = tuple(name for name in names if name in table.covariance_order)
    by_stated = form.by_parameters[:, stated]
    shared = follows.astype(int) @ follows.T > 0
    apart = np.eye(5, dtype=np.bool_) | ~shared
    both = is_stated & is_stated[:, None]
    mapped = by_stated @ table.covariance_of(order) @ by_stated.T
    return np.where(both, np.where(apart, mapped, 0.0), np.diag(unstated**2))


def icr_form(table: TerrainParameters, where: str) -> IcrForm:
    """The constant ICRs of a table, without its effects.

    Raises
    ------
    ParameterError
        If its model has none.
    """
    model = model_named(table.model)
    if not model.has_constant_icrs:
        raise ParameterError(
            f"{where}: the model {table.model!r} has no constant ICRs; the ICR filter takes "
            f"{', '.join(ICR_FORM_MODELS)}"
        )
    try:
        return model.icr_form(model.pack(table.values))
    except ParameterError as error:
        raise ParameterError(f"{where}: {error}") from error
