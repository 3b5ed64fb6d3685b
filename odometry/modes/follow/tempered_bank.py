"""A bank whose measurements are correlated: their likelihoods get a power below 1."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimation.imm.ekf_bank import wrapped
from odometry.estimation.imm.estimator import Bank
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.follow.gyroscope_bias import moving
from odometry.modes.recorded.bank_inputs import Signals
from odometry.modes.recorded.faster import faster_than
from odometry.windows.recorded.spans import touched, within

OUTLIERS = 1e-3  # share of measurements that follow a Cauchy distribution
MOST_SIGMAS = 5.0  # root mean square of an innovation beyond which it pulls no more


@dataclass(frozen=True)
class TemperedBank:
    """A bank with log-likelihoods times `independent`, the share of them that is news.

    Innovations of models that are not exact go together over time; their likelihoods multiplied
    count too much. The power that corrects this is that of composite likelihoods (Varin, Reid,
    Firth 2011, Statistica Sinica 21).

    A single outlier hardly counts: the likelihood is that of a Gaussian contaminated by a
    distribution with the tails of Cauchy's (Huber and Ronchetti 2009, section 1.5), and what an
    innovation corrects is bounded by MOST_SIGMAS.
    """

    bank: Bank
    independent: float
    state_angles: tuple[int, ...] = ()

    @property
    def modes(self) -> int:
        """The number M of filters."""
        return self.bank.modes

    def predicted(
        self, means: FloatArray, covariances: FloatArray, u: FloatArray, step_s: float
    ) -> tuple[FloatArray, FloatArray]:
        """See `Bank.predicted`."""
        return self.bank.predicted(means, covariances, u, step_s)

    def updated(
        self, means: FloatArray, covariances: FloatArray, z: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """See `Bank.updated`."""
        corrected, covariances, logs, squared = self.bank.updated(means, covariances, z)
        entries = int(np.isfinite(z).sum())
        tails = np.log(OUTLIERS) + squared / 2 - (entries + 1) / 2 * np.log1p(squared)
        logs = logs + np.logaddexp(np.log1p(-OUTLIERS), tails)
        bound = MOST_SIGMAS * np.sqrt(entries)
        pull = bound / np.maximum(np.sqrt(squared), bound)
        step = pull[..., None] * wrapped(corrected - means, self.state_angles)
        corrected = wrapped(means + step, self.state_angles)
        return corrected, covariances, self.independent * logs, squared


def usable_measurements(signals: Signals, gap_ends: IntArray, fastest_m_s: float) -> FloatArray:
    """Measurements (N, m) where they depend on the modes.

    Not while stationary or blocked, nor in a gap, nor far above the speeds that the modes were
    identified at.
    """
    faster = faster_than(signals.tread_speeds_m_s, fastest_m_s)
    informative = moving(signals, fastest_m_s) & ~np.append(False, faster[:-1])
    informative &= ~touched(signals.gaps_s, signals.stamps_s, signals.stamps_s)
    informative &= ~within(signals.stamps_s, signals.blocked_s)
    informative[gap_ends] = False
    return np.where(informative[:, None], signals.measured, np.nan)


def independent_share(signals: Signals, errors_last_s: float) -> float:
    """Share of a measurement that is news, when errors of the models last."""
    measured_s = signals.stamps_s[np.isfinite(signals.measured).any(axis=1)]
    if errors_last_s <= 0 or len(measured_s) < 2:
        return 1.0
    return min(1.0, float(np.median(np.diff(measured_s))) / errors_last_s)


def with_lead(alone: ModeBelief, belief: ModeBelief, led: int) -> ModeBelief:
    """The estimate of own filters; that of a mode which takes the lead begins anew.

    While the mode did not hold, its own filter went astray. `led` is the most probable mode before.
    """
    lead = int(belief.log_probabilities.argmax())
    if lead == led:
        return alone
    means, covariances = alone.means.copy(), alone.covariances.copy()
    means[lead], covariances[lead] = belief.means[lead], belief.covariances[lead]
    return ModeBelief(means, covariances, alone.log_probabilities)


def with_bias(belief: ModeBelief, mean: FloatArray, covariance: FloatArray) -> ModeBelief:
    """An estimate with the bias, the last entry, of a mean (n,) and covariance (n, n).

    It is one of the gyroscope: no mode has its own.
    """
    means, covariances = belief.means.copy(), belief.covariances.copy()
    means[:, -1] = mean[-1]
    covariances[:, -1] = covariances[:, :, -1] = 0.0
    covariances[:, -1, -1] = covariance[-1, -1]
    return ModeBelief(means, covariances, belief.log_probabilities)


def with_shared_bias(belief: ModeBelief, independent: float) -> ModeBelief:
    """An estimate with one bias, the last entry, for all modes: its mean and variance over them.

    It is one of the gyroscope. With its own bias each mode would explain the same turn; while
    modes are not distinguished, what these biases differ by would count as uncertainty of the bias,
    and make them differ more. Filters hold its variance by the share `independent`, so that what
    their means differ by counts by as much. The rest of a mode's estimate, given the bias, stays.
    """
    weights, biases = belief.probabilities, belief.means[:, -1]
    variances = belief.covariances[:, -1, -1]
    bias = weights @ biases
    variance = weights @ (variances + independent * (biases - bias) ** 2)
    open_variances = np.where(variances > 0, variances, np.inf)  # a bias that is known stays
    slopes = belief.covariances[:, :, -1] / open_variances[:, None]
    means = belief.means + slopes * (bias - biases)[:, None]
    added = (variance - variances)[:, None, None] * slopes[:, :, None] * slopes[:, None, :]
    return ModeBelief(
        means, belief.covariances + added, belief.log_probabilities, belief.innovations
    )
