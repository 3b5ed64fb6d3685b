"""Whether the values of an effect agree with its name, lie within the search, and are determined.

Each gate returns "" where the effect passes, else the reason as a clause.
"""

import numpy as np

from odometry.effects.interface.base import EffectParameter
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted

WITHIN_95 = 1.96  # standard deviations


def is_the_effect(fit: Fitted, config: GapConfig) -> str:
    """Whether the last effect of a fit agrees with its name, and is significant."""
    added = fit.effects[-1]
    if reason := is_meant(added):
        return reason
    if not is_there(fit, config):
        return "its values do not surely differ from those of no effect"
    return within_bounds(fit, config)


def is_meant(added: Added) -> str:
    """Whether an effect agrees with its name and with no other, beside all others too."""
    if rival := added.effect.mimicked_by:
        return f"{added.effect.in_words}, or {rival}: no data of a run distinguish them"
    if added.effect.is_meant(added.values):
        return ""
    return f"its values ({_words(added)}) are not what the name says"


def is_there(fit: Fitted, config: GapConfig) -> bool:
    """Whether the last effect of a fit is more than an effect that does nothing.

    Its parameters are tested together (Wald), those that shape it held: each alone may be
    uncertain where only a product of them is known.
    """
    added = fit.effects[-1]
    absent = [parameter.absent for parameter in added.effect.parameters]
    known = np.array([value is not None for value in absent])
    if not known.any():
        return True
    away = np.array([a - b for a, b in zip(added.values, absent, strict=True) if b is not None])
    count = len(absent)
    scales = np.array([parameter.scale for parameter in added.effect.parameters])
    covariance = fit.covariance[-count:, -count:] / np.outer(scales, scales)
    information = np.linalg.pinv(covariance, hermitian=True)[np.ix_(known, known)]
    away = away / scales[known]
    return bool(away @ information @ away > config.sure**2 * known.sum())


def essence_spans_none(fit: Fitted, place: int) -> bool:
    """Whether the intervals of all that makes one effect of a fit what it is span none."""
    begin = sum(len(one.values) for one in fit.effects[:place])
    added = fit.effects[place]
    sigmas = np.sqrt(np.maximum(np.diag(fit.covariance)[begin : begin + len(added.values)], 0.0))
    return all(
        abs(value - (parameter.absent or 0.0)) < WITHIN_95 * sigma
        for parameter, value, sigma in zip(
            added.effect.parameters, added.values, sigmas, strict=True
        )
        if parameter.name in added.effect.essential
    )


def within_bounds(fit: Fitted, config: GapConfig) -> str:
    """No parameter of the effect's strength may end at a bound, nor its interval span the bounds.

    Where an effect does nothing at a bound, to end there is an answer; those that shape an effect
    may be open as long as its strength is known.
    """
    added = fit.effects[-1]
    if isinstance(added.effect, Residual):
        return ""
    sigmas = np.sqrt(np.maximum(np.diag(fit.covariance)[-len(added.values) :], 0.0))
    spans = []
    for parameter, value, sigma in zip(added.effect.parameters, added.values, sigmas, strict=True):
        if parameter.absent is None:
            continue
        if _is_at_bound(parameter, value, config):
            return f"{parameter.name} = {value:.4g} is at the end of what was searched"
        reach = WITHIN_95 * sigma
        spans.append(value - reach <= parameter.low and value + reach >= parameter.high)
    return "its parameters may be anything" if spans and all(spans) else ""


def _is_at_bound(parameter: EffectParameter, value: float, config: GapConfig) -> bool:
    near = config.near_bound * parameter.scale
    for bound in (parameter.low, parameter.high):
        if abs(value - bound) <= near and bound != parameter.absent:
            return True
    return False


def _words(added: Added) -> str:
    return ", ".join(f"{name} = {value:.4g}" for name, value in added.by_name.items())
