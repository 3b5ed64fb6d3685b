"""Modes of large traction changes: linear models of speed and yaw rate (Salvi 2024, III-A)."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.linalg import expm

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.imm.ekf_bank import EkfModel
from odometry.modes.models.response import SLOWEST_HZ, lagged
from odometry.modes.recorded.bank_inputs import (
    BIAS_SIGMA_RAD_S,
    BIAS_WALK_RAD2_S3,
    Signals,
    velocity_signals,
)
from odometry.recording.run import Run

STEP_RESOLUTION_S = 1e-6
FASTEST_GROWTH_HZ = 10.0  # of a model that is no slip of the pen
FIRST_SIGMAS = np.array([0.5, 0.5, BIAS_SIGMA_RAD_S])  # of speed [m/s], yaw rate, bias at the start
MEASURED = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])  # speed, and yaw rate with the bias


@dataclass(frozen=True, eq=False)
class VelocityModes:
    """d(V, omega)/dt = A (V, omega) + B (v_left, v_right), with A and B of each mode (eq. 2).

    The inputs are tread speeds in m/s: B is that of eq. 2 divided by the wheel radius.

    Attributes
    ----------
    names : tuple of str
    A, B : (M, 2, 2)
    process_variance : (M, 2)
        Variance of speed and yaw rate that a second adds.
    measurement_variance : (M, 2)
        Variance of a measured speed and yaw rate.
    errors_last_s : float
        For how long errors of a model are correlated: of what is measured within that time, all
        together counts once.
    fastest_m_s : float
        Largest speed of a tread in the runs identified from: the models are not valid at speeds far
        above it.
    speed_power : (M, 2) or None
        Power at low frequency of errors of the forward speed [m^2/s]: on a straight, and what each
        (rad/s)^2 of yaw rate adds. None where it was identified without measured speeds.
    gain_spread : (M,) or None
        Standard deviation of the yaw rate for given treads from one turn to the next, as a share of
        it. None of sets of versions before 0.18.
    turn_spread, turn_power : (M, 2) or None
        Of the error of a mode's yaw rate gain on turns that it was not identified from, over a
        short and a long time of turning: standard deviation as a share, and what adds to its square
        by the information of a window [rad^2/s] (`held_out_turns`). None of sets of versions before
        0.36.
    track_width : float
        Of the robot [m]; NaN of sets of versions before 0.48.
    turning_least_m, turning_most_m : float
        How far ahead of its origin the robot turned in the runs identified from, on all terrains,
        at least and at most; NaN without measured poses with yaw, and of sets of versions before
        0.52.
    """

    names: tuple[str, ...]
    A: FloatArray
    B: FloatArray
    process_variance: FloatArray
    measurement_variance: FloatArray
    errors_last_s: float = 0.0
    fastest_m_s: float = np.inf
    speed_power: FloatArray | None = None
    gain_spread: FloatArray | None = None
    turn_spread: FloatArray | None = None
    turn_power: FloatArray | None = None
    track_width: float = np.nan
    turning_least_m: float = np.nan
    turning_most_m: float = np.nan

    kind = "velocity"
    state_angles: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        growth = np.linalg.eigvals(self.A).real.max(axis=1)
        for name, rate in zip(self.names, growth, strict=True):
            if not rate < FASTEST_GROWTH_HZ:
                raise ParameterError(f"[mode.{name}] A: grows at {rate:g} per second")

    def signals(self, run: Run) -> Signals:
        """What of a run the filters use."""
        return velocity_signals(run)

    def roughness(self, signals: Signals) -> FloatArray:
        """None (N,): these are the same at every stamp."""
        return np.zeros(len(signals))

    def start(self, signals: Signals, independent: float = 1.0) -> tuple[FloatArray, FloatArray]:
        """Mean (3,) and covariance (3, 3) at the first stamp: as the wheels turn.

        A filter takes all that is measured for news; the variance of the bias is less by the share
        that is, so that it is learnt no faster than the news say.
        """
        speed = signals.tread_speeds_m_s[0].mean()
        omega = signals.measured[0, 1]
        mean = np.array([speed, omega if np.isfinite(omega) else 0.0, 0.0])
        return mean, np.diag(FIRST_SIGMAS**2 * [1.0, 1.0, independent])

    def model(self, roughness: float = 0.0, independent: float = 1.0) -> EkfModel:  # noqa: ARG002
        """For a bank of all modes, whose measurements are news by a share `independent`."""
        key = np.concatenate([self.A, self.B], axis=-1)

        def exact(step_s: float) -> FloatArray:
            return _discrete(key.tobytes(), len(key), round(step_s / STEP_RESOLUTION_S))

        walk = independent * BIAS_WALK_RAD2_S3
        added = np.insert(self.process_variance, 2, walk, axis=1)[:, :, None]

        return EkfModel(
            states=3,
            transition=lambda x, u, dt: (
                (exact(dt)[..., :3] @ x[..., None])[..., 0] + exact(dt)[..., 3:] @ u
            ),
            transition_jacobian=lambda x, u, dt: exact(dt)[..., :3],  # noqa: ARG005
            process_noise=lambda x, u, dt: dt * added * np.eye(3),  # noqa: ARG005
            measurement=lambda x: x @ MEASURED.T,
            measurement_jacobian=lambda x: MEASURED,  # noqa: ARG005
            measurement_covariance=self.measurement_variance[:, :, None] * np.eye(2),
        )

    def steady_gains(self) -> FloatArray:
        """Speed and yaw rate (M, 2, 2) per tread speed, once all has settled: -A^-1 B."""
        return np.asarray(-np.linalg.solve(self.A, self.B))

    def lasting_share(self) -> FloatArray:
        """By how much (M,) the yaw rate of a mode may be off for as long as a turn, as a share."""
        return np.zeros(len(self.names)) if self.gain_spread is None else self.gain_spread

    def steady_yaw_rates(self, tread_speeds_m_s: FloatArray) -> FloatArray:
        """Yaw rates (N, M) of tread speeds (N, 2), once all has settled [rad/s]."""
        return np.asarray(tread_speeds_m_s @ self.steady_gains()[:, 1].T)

    def turn_gains(self) -> FloatArray:
        """Yaw rate (M, 1) per difference of the tread speeds, once all has settled [rad/m]."""
        return np.asarray(self.steady_gains()[:, 1] @ [[-0.5], [0.5]])

    def yaw_rates_rad_s(self, stamps_s: FloatArray, tread_speeds_m_s: FloatArray) -> FloatArray:
        """Yaw rates (N, M) of each mode, which follow the treads late and are not corrected."""
        steady = self.steady_yaw_rates(tread_speeds_m_s)
        lags_s = 1 / np.maximum(-self.A[:, 1, 1], SLOWEST_HZ)
        columns = zip(steady.T, lags_s.tolist(), strict=True)
        return np.column_stack([lagged(column, stamps_s, lag_s) for column, lag_s in columns])

    def yaw_rate_variances(self) -> FloatArray:
        """Variance (M,) of a measured yaw rate [rad^2/s^2]."""
        return self.measurement_variance[:, 1]


@lru_cache(maxsize=256)
def _discrete(models: bytes, modes: int, steps: int) -> FloatArray:
    """Transition and input matrices (M, 3, 5) of a step at constant input, exactly."""
    blocks = np.zeros((modes, 5, 5))
    blocks[:, :2, [0, 1, 3, 4]] = np.frombuffer(models).reshape(modes, 2, 4)
    return np.asarray(expm(blocks * (steps * STEP_RESOLUTION_S))[:, :3])
