"""Settings of a comparison."""

from dataclasses import dataclass, field, replace
from itertools import pairwise

from odometry.config import LARGEST, SMALLEST, require, require_positive
from odometry.identification.start import SolverConfig
from odometry.windows.config import WindowConfig

ROTATION_HORIZON_M = 1.0  # over which Baril 2020 Fig. 7 shows what commands lead to
CURVE_HORIZONS_M = (0.5, ROTATION_HORIZON_M, 2.0, 5.0, 10.0)  # of Baril 2020 Fig. 4


@dataclass(frozen=True)
class ComparisonConfig:
    """Settings of a comparison.

    Attributes
    ----------
    training : WindowConfig
        How runs are cut to identify a model; its horizon is h_t of Baril 2020.
    solver : SolverConfig
    horizons_m : tuple of float
        Evaluation horizons h_e of Baril 2020: wheel travel over which errors are taken. Models
        are distinguished on the first.
    training_horizons_m : tuple of float
        Training horizons h_t of Baril 2020 Fig. 4 with which models are identified and evaluated
        besides; each costs as many fits as the comparison itself.
    draws : int
        Of the bootstrap.
    block_m : float
        Wheel travel of the blocks that the bootstrap draws; errors of neighbouring windows are
        correlated.
    seed : int
        Of the bootstrap.
    """

    training: WindowConfig = field(default_factory=WindowConfig)
    solver: SolverConfig = field(default_factory=SolverConfig)
    horizons_m: tuple[float, ...] = (2.0,)
    training_horizons_m: tuple[float, ...] = ()
    draws: int = 2000
    block_m: float = 10.0
    seed: int = 0

    def __post_init__(self) -> None:
        require(bool(self.horizons_m), "no evaluation horizon; expected one or more")
        for kind, horizons_m in (
            ("evaluation", self.horizons_m),
            ("training", self.training_horizons_m),
        ):
            for horizon in horizons_m:
                require(
                    SMALLEST <= horizon <= LARGEST,
                    f"{kind} horizon {horizon} m, expected above 0: {SMALLEST:g} to {LARGEST:g}",
                )
            doubled = [a for a, b in pairwise(sorted(horizons_m)) if a == b]
            require(not doubled, f"{kind} horizons {doubled} m are given twice")
        require(self.draws >= 100, f"draws = {self.draws}, expected 100 or more")
        require_positive(self, "block_m")

    @property
    def evaluated_m(self) -> tuple[float, ...]:
        """All horizons over which errors are taken: those requested, and those of the figures."""
        return tuple(sorted({*self.horizons_m, *CURVE_HORIZONS_M}))

    def with_stated_horizons(self) -> "ComparisonConfig":
        """With one training horizon throughout where horizons are what is compared."""
        if not self.training_horizons_m or self.training.horizon_s:
            return self
        training = replace(self.training, horizon_m=self.training.travel_m)
        return replace(self, training=training)
