"""Whether a fit to positions without yaw is an answer; of poses the stated noise says that."""

import numpy as np

from odometry.identification.fitted import Fit
from odometry.identification.stretch_uncertainty import FEWEST
from odometry.run import Robot
from odometry.windows.window_errors import WindowErrors, errors_over


def not_told(fit: Fit, robot: Robot) -> tuple[str, ...]:
    """What stretches of positions leave open, a clause each; nothing of a fit to poses.

    Too few stretches show no spread, so that intervals suppose what cannot be seen; and an
    interval that is wider than the parameter is large tells no more than its name does.
    """
    if fit.noise is None:
        return ()
    found = []
    if len(fit.windows) < FEWEST:
        found.append(
            f"{len(fit.windows)} stretches of {fit.windows.travel_m.mean():.1f} m (positions "
            f"have a noise of {fit.noise.position_m:.2g} m): fewer than {FEWEST} do not show how "
            "much the model errs; drive farther"
        )
    sizes = fit.model.ordinary_sizes(robot)
    intervals = fit.intervals
    for parameter, size in zip(fit.model.parameters, sizes, strict=True):
        if parameter.name in fit.names and parameter.name not in fit.open_names:
            of = intervals[parameter.name]
            if of.high - of.low > 2 * size:
                found.append(
                    f"{parameter.name}: 95 % interval {of.low:.3g} to {of.high:.3g} "
                    f"{parameter.unit}, more than its ordinary size ({size:.2g}) to either side"
                )
    return tuple(found)


def contradicted(fit: Fit, ideal: WindowErrors) -> tuple[str, ...]:
    """A clause where the ideal drive lies nearer to the positions that were fitted, in both errors.

    It is one of the motions that the fit could have chosen. Nothing of a fit to poses.

    Parameters
    ----------
    fit : Fit
    ideal : WindowErrors
        Of the ideal differential drive on the stretches of the fit.
    """
    if fit.noise is None or not fit.names:
        return ()
    own = errors_over(fit.model, fit.packed, fit.windows)
    pairs = (
        (own.translation_per_m.mean(), ideal.translation_per_m.mean(), "m per m"),
        (np.degrees(own.rotation_per_m.mean()), np.degrees(ideal.rotation_per_m.mean()), "deg/m"),
    )
    if any(mine <= other for mine, other, _ in pairs):
        return ()
    errors = " and ".join(f"{mine:.3g} against {other:.3g} {unit}" for mine, other, unit in pairs)
    return (f"the ideal drive, without any fit, errs less on the fitted stretches: {errors}",)
