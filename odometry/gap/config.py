"""Settings of the gap workflow."""

from dataclasses import dataclass

from odometry.config import require, require_positive


@dataclass(frozen=True)
class GapConfig:
    """How a gap is measured, and when an effect is named.

    Attributes
    ----------
    horizon_s : float
        Duration of a window, over which the gap is an error of position; as near as stamps allow.
    folds : int
        Parts of the measured runs; a candidate is judged on each by a fit to the others.
    part_s : float
        Length of the pieces that are dealt out to the folds, or held back.
    held_back : int
        Without runs to hold out, one piece of so many is held back.
    least_evidence : float
        A name needs this much evidence (twice the gain of log-likelihood, less the penalty), at
        its lower bound of 95 %.
    least_share : float
        And must close this share of the excess that was there before any effect.
    first_share : float
        The first name must close this share of it: the main part of a gap is not small.
    most_effects : int
    most_windows : int
        Where there are more, as many of them at even distances are used to fit.
    """

    horizon_s: float = 2.0
    folds: int = 5
    part_s: float = 10.0
    held_back: int = 4
    least_evidence: float = 12.0
    least_share: float = 0.02
    first_share: float = 0.1
    most_effects: int = 3
    most_windows: int = 300

    def __post_init__(self) -> None:
        require_positive(self, "horizon_s", "part_s", "least_evidence")
        require(self.folds >= 2, f"folds = {self.folds}, expected 2 or more")
        require(self.held_back >= 2, f"held_back = {self.held_back}, expected 2 or more")
        for name in ("least_share", "first_share"):
            value = getattr(self, name)
            require(0 <= value < 1, f"{name} = {value}, expected 0 to 1")
        require(self.most_effects >= 1, f"most_effects = {self.most_effects}, expected 1 or more")
        require(self.most_windows >= 20, f"most_windows = {self.most_windows}, expected 20 or more")
