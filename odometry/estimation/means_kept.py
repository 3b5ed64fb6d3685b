"""The paper's switch: the covariance is reset, and the ICRs are kept (Chen 2023, 3.2)."""

from dataclasses import replace

import numpy as np

from odometry.estimation.estimate import Estimate
from odometry.estimation.icr_ekf import IcrEkf
from odometry.frames import Frame
from odometry.run_terrains import Footing


class MeansKept:
    """A filter that keeps its estimated ICRs on another terrain, with a larger covariance.

    The covariance of the ICRs becomes the filter's P_B, `reset_sigma_widths`; what was learned
    on the terrain before is not taken up again.

    Parameters
    ----------
    ekf : IcrEkf
        Without a parameter set.
    """

    def __init__(self, ekf: IcrEkf) -> None:
        self._ekf = ekf

    def start(self, frame: Frame, terrain: str, *, yaw_sigma_rad: float | None = None) -> Estimate:
        """The first estimate, see `IcrEkf.start`."""
        return self._ekf.start(frame, terrain, yaw_sigma_rad=yaw_sigma_rad)

    def step(self, estimate: Estimate, frame: Frame, terrain: str | Footing) -> Estimate:
        """The next estimate, see `IcrEkf.step`; the terrain changes in one step."""
        name = Footing.of(terrain).terrain
        if name != estimate.terrain:
            belief = estimate.belief
            known = replace(belief, covariance=np.zeros_like(belief.covariance))
            estimate = replace(estimate, learned={**estimate.learned, name: known})
        return self._ekf.step(estimate, frame, name)
