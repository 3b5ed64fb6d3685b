"""How recordings are cut into windows."""

from dataclasses import dataclass

from odometry.config import require, require_positive

USUAL_M = 2.0  # of wheel travel, of a window whose horizon is not stated


@dataclass(frozen=True)
class WindowConfig:
    """How runs are cut into windows, and how well their poses are measured.

    Attributes
    ----------
    horizon_m : float or None
        Training horizon h_t of Baril 2020: wheel travel of a window. None is `USUAL_M`, and less
        in `identify` and `compare` where a terrain has too few of such windows.
    horizon_s : float
        Duration of a window instead; 0 cuts by wheel travel.
    stride : float
        From the start of one window to the start of the next, in horizons; 1 makes distinct
        segments, as Baril 2020 has them.
    shortest : float
        A stretch shorter than a horizon still makes a window if it has this share of it.
    pose_gap_s : float
        Longest time between two poses that is no gap; five usual periods where that is longer.
    position_sigma_m, yaw_sigma_rad : float
        Standard deviations of a measured pose: they state the covariance of the loss.

    Examples
    --------
    >>> import odometry
    >>> odometry.WindowConfig(horizon_m=5.0, position_sigma_m=0.01).yaw_sigma_rad
    0.01
    """

    horizon_m: float | None = None
    horizon_s: float = 0.0
    stride: float = 1.0
    shortest: float = 0.1
    pose_gap_s: float = 0.5
    position_sigma_m: float = 0.02
    yaw_sigma_rad: float = 0.01

    def __post_init__(self) -> None:
        require_positive(self, "stride", "pose_gap_s", "position_sigma_m", "yaw_sigma_rad")
        if self.horizon_m is not None:
            require_positive(self, "horizon_m")
        if self.horizon_s != 0:
            require_positive(self, "horizon_s")
        require(0 < self.shortest <= 1, f"shortest = {self.shortest}, expected 0 to 1")

    @property
    def travel_m(self) -> float:
        """Wheel travel of a window: `horizon_m`, or the usual one."""
        return USUAL_M if self.horizon_m is None else self.horizon_m
