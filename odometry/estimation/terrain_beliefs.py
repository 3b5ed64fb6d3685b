"""Estimates of ICRs and slip factors where the terrain changes, and before any measurement."""

from collections.abc import Mapping

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.estimate import OF_TERRAIN, Crossing, Estimate, IcrBelief
from odometry.estimation.measurement import Gaussian
from odometry.models.base import IcrForm
from odometry.models.catalogue import MODELS, model_named
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import UNKNOWN
from odometry.recording.run_terrains import Footing

OF_TERRAIN_BLOCK = np.ix_(OF_TERRAIN, OF_TERRAIN)

ICR_FORM_MODELS = tuple(name for name, model in MODELS.items() if model.has_constant_icrs)
SIDES = np.array([1, -1, 0, 1, -1])  # of y_left, y_right, x_icr, alpha_left, alpha_right
BROAD_SIGMA_WIDTHS = 0.5  # standard deviation of the broad prior, in track widths
BROAD_SIGMA_ALPHA = 0.2  # of the slip of both treads together
BROAD_SIGMA_SIDES = 0.05  # of the difference between their slip factors


class TerrainBeliefs:
    """ICRs known by terrain, and how a filter's estimate changes from one terrain to another.

    Parameters
    ----------
    track_width : float
        [m]
    parameters : ParameterSet
        What is known before the run.
    config : IcrEkfConfig
    """

    def __init__(self, track_width: float, parameters: ParameterSet, config: IcrEkfConfig) -> None:
        self._track_width = track_width
        self._parameters = parameters
        self._reset_sigma_m = config.reset_sigma_widths * track_width
        self._reset_sigma_alpha = config.reset_sigma_alpha

    def prior(self, terrain: str) -> IcrBelief:
        """What was known of a terrain before the run."""
        return prior_belief(
            self._parameters,
            terrain,
            self._track_width,
            self._reset_sigma_m,
            self._reset_sigma_alpha,
        )

    def moved(
        self, belief: Gaussian, estimate: Estimate, footing: Footing
    ) -> tuple[Gaussian, Mapping[str, IcrBelief], Crossing | None]:
        """State estimate on another terrain, estimates kept from before, and the present crossing.

        From whole to whole, from `unknown` and to it the ICRs change in one step (Chen 2023).
        """
        here, crossing, learned = estimate.terrain, estimate.crossing, estimate.learned
        if crossing is None and here != UNKNOWN:
            learned = {**learned, here: estimate.belief}
        if footing.terrain == UNKNOWN:
            return self._opened(belief), learned, None
        if here == UNKNOWN or (crossing is None and footing.is_whole):
            return self._switched(belief, learned, footing.terrain), learned, None
        before = crossing or Crossing({here: 1.0}, {here: estimate.belief})
        known = {name: self._known(name, learned) for name in footing.shares} | dict(before.known)
        resets = {name: self._reset(of) for name, of in known.items()}
        belief = crossed(belief, known, before.shares, footing.shares, resets)
        return belief, learned, None if footing.is_whole else Crossing(footing.shares, known)

    def _switched(
        self, belief: Gaussian, learned: Mapping[str, IcrBelief], terrain: str
    ) -> Gaussian:
        known = self._known(terrain, learned)
        mean, covariance = belief[0].copy(), belief[1].copy()
        mean[OF_TERRAIN] = *known.icrs, *known.alphas
        covariance[OF_TERRAIN], covariance[:, OF_TERRAIN] = 0.0, 0.0
        covariance[OF_TERRAIN_BLOCK] = self._reset(known)
        return mean, covariance

    def _opened(self, belief: Gaussian) -> Gaussian:
        """On unknown terrain: the ICRs as they are, and less certain."""
        covariance = belief[1].copy()
        sigmas = [self._reset_sigma_m] * 3 + [self._reset_sigma_alpha] * 2
        covariance[OF_TERRAIN, OF_TERRAIN] += np.square(sigmas)
        return belief[0], covariance

    def _known(self, terrain: str, learned: Mapping[str, IcrBelief]) -> IcrBelief:
        """What was learned on a terrain, or known before where that is the more certain."""
        known = self.prior(terrain)
        if terrain in learned and _is_more_certain(learned[terrain], known):
            return learned[terrain]
        return known

    def _reset(self, known: IcrBelief) -> FloatArray:
        """Chen 2023, 3.2.3: P_B, or what is known where that is less certain."""
        reset = np.zeros((5, 5))
        sigmas = (self._reset_sigma_m, self._reset_sigma_alpha)
        for block, sigma in zip((slice(0, 3), slice(3, 5)), sigmas, strict=True):
            wide = sigma**2 * np.eye(block.stop - block.start)
            stated = known.covariance[block, block]
            reset[block, block] = stated if np.trace(stated) > np.trace(wide) else wide
        return reset


