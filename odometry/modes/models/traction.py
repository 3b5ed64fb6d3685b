"""Modes of small traction changes: poses driven by the gains of each mode (Salvi 2024, III-B).

The state is x, y, yaw, the yaw rate and the bias of the gyroscope. That of the paper is the pose
alone; with the yaw rate a gyroscope can update it, and the robot may turn a little later than it
was commanded.
"""

from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.imm.ekf_bank import EkfModel
from odometry.geometry import se2
from odometry.modes.models.response import SHORTEST_LAG_S, lagged
from odometry.modes.recorded.bank_inputs import (
    BIAS_SIGMA_RAD_S,
    BIAS_WALK_RAD2_S3,
    Signals,
    pose_signals,
)
from odometry.modes.recorded.faster import with_faster_spans
from odometry.recording.run import Run

MEASURED = np.hstack([np.eye(4), np.array([[0.0], [0.0], [0.0], [1.0]])])  # yaw rate and bias

LEFT_TURN, RIGHT_TURN = 0, 1
TURNS = np.array([[0.8, 1.0], [1.0, 0.8], [0.3, 0.9], [0.9, 0.3], [-0.5, 0.5]])
"""Tread speeds [m/s] of wide and of tight turns to both sides, and of one on the spot."""


@dataclass(frozen=True, eq=False)
class TractionModes:
    """Body twist of the requested speed u_1 and turn rate u_2, of each mode and turn.

    Eq. 3 has v_x = k u_1 and omega = m u_2. A wheel that slips on one side pulls aside, drives
    the robot by other shares in left and in right turns, and moves the turning centre, in a tight
    turn more than in a wide one, and in a fast turn more than in a slow one: so the gains here are
    (v_x, v_y, omega) by (u_1, ..., u_5) of `requested`, for each turn. Those of eq. 3 are k of v_x
    by u_1 and m of omega by u_2, the same for both, and 0.

    Attributes
    ----------
    names : tuple of str
    gains : (M, 2, 3, 5)
        For left turns, then for right ones; the turning centre is on that side.
    lag_s : (M,)
        Time in which the yaw rate follows what is commanded; 0 in eq. 3.
    track_width : float
        [m]
    process_variance : (3,)
        Variance of the place [m^2] and of the yaw [rad^2] that a metre of wheel travel adds, and of
        the yaw rate about what the gains say [rad^2/s^2]; the same in all modes: else whatever mode
        was recorded most smoothly wins on every straight.
    measurement_variance : (4,)
        Variance of a measured x, y, yaw, and yaw rate. The last holds what lasts of the errors of
        the modes, too, for a gyroscope read as often as in the runs identified from: of what it
        says in a second, its own noise is the least.
    variance_growth : float
        By what part variances grow for each (m/s^2)^2 of acceleration of a tread: a
        robot that speeds up in a turn slips by more than the gains say.
    fastest_m_s : float
        Largest speed of a tread in the runs identified from: the modes are not valid at speeds far
        above it. A set that does not state it has no limit.
    gain_spread, gain_power : (M,) or None, float
        Of the error of a mode's yaw rate gain on drives that it was not identified from: standard
        deviation from turn to turn as a share, and what adds to its square by the information of a
        window [rad^2/s] (`held_out_gains`). None of sets of versions before, and without gyroscope.
    centre_spread, centre_noise : (M, 2) or None
        Of the error of a mode's turning centre, to the left and ahead, on drives that it was not
        identified from: standard deviation [m], and what adds to its square by the variance that a
        window of poses leaves (`held_out_centres`). None of sets of versions before.
    """

    names: tuple[str, ...]
    gains: FloatArray
    lag_s: FloatArray
    track_width: float
    process_variance: FloatArray
    measurement_variance: FloatArray
    variance_growth: float = 0.0
    fastest_m_s: float = np.inf
    gain_spread: FloatArray | None = None
    gain_power: float = np.inf
    centre_spread: FloatArray | None = None
    centre_noise: FloatArray | None = None

    kind = "traction"
    errors_last_s = 0.0
    state_angles: tuple[int, ...] = (2,)

    @property
    def k(self) -> FloatArray:
        """Shares (M, 2) of the requested speed in wide turns, to the left and to the right."""
        return self.gains[:, :, 0, 0]

    @property
    def m(self) -> FloatArray:
        """Shares (M, 2) of the requested turn rate in wide slow turns, where u_4 is w."""
        return self.gains[:, :, 2, 1] + self.track_width * self.gains[:, :, 2, 3]

    def signals(self, run: Run) -> Signals:
        """What of a run the filters use."""
        signals = pose_signals(run)
        gaps_s = with_faster_spans(
            signals.gaps_s, signals.stamps_s, signals.tread_speeds_m_s, self.fastest_m_s
        )
        # after a gap that no pose follows nothing says where the robot is: it lasts to the end
        last_pose_s = signals.stamps_s[np.isfinite(signals.measured[:, :3]).all(axis=1)][-1]
        gaps_s[gaps_s[:, 1] > last_pose_s, 1] = np.inf
        return replace(signals, gaps_s=gaps_s)

    def roughness(self, signals: Signals) -> FloatArray:
        """By what part (N,) variances are larger from each stamp to the next."""
        return self.variance_growth * signals.accelerations_m_s2**2

    def start(self, signals: Signals, independent: float = 1.0) -> tuple[FloatArray, FloatArray]:
        """Mean (5,) and covariance (5, 5) at the first stamp: the first measured pose, standing.

        Where that is a later one, the less certain by all that the wheels turned before it.
        """
        poses = signals.measured[:, :3]
        first = int(np.isfinite(poses).all(axis=1).argmax())
        steps_s, (left, right) = np.diff(signals.stamps_s[: first + 1]), signals.tread_speeds_m_s.T
        travel_m = (np.abs(left) + np.abs(right))[:first] @ steps_s / 2
        turn_rad = np.abs(right - left)[:first] @ steps_s / self.track_width
        variances = self.measurement_variance[:3] + np.square([travel_m, travel_m, turn_rad])
        return np.append(poses[first], [0.0, 0.0]), np.diag(
            np.append(variances, [0.0, independent * BIAS_SIGMA_RAD_S**2])
        )

    def model(self, roughness: float = 0.0, independent: float = 1.0) -> EkfModel:
        """For a bank of all modes; variances but those of measured poses are larger by a part.

        Of what is measured, a share `independent` is news: see `start`.
        """
        larger = 1 + roughness

        def process_noise(x: FloatArray, u: FloatArray, dt: float) -> FloatArray:  # noqa: ARG001
            place, yaw = larger * np.abs(u).mean() * dt * self.process_variance[:2]
            lasting, _ = self._lasting(dt)
            walk = independent * BIAS_WALK_RAD2_S3 * dt
            noise = np.tile(np.diag([place, place, yaw, 0.0, walk]), (len(lasting), 1, 1))
            noise[:, 3, 3] = self.process_variance[2] * (1 - lasting**2)
            return noise

        return EkfModel(
            states=5,
            transition=self._transition,
            transition_jacobian=self._jacobian,
            process_noise=process_noise,
            measurement=lambda x: x @ MEASURED.T,
            measurement_jacobian=lambda x: MEASURED,  # noqa: ARG005
            measurement_covariance=np.diag(self.measurement_variance * [1, 1, 1, larger]),
            state_angles=self.state_angles,
            measurement_angles=self.state_angles,
        )

    def turn_gains(self) -> FloatArray:
        """Yaw rate (M, T) per difference of the tread speeds in the turns of TURNS [rad/m]."""
        twists = np.stack([twists_of(of, TURNS, self.track_width) for of in self.gains])
        return np.asarray(twists[..., 2] / np.diff(TURNS)[:, 0])

    def yaw_rates_rad_s(self, stamps_s: FloatArray, tread_speeds_m_s: FloatArray) -> FloatArray:
        """Yaw rates (N, M) of each mode, which follow the treads late and are not corrected."""
        modes = zip(self.gains, self.lag_s.tolist(), strict=True)
        columns = [
            lagged(twists_of(of, tread_speeds_m_s, self.track_width)[:, 2], stamps_s, lag_s)
            for of, lag_s in modes
        ]
        return np.column_stack(columns)

    def yaw_rate_variances(self) -> FloatArray:
        """Variance (M,) of a measured yaw rate [rad^2/s^2]."""
        return np.full(len(self.names), self.measurement_variance[3])

    def _moved(self, x: FloatArray, u: FloatArray, dt: float) -> tuple[FloatArray, FloatArray]:
        """Displacements (..., M, 3) of a step, and the yaw rates (..., M) after it."""
        twists = twists_of(self.gains, u, self.track_width)
        excess = x[..., 3] - twists[:, 2]
        lasting, integral_s = self._lasting(dt)
        moved = np.empty((*excess.shape, 3))
        moved[...] = twists * dt
        moved[..., 2] += excess * integral_s
        return moved, twists[:, 2] + excess * lasting

    def _lasting(self, dt: float) -> tuple[FloatArray, FloatArray]:
        """What is left (M,) of an excess of yaw rate after a step, and its integral [s]."""
        lag_s = np.maximum(self.lag_s, SHORTEST_LAG_S)
        lasting = np.exp(-dt / lag_s)
        return lasting, lag_s * (1 - lasting)

    def _transition(self, x: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Poses along exact arcs of the mean yaw rate of the step."""
        moved, omega = self._moved(x, u, dt)
        reached = se2.compose(x[..., :3], se2.exp(moved))
        return np.concatenate([reached, omega[..., None], x[..., 4:]], axis=-1)

    def _jacobian(self, x: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """The heading swings the step, and so does the yaw rate (..., M, 5, 5)."""
        moved, _ = self._moved(x, u, dt)
        lasting, integral_s = self._lasting(dt)
        cosine, sine = np.cos(x[..., 2]), np.sin(x[..., 2])
        end, by_displacement = se2.linearised_exp(moved)
        dx, dy = end[..., 0], end[..., 1]
        by_angle = by_displacement[..., 2] * integral_s[:, None]
        jacobian = np.zeros((*x.shape, 5))
        jacobian[..., range(5), range(5)] = 1.0
        jacobian[..., 0, 2], jacobian[..., 1, 2] = -sine * dx - cosine * dy, cosine * dx - sine * dy
        jacobian[..., 0, 3] = cosine * by_angle[..., 0] - sine * by_angle[..., 1]
        jacobian[..., 1, 3] = sine * by_angle[..., 0] + cosine * by_angle[..., 1]
        jacobian[..., 2, 3], jacobian[..., 3, 3] = by_angle[..., 2], lasting
        return jacobian


def requested(tread_speeds_m_s: FloatArray, track_width: float) -> FloatArray:
    """Speed u_1 [m/s] and turn rate u_2 [rad/s] of eq. 3, u_3, u_4 [m/s], u_5 [m^2/s^3] (..., 5).

    Where inertia does not count, the motion of all treads twice as fast is twice the motion, and
    backward it is the same: what is not linear in u_1 and u_2 depends on the tightness
    r = u_2 track_width / u_1 of the turn. Two such terms are u_3 = u_1 r^2 / (1 + r^2), and
    u_4 = u_1 r / (1 + r^2), which makes wide turns differ from those on the spot, where both are 0.

    Inertia needs the lateral acceleration u_1 u_2 from the ground. Contacts that roll slip aside
    in proportion to force and speed, so that u_5 = |u_1| (u_1 u_2): the less friction, the more.
    Outward, also backward.
    """
    left, right = tread_speeds_m_s[..., 0], tread_speeds_m_s[..., 1]
    speed, difference = (left + right) / 2, right - left
    size = speed**2 + difference**2
    share = speed * difference / np.where(size > 0, size, 1.0)
    turn = difference / track_width
    terms = [speed, turn, difference * share, speed * share, np.abs(speed) * speed * turn]
    return np.stack(terms, axis=-1)


def turns_of(tread_speeds_m_s: FloatArray) -> IntArray:
    """LEFT_TURN or RIGHT_TURN (...), by the side of the turning centre: also backward."""
    left, right = tread_speeds_m_s[..., 0], tread_speeds_m_s[..., 1]
    return np.where((left + right) * (right - left) < 0, RIGHT_TURN, LEFT_TURN)


def twists_of(gains: FloatArray, tread_speeds_m_s: FloatArray, track_width: float) -> FloatArray:
    """Twists (..., 3) of gains (..., 2, 3, 5) at tread speeds (2,), or of (2, 3, 5) at (..., 2)."""
    turns, inputs = turns_of(tread_speeds_m_s), requested(tread_speeds_m_s, track_width)
    if tread_speeds_m_s.ndim == 1:
        return np.asarray(gains[..., int(turns), :, :] @ inputs)
    left, right = (inputs @ gains[turn].T for turn in (LEFT_TURN, RIGHT_TURN))
    return np.asarray(np.where((turns == RIGHT_TURN)[..., None], right, left))
