"""How parameters are searched."""

from dataclasses import dataclass

from odometry.config import require, require_positive


@dataclass(frozen=True)
class SolverConfig:
    """How parameters are searched.

    Attributes
    ----------
    loss : str
        "huber": windows whose Mahalanobis distance is far above the others' weigh less;
        "linear": Baril 2020 eq. 13 as printed.
    starts : int
        Searches from different values; the best one counts.
    seed : int
        Of the further starts.
    undetermined : float
        A combination of parameters is undetermined where its standard deviation is above this
        many of the parameters' ordinary sizes.
    """

    loss: str = "huber"
    starts: int = 4
    seed: int = 0
    undetermined: float = 1.0

    def __post_init__(self) -> None:
        require(self.loss in ("huber", "linear"), f"loss = {self.loss!r}: huber or linear")
        require(self.starts >= 1, f"starts = {self.starts}, expected 1 or more")
        require_positive(self, "undetermined")
