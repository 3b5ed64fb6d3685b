"""The check of the odometer's covariance as sentences, with what to do."""

import math
from collections.abc import Sequence

from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.open_loop_consistency import DEGREES, OpenLoopConsistency


def verdict(check: OpenLoopConsistency) -> str:
    """Whether a covariance is as large as the errors, as a sentence."""
    if check.is_consistent:
        return "consistent"
    return "too small" if check.mean > check.bounds[1] else "too large"


def not_checked(uncertainty: OdometerUncertainty, distance_m: float, reference_name: str) -> str:
    """Why the covariance was not checked over a distance."""
    if reference_name == "truth":
        return f"not checked: the truth holds no {distance_m:g} m"
    if uncertainty.noise is None:
        return "not checked: no pose to check it by"
    return f"not checked: too few poses {distance_m:g} m apart in a half of the run"


def judging(uncertainty: OdometerUncertainty) -> list[OpenLoopConsistency]:
    """The check of each distance: by the truth or by halves, else by the run's own poses."""
    found = {check.distance_m: check for check in uncertainty.own_checks}
    found |= {check.distance_m: check for check in uncertainty.checks}
    return [found[distance_m] for distance_m in sorted(found)]


def advice(uncertainty: OdometerUncertainty, reference_name: str) -> str:
    """What the check found, and what to do, in one or two sentences.

    Parameters
    ----------
    uncertainty : OdometerUncertainty
    reference_name : str
        "truth", "pose" or "".
    """
    checks = judging(uncertainty)
    small = [check for check in checks if verdict(check) == "too small"]
    large = [check for check in checks if verdict(check) == "too large"]
    how = "Checked against the truth" if reference_name == "truth" else "Checked against the poses"
    if small:
        factor = max(check.mean for check in small) / DEGREES
        return (
            f"{how}, the odometer's covariance is too small over {_distances(small)}: its errors "
            f"are about {math.sqrt(factor):.1f} times as large as sigma_x, sigma_y and sigma_yaw "
            f"say. Multiply the covariance by {factor:.1f} before you rely on it."
        )
    if large:
        factor = min(check.mean for check in large) / DEGREES
        return (
            f"{how}, the odometer's covariance is too large over {_distances(large)}: its errors "
            f"are about {math.sqrt(factor):.1f} times what sigma_x, sigma_y and sigma_yaw say. "
            "That is safe: nothing needs to be done."
        )
    if checks:
        return (
            f"{how}, the odometer's covariance is as large as its errors over {_distances(checks)}."
        )
    return (
        "The odometer's covariance was not checked: no poses reach over 5 m of wheel travel twice."
        if uncertainty.noise is not None
        else "The odometer's covariance was not checked: the filter took in no pose."
    )


def _distances(checks: Sequence[OpenLoopConsistency]) -> str:
    return " and ".join(f"{check.distance_m:g}" for check in checks) + " m"
