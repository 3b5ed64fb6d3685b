"""Whether a fit is plausible: reasons to refuse it, and notes of what is doubtful."""

import numpy as np

from odometry.identification.fit import Fit
from odometry.identification.fitted import NORMAL, deviations_within
from odometry.models.base import Parameter

FEW_FREEDOM = 5.0
NEAR_BOUND = 1e-2
FAR_RESIDUALS = 3.0  # times the poses' stated noise
CAUSES = (
    "tread speeds in another unit (rad/s, RPM, mm/s), swapped or of the wrong sign; yaw in degrees "
    "or reversed; a wrong track_width; poses much worse than --position-sigma and --yaw-sigma say"
)


def refusals(fit: Fit) -> tuple[str, ...]:
    """Parameters at a bound while the predicted motion is far from the measured one.

    A search that would have gone on beyond its bound has not found a model of the motion. Where
    the residuals are as the noise explains, the bound is near enough to the truth, and a bound at
    which a parameter has no effect is an answer.
    """
    if fit.scale <= FAR_RESIDUALS:
        return ()
    parameters = {parameter.name: parameter for parameter in fit.model.parameters}
    return tuple(
        f"{name} ended at its bound {fit.values[name]:.4g}, and the residuals are {fit.scale:.1f} "
        f"times {fit.compared_with}"
        for name in fit.at_bound
        if not _is_neutral(parameters[name], fit.values[name])
    )


def _is_neutral(parameter: Parameter, value: float) -> bool:
    """Whether a value at a bound is the one without effect: the other bound is far from it."""
    return parameter.neutral is not None and abs(value - parameter.neutral) < NEAR_BOUND


def notes(fit: Fit) -> tuple[str, ...]:
    """What is doubtful, a sentence each."""
    found = []
    for parameter in fit.model.parameters:
        value = fit.values[parameter.name]
        if parameter.name not in fit.names or parameter.name in fit.at_bound:
            continue
        if parameter.usual and not parameter.usual[0] <= value <= parameter.usual[1]:
            low, high = parameter.usual
            found.append(
                f"{parameter.name} = {value:.4g} is outside of {low:g} to {high:g}, where slip "
                "leaves it: are the tread speeds in m/s?"
            )
    parameters = {parameter.name: parameter for parameter in fit.model.parameters}
    found += [
        f"{name} ended at the edge of its search range"
        + (
            ", where it has no effect: a model without it predicts the same"
            if _is_neutral(parameters[name], fit.values[name])
            else ""
        )
        for name in fit.at_bound
    ]
    if fit.agreeing == 1 < fit.starts:
        found.append("no two starts agree; the minimum may not be the least")
    found += [
        f"{name} acts through a sign alone: a range of values fits equally well, and no interval "
        "can be stated"
        for name in fit.by_trial
    ]
    few = float(fit.freedom.min(initial=np.inf))
    if few < FEW_FREEDOM:
        found.append(
            f"few windows, or few runs that differ: {few:.1f} degrees of freedom make intervals "
            f"{float(deviations_within(np.array(few))) / NORMAL:.1f} times as wide as many would; "
            "add runs"
        )
    return tuple(found)
