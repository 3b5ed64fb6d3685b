"""Settings of the pose and ICR filter."""

from dataclasses import dataclass

from odometry.config import LARGEST, require, require_positive


@dataclass(frozen=True)
class IcrEkfConfig:
    """Settings of the filter.

    Attributes
    ----------
    position_sigma_m, yaw_sigma_rad : float
        Standard deviation of a measured pose. Where the positions of a recording scatter by
        more for certain, `terrain.run_odometry` takes that (`odometry.preparation.pose_noise`).
    lasting_sigma_m : float
        Standard deviation of errors of positions that last for a minute and more (satellites,
        reflections): the covariance of an estimate holds them, the filter goes on without. Where
        it is 0 and positions scatter for certain, `terrain.run_odometry` takes what the recording
        shows of them.
    position_step_m : float
        Step to which positions are rounded: one that stays the same while the robot drives so far
        is no frozen one. 0 is none; `terrain.run_odometry` takes what the recording shows.
    velocity_sigma_m_s, yaw_rate_sigma_rad_s : float
        Standard deviation of a measured velocity.
    pose_delay_s : float
        By how much the stamps of pose.csv are late; with 0 a delay is searched for, and used
        where it is certain.
    position_noise, yaw_noise : float
        Process noise of the pose, standard deviation per square root of second: m, rad. A
        gyroscope has `gyro_noise` in place of `yaw_noise`.
    slip_noise : float
        Process noise of the position, standard deviation in metres per square root of a metre of
        wheel travel; that of a yaw turned by treads is `slip_noise` over the track width.
    gyro_noise, bias_noise : float
        Process noise of a yaw turned by the gyroscope, rad per square root of second, and of the
        gyroscope's bias, rad/s per square root of second.
    bias_sigma_rad_s : float
        Standard deviation of the gyroscope's bias before any measurement.
    icr_noise_widths, alpha_noise : float
        Process noise of each ICR coordinate, in track widths per square root of second, and of
        each slip factor. There is none of a slip factor where `reset_sigma_alpha` is 0.
    reset_sigma_widths : float
        Standard deviation of each ICR coordinate after a switch, in track widths: the root of
        Chen's P_B.
    reset_sigma_alpha : float
        Standard deviation of each slip factor after a switch; 0 keeps slip factors as given.
    gate_probability : float
        A pose is refused if a true one would be nearer with this probability; 1 refuses none.
    tail_probability : float
        Beyond the distance that a true measurement keeps with this probability, its weight falls
        with the square of the distance (Huber); 1 gives all the same weight.
    gate_patience : int
        After so many refusals that agree with each other the filter starts anew at the pose.
    adapt_rate : float
        By which share of itself each pose may change the scales of slip and pose noise; 0 keeps
        them as given.
    compare_s : float
        Over how long what the treads say of the turn is compared with the gyroscope at once; 0
        compares row by row. Where it is 0 and tread speeds come in steps (few ticks in a short
        time), `terrain.run_odometry` takes as long as makes them even
        (`odometry.estimation.speed_step`): single rounded speeds would widen y_left - y_right.
    use_gyroscope : bool
        Whether the gyroscope turns the robot where there is one; otherwise the treads do.
    watch_sensors : bool
        Whether spikes, stuck encoders and frozen poses are noticed, kept out and flagged.
    causal : bool
        Whether nothing later than a moment is used for it, as on a robot: no delay or scatter of
        poses is searched for, no heading is looked for before the start, odometry has a gap where
        its speeds are held for long whatever other files show later, and the filter itself undoes
        the lever arm of poses. A run and `terrain.LiveOdometry` then agree to the last bit.
    detect_jumps : bool
        Reset the ICR covariance where the innovations show that the ICRs jumped.
    jump_probability : float
        The mean of recent innovations would be smaller with this probability if nothing jumped.
    jump_window : int
        Number of recent innovations.

    Notes
    -----
    Noises, prior and rates were chosen on the 19 recordings of data/motion that are not among
    the seven on which the odometer is evaluated: by the mean error per metre of the odometer over
    5 m of wheel travel against that of the gyroscope with the mean wheel speed.

    Examples
    --------
    >>> import odometry
    >>> config = odometry.IcrEkfConfig(position_sigma_m=0.02)
    >>> ekf = odometry.IcrEkf(track_width=0.4, config=config)
    """

    position_sigma_m: float = 0.05
    yaw_sigma_rad: float = 0.05
    lasting_sigma_m: float = 0.0
    position_step_m: float = 0.0
    pose_delay_s: float = 0.0
    velocity_sigma_m_s: float = 0.05
    yaw_rate_sigma_rad_s: float = 0.02
    position_noise: float = 0.01
    yaw_noise: float = 0.01
    slip_noise: float = 0.1
    gyro_noise: float = 0.02
    bias_noise: float = 2e-4
    bias_sigma_rad_s: float = 0.02
    icr_noise_widths: float = 0.01
    alpha_noise: float = 0.005
    reset_sigma_widths: float = 0.15
    reset_sigma_alpha: float = 0.05
    gate_probability: float = 0.999999
    tail_probability: float = 0.95
    gate_patience: int = 10
    adapt_rate: float = 0.02
    compare_s: float = 0.0
    use_gyroscope: bool = True
    watch_sensors: bool = True
    causal: bool = False
    detect_jumps: bool = False
    jump_probability: float = 0.999999
    jump_window: int = 10

    def __post_init__(self) -> None:
        positive = ("position_sigma_m", "yaw_sigma_rad", "velocity_sigma_m_s")
        require_positive(self, *positive, "yaw_rate_sigma_rad_s", "reset_sigma_widths")
        for name in (
            "lasting_sigma_m",
            "position_step_m",
            "pose_delay_s",
            "position_noise",
            "yaw_noise",
            "slip_noise",
            "gyro_noise",
            "bias_noise",
            "bias_sigma_rad_s",
            "icr_noise_widths",
            "alpha_noise",
            "reset_sigma_alpha",
            "compare_s",
        ):
            value = getattr(self, name)
            require(0 <= value <= LARGEST, f"{name} = {value}, expected 0 or more, to {LARGEST:g}")
        require(0 <= self.adapt_rate < 1, f"adapt_rate = {self.adapt_rate}, expected 0 to below 1")
        for name in ("gate_probability", "tail_probability", "jump_probability"):
            require(
                0 < getattr(self, name) <= 1, f"{name} = {getattr(self, name)}, expected 0 to 1"
            )
        for name in ("gate_patience", "jump_window"):
            value = getattr(self, name)
            require(1 <= value <= LARGEST, f"{name} = {value}, expected 1 or more, to {LARGEST:g}")


PAPER = {
    "slip_noise": 0.0,
    "reset_sigma_alpha": 0.0,
    "tail_probability": 1.0,
    "adapt_rate": 0.0,
    "use_gyroscope": False,
    "watch_sensors": False,
}  # settings with which the filter is that of Chen 2023: six states, poses alone, fixed noise
