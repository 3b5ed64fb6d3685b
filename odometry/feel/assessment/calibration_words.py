"""How far off probabilities are, in which direction, and how much of it chance explains."""

from collections.abc import Mapping
from typing import Any


def calibration_words(of: Mapping[str, Any]) -> str:
    """A sentence on answers of one length, by the report of a model; "" of older models.

    Parameters
    ----------
    of : Mapping
        See `assessment.Answers.to_table`.
    """
    if "error_by_chance" not in of:
        return ""
    error, independent, together = (
        float(of[name])
        for name in ("calibration_error", "error_by_chance", "error_by_chance_of_runs")
    )
    if error <= independent:
        judged = "chance explains this"
    elif error <= together:
        judged = "chance may explain this"
    else:
        too = "high" if of["mean_excess"] > 0 else "low"
        judged = f"chance does not explain this: they are too {too}"
    return (
        f"probabilities are off by {error:.3f} in the mean (exact ones would seem off by "
        f"{independent:.3f} if answers were independent, by {together:.3f} if those of a run were "
        f"right or wrong together: {judged})"
    )
