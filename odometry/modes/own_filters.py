"""The filter of each mode by itself: what its innovations would be if the mode were true.

In the interacting multiple model estimator an improbable mode begins every step where the probable
one is, and shows no error of its own.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.bank import Bank
from odometry.estimation.ekf_bank import EkfBank
from odometry.estimation.mode_belief import ModeBelief


@dataclass(frozen=True)
class OwnFilters:
    """Filters that are not mixed.

    Attributes
    ----------
    bank : Bank
        What steps them.
    filters : EkfBank
        The same filters, for the covariance of their innovations.
    """

    bank: Bank
    filters: EkfBank

    def step(
        self, belief: ModeBelief, u: FloatArray, z: FloatArray, step_s: float
    ) -> tuple[ModeBelief, FloatArray]:
        """The estimate a step later, and normalised innovations (M, m), NaN where not measured."""
        means, covariances = self.bank.predicted(belief.means, belief.covariances, u, step_s)
        innovations = self.filters.innovations(means, covariances, z)
        if np.isfinite(z).any():
            means, covariances, _, _ = self.bank.updated(means, covariances, z)
        return ModeBelief(means, covariances, belief.log_probabilities), innovations


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
