"""Which variables predict the residuals: rank tests, false discoveries controlled.

A variable is cut into groups (quantiles, sectors of the circle, labels), and the statistic is that
of Kruskal and Wallis 1952 (J. Am. Stat. Assoc. 47(260)), the largest over four residuals: size,
along, across, turn, in standard deviations of noise. Neighbouring windows share a pose and are
not independent, so that it is judged not by its usual distribution, but by draws in which the
pieces of the runs change places: what is correlated within a piece stays together. To each draw an
error is added that the calibration leaves open, lest it be taken for a finding. Over all
variables false discoveries are controlled after Benjamini and Hochberg 1995 (J. R. Stat. Soc. B
57(1)).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import false_discovery_control, rankdata

from odometry.arrays import FloatArray, IntArray
from odometry.gap.locate.variables import ANGLE, LABEL, Variable
from odometry.gap.prepare.end_residuals import Ends

FALSE_DISCOVERIES = 0.05
DRAWS = 1999
SEED = 0
QUANTILES, SECTORS = 5, 6  # groups of a scalar and of an angle
RESIDUALS = ("size", "along", "across", "turn")  # the size is that of the position


@dataclass(frozen=True)
class Predictor:
    """A variable that may predict the residuals.

    Attributes
    ----------
    name, unit : str
    p_value : float
        Of "it predicts nothing".
    discovered : bool
        Whether it is significant where false discoveries among all variables are held at 5 %.
    strength : float
        Share (0 to 1) of the variance of ranks that it explains, of the residual of which it
        explains most; what chance explains is taken off.
    predicts : str
        That residual: "size", "along", "across" or "turn".
    """

    name: str
    unit: str
    p_value: float
    discovered: bool
    strength: float
    predicts: str


def predictors(variables: Sequence[Variable], ends: Ends) -> tuple[Predictor, ...]:
    """Test every variable; discoveries first, the strongest first."""
    if not variables:
        return ()
    deviations = np.sqrt(ends.variance)
    normalised = ends.motion / deviations
    ranks = _ranks(normalised[None])
    drawn_ranks = _ranks(_draws(normalised, ends.leeway / deviations[..., None], ends.pieces))
    p_values, strengths, kinds = [], [], []
    for variable in variables:
        groups = groups_of(variable)
        found = _kruskal_wallis(ranks, groups)[0]
        drawn = _kruskal_wallis(drawn_ranks, groups).max(axis=1)
        p_values.append((1 + np.sum(drawn >= found.max())) / (1 + DRAWS))
        count = len(np.unique(groups))
        kind = int(found.argmax())
        strengths.append(max(0.0, (found[kind] - count + 1) / max(1, len(groups) - count)))
        kinds.append(RESIDUALS[kind])
    controlled = false_discovery_control(p_values)
    made = [
        Predictor(v.name, v.unit, float(p), bool(q <= FALSE_DISCOVERIES), float(strength), kind)
        for v, p, q, strength, kind in zip(
            variables, p_values, controlled, strengths, kinds, strict=True
        )
    ]
    return tuple(sorted(made, key=lambda one: (not one.discovered, -one.strength)))


def groups_of(variable: Variable) -> IntArray:
    """Number (K,) of the group in which each window falls."""
    values = variable.values
    if variable.kind == LABEL:
        return np.unique(values, return_inverse=True)[1].astype(np.int64)
    if variable.kind == ANGLE:
        sectors = np.floor((values + np.pi) / (2 * np.pi) * SECTORS)
        return np.clip(sectors, 0, SECTORS - 1).astype(np.int64)
    inner = np.quantile(values, np.arange(1, QUANTILES) / QUANTILES)
    return np.searchsorted(np.unique(inner), values, side="right").astype(np.int64)


def _draws(normalised: FloatArray, leeway: FloatArray, pieces: IntArray) -> FloatArray:
    """Residuals (R, K, 3) that no variable predicts: whole pieces shuffled, and moved along."""
    rng = np.random.default_rng(SEED)
    windows = [np.flatnonzero(pieces == number) for number in np.unique(pieces)]
    count = len(normalised)
    order, moved = np.empty((DRAWS, count), dtype=np.int64), np.empty((DRAWS, 1), dtype=np.int64)
    for number in range(DRAWS):
        order[number] = np.concatenate([windows[i] for i in rng.permutation(len(windows))])
        moved[number] = rng.integers(count)
    drawn = normalised[np.take_along_axis(order, (np.arange(count) - moved) % count, axis=1)]
    errors = rng.standard_normal((DRAWS, leeway.shape[-1]))
    return np.asarray(drawn + np.einsum("kif,rf->rki", leeway, errors, optimize=True))


def _ranks(normalised: FloatArray) -> FloatArray:
    """Ranks (R, K, 4) among the windows, in the order of `RESIDUALS`."""
    size = np.hypot(normalised[..., 0], normalised[..., 1])
    values = np.concatenate([size[..., None], normalised], axis=-1)
    order = np.argsort(values, axis=1)
    in_order = np.take_along_axis(values, order, axis=1)
    if not (in_order[:, 1:] > in_order[:, :-1]).all():
        return np.asarray(rankdata(values, axis=1))  # where some are equal, in twice the time
    ranks = np.empty_like(values)
    places = np.arange(1.0, values.shape[1] + 1)[:, None]
    np.put_along_axis(ranks, order, np.broadcast_to(places, values.shape), axis=1)
    return ranks


def _kruskal_wallis(ranks: FloatArray, groups: IntArray) -> FloatArray:
    """The statistic (R, C) of ranks (R, K, C)."""
    members = groups[:, None] == np.unique(groups)
    counts = members.sum(axis=0)
    count = len(groups)
    sums = np.einsum("rkc,kg->rgc", ranks, members.astype(np.float64), optimize=True)
    spread = (sums**2 / counts[:, None]).sum(axis=1)
    return np.asarray(12 / (count * (count + 1)) * spread - 3 * (count + 1))