def _is_more_certain(one: IcrBelief, other: IcrBelief) -> bool:
    return bool(np.trace(one.covariance[:3, :3]) < np.trace(other.covariance[:3, :3]))


def crossed(
    belief: Gaussian,
    known: Mapping[str, IcrBelief],
    before: Mapping[str, float],
    after: Mapping[str, float],
    opened: Mapping[str, FloatArray],
) -> Gaussian:
    """Move a state estimate from some shares of terrains to others.

    The mean moves by what each terrain gains or loses of its share, times the ICRs known there,
    so that what was learned on the way stays. Whole to whole in many steps moves it as in one.

    Parameters
    ----------
    belief : mean (9,), covariance (9, 9)
    known : Mapping of terrain to IcrBelief
        The ICRs of every terrain that has or had a share.
    before, after : Mapping of terrain to share
    opened : Mapping of terrain to (5, 5)
        Covariance that a whole share gained adds to that of the ICRs and slip factors.
    """
    mean, covariance = belief[0].copy(), belief[1].copy()
    block = np.ix_(OF_TERRAIN, OF_TERRAIN)
    for name, of in known.items():
        gained = after.get(name, 0.0) - before.get(name, 0.0)
        mean[OF_TERRAIN] += gained * np.concatenate([of.icrs, of.alphas])
        if gained > 0:
            covariance[block] += gained * opened[name]
    return mean, covariance


def prior_belief(
    parameters: ParameterSet,
    terrain: str,
    track_width: float,
    reset_sigma_m: float,
    reset_sigma_alpha: float,
) -> IcrBelief:
    """ICRs of a terrain from its table, or a broad prior.

    The prior is centred on the mean of the terrains that have a table: a robot that drags its
    treads turns wider than its track on all of them. Without any it is centred on the track width.

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
        icrs, alphas = _of_other_terrains(parameters, track_width)
        return IcrBelief(icrs, alphas, _broad(track_width, reset_sigma_alpha > 0))
    form = icr_form(table, f"[terrain.{terrain}]")
    unstated = np.array([reset_sigma_m] * 3 + [reset_sigma_alpha] * 2)
    covariance = _covariance(table, form, unstated)
    if reset_sigma_alpha == 0:
        covariance[3:], covariance[:, 3:] = 0.0, 0.0
    return IcrBelief(form.icrs, form.alphas, covariance)


def _of_other_terrains(
    parameters: ParameterSet, track_width: float
) -> tuple[FloatArray, FloatArray]:
    """Mean ICRs (3,) and slip factors (2,) of the terrains that have some."""
    forms = [
        icr_form(table, f"[terrain.{name}]")
        for name, table in parameters.terrains.items()
        if table.model in ICR_FORM_MODELS
    ]
    if not forms:
        return np.array([track_width / 2, -track_width / 2, 0.0]), np.ones(2)
    icrs, alphas = zip(*((form.icrs, form.alphas) for form in forms), strict=True)
    return np.mean(icrs, axis=0), np.mean(alphas, axis=0)


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
    that they move together is what the model supposes, not what was measured. So is then what
    belongs to the other tread: an ICR moves with the slip factor of its own tread alone.
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
    alone = shared.sum(axis=1) == 1
    of_one_side = SIDES[:, None] == SIDES
    apart = np.eye(5, dtype=np.bool_) | ~shared & (of_one_side | alone & alone[:, None])
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
