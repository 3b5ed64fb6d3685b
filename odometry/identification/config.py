"""How parameters are searched."""

from dataclasses import dataclass

from odometry.config import require, require_positive

LOSSES = ("huber", "squares", "linear")


@dataclass(frozen=True)
class SolverConfig:
    """How parameters are searched.

    Attributes
    ----------
    loss : str
        "huber": squared Mahalanobis distances by the covariance that the poses' noise gives each
        window, windows far above the others weighing less; "squares": the same, all windows in
        full; "linear": Baril 2020 eq. 13 with the identity covariance, as the paper has it (a
        metre of position weighs as a radian of yaw).
    starts : int
        Searches from different values; the best one counts.
    seed : int
        Of the further starts.
    undetermined : float
        A combination of parameters is undetermined where its standard deviation is above this
        many of the parameters' ordinary sizes.

    Examples
    --------
    >>> import odometry
    >>> odometry.SolverConfig(starts=1).loss
    'huber'
    """

    loss: str = "huber"
    starts: int = 4
    seed: int = 0
    undetermined: float = 1.0

    def __post_init__(self) -> None:
        require(self.loss in LOSSES, f"loss = {self.loss!r}, expected one of {', '.join(LOSSES)}")
        require(self.starts >= 1, f"starts = {self.starts}, expected 1 or more")
        require_positive(self, "undetermined")
