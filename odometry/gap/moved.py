"""How far each number of a base moved away from its calibration."""

from dataclasses import dataclass, replace

import numpy as np

from odometry.effects.base_model import Base
from odometry.gap.calibration import Calibration

FAR = 3.0  # standard deviations, from which a change is reported
RIDGE = 1e-9  # the calibration may leave a number open


@dataclass(frozen=True)
class Moved:
    """A number of the base: as calibrated, as it is with the effects, and how sure it was."""

    name: str
    unit: str
    before: float
    after: float
    sigma: float

    @property
    def sigmas(self) -> float:
        """The move in standard deviations of the calibration."""
        return abs(self.after - self.before) / self.sigma

    @property
    def is_far(self) -> bool:
        """Whether it moved farther than its calibration allows."""
        return self.sigmas > FAR


def moves_of(calibration: Calibration, base: Base) -> tuple[Moved, ...]:
    """Of every number that the calibration leaves uncertain, in its order."""
    uncertain = calibration.uncertain
    values = uncertain.values
    if not len(values):
        return ()
    information = calibration.information + RIDGE * np.eye(len(values))
    sigmas = np.sqrt(np.diag(np.linalg.inv(information)))
    after = replace(uncertain, base=base).values
    units = {parameter.name: parameter.unit for parameter in base.model.parameters}
    units |= {"latency": "s", "gyro_latency": "s", "gyro_bias": "rad/s"}
    return tuple(
        Moved(name, units[name], *map(float, numbers))
        for name, *numbers in zip(uncertain.names, values, after, sigmas, strict=True)
    )


def moved_words(moved: Moved) -> str:
    """A sentence."""
    unit = f" {moved.unit}" if moved.unit else ""
    share = (moved.after - moved.before) / moved.before if moved.before else 0.0
    by = f" ({100 * share:+.1f} %)" if not moved.unit and share else ""
    return (
        f"{moved.name} of the base moved from {moved.before:.4g} to {moved.after:.4g}{unit}{by}, "
        f"{moved.sigmas:.0f} standard deviations of its calibration: more than that allows."
    )
