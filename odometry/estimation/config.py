"""Settings of the pose and ICR filter."""

from dataclasses import dataclass

from odometry.config import LARGEST, require, require_positive


@dataclass(frozen=True)
class IcrEkfConfig:
    """Settings of the filter.

    Attributes
    ----------
    position_sigma_m, yaw_sigma_rad : float
        Standard deviation of a measured pose.
    position_noise, yaw_noise : float
        Process noise of the pose, standard deviation per square root of second: m, rad.
    icr_noise_widths : float
        Process noise of each ICR coordinate, in track widths per square root of second.
    reset_sigma_widths : float
        Standard deviation of each ICR coordinate after a switch, in track widths: the root of
        Chen's P_B.
    gate_probability : float
        A pose is refused if a true one would be nearer with this probability; 1 refuses none.
    gate_patience : int
        After so many refusals in a row the pose is believed and the filter starts there anew.
    detect_jumps : bool
        Reset the ICR covariance where the innovations say that the ICRs jumped.
    jump_probability : float
        The mean of recent innovations would be smaller with this probability if nothing jumped.
    jump_window : int
        Number of recent innovations.
    """

    position_sigma_m: float = 0.02
    yaw_sigma_rad: float = 0.01
    position_noise: float = 0.01
    yaw_noise: float = 0.01
    icr_noise_widths: float = 0.01
    reset_sigma_widths: float = 0.15
    gate_probability: float = 0.999999
    gate_patience: int = 10
    detect_jumps: bool = False
    jump_probability: float = 0.999999
    jump_window: int = 10

    def __post_init__(self) -> None:
        require_positive(self, "position_sigma_m", "yaw_sigma_rad", "reset_sigma_widths")
        for name in ("position_noise", "yaw_noise", "icr_noise_widths"):
            value = getattr(self, name)
            require(0 <= value <= LARGEST, f"{name} = {value}, expected 0 or more, to {LARGEST:g}")
        for name in ("gate_probability", "jump_probability"):
            require(
                0 < getattr(self, name) <= 1, f"{name} = {getattr(self, name)}, expected 0 to 1"
            )
        for name in ("gate_patience", "jump_window"):
            value = getattr(self, name)
            require(1 <= value <= LARGEST, f"{name} = {value}, expected 1 or more, to {LARGEST:g}")
