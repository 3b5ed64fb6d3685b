"""The beliefs that `track` carries from step to step, and the filters that move them."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.imm.ekf_bank import EkfBank
from odometry.estimation.imm.estimator import Imm, is_measured
from odometry.estimation.imm.mode_belief import ModeBelief
from odometry.modes.follow.gyroscope_bias import BiasReading, with_reading
from odometry.modes.follow.tempered_bank import (
    TemperedBank,
    with_bias,
    with_lead,
    with_shared_bias,
)
from odometry.modes.models.mode_set import ModeSet

KEPT = 16  # filters of the latest chains and roughnesses
Gaussian = tuple[FloatArray, FloatArray]
Transition = Callable[[float], FloatArray]


class ModeBeliefs(NamedTuple):
    """What is believed at one stamp.

    Attributes
    ----------
    together : ModeBelief
        Of the interacting filters.
    alone : ModeBelief
        Of filters that never mix, for their innovations.
    merged : (n,), (n, n)
        Mean and covariance over all modes.
    """

    together: ModeBelief
    alone: ModeBelief
    merged: Gaussian

    @classmethod
    def at(cls, merged: Gaussian, probabilities: FloatArray) -> Self:
        """The same mean and covariance in every mode."""
        belief = ModeBelief.alike(*merged, probabilities)
        return cls(belief, belief, merged)


class ModeFilters(NamedTuple):
    """Filters of all modes under one chain and roughness.

    Attributes
    ----------
    imm : Imm
    bank : EkfBank
        The same filters, for the covariance of their innovations.
    independent : float
        The share of a measurement that is news.
    """

    imm: Imm
    bank: EkfBank
    independent: float

    def step(
        self,
        beliefs: ModeBeliefs,
        inputs: tuple[FloatArray, FloatArray],
        step_s: float,
        reading: BiasReading | None,
    ) -> tuple[ModeBeliefs, FloatArray]:
        """The beliefs one step on, and the innovations (M, m) of the filters that never mix.

        Parameters
        ----------
        beliefs : ModeBeliefs
        inputs : (2,), (m,)
            Tread speeds until now, and what is measured now.
        step_s : float
        reading : BiasReading, optional
            Of the gyroscope's bias, now.
        """
        led = int(beliefs.together.probabilities.argmax())
        together, alone, innovations = self._moved(beliefs, *inputs, step_s)
        together = with_shared_bias(together, self.independent)
        merged = self.imm.merged(together)
        if reading is not None:
            merged = with_reading(*merged, reading, self.independent)
            together = with_bias(together, *merged)
        alone = with_bias(with_lead(alone, together, led), *merged)
        return ModeBeliefs(together, alone, merged), innovations

    def _moved(
        self, beliefs: ModeBeliefs, u: FloatArray, z: FloatArray, step_s: float
    ) -> tuple[ModeBelief, ModeBelief, FloatArray]:
        """Both estimates a step later, moved at once, and innovations of the filters alone."""
        alone = beliefs.alone
        mixed, mixed_covariances, log_predicted = self.imm.mixed(beliefs.together, step_s)
        means, covariances = self.imm.bank.predicted(
            np.stack([mixed, alone.means]),
            np.stack([mixed_covariances, alone.covariances]),
            u,
            step_s,
        )
        innovations = self.bank.innovations(means[1], covariances[1], z)
        predicted = ModeBelief(means[0], covariances[0], log_predicted)
        if is_measured(z):
            updated = self.imm.bank.updated(means, covariances, z)
            together = self.imm.weighed(predicted, *(both[0] for both in updated))
            means, covariances = updated[:2]
        else:
            together = self.imm.updated(predicted, None)
        return together, ModeBelief(means[1], covariances[1], alone.log_probabilities), innovations

    def begun(self, beliefs: ModeBeliefs, start: Gaussian) -> ModeBeliefs:
        """The beliefs after a gap: motion anew, probabilities and the gyroscope's bias kept."""
        begun = ModeBelief.alike(*start, beliefs.together.probabilities)
        belief = with_bias(begun, *beliefs.merged)
        return ModeBeliefs(belief, belief, self.imm.merged(belief))


class ModeEstimators:
    """Makes the filters of a chain and a roughness when they are needed, and keeps the latest.

    Parameters
    ----------
    mode_set : ModeSet
    transitions : sequence of callable
        Of each chain.
    independent : float
    floor : float
        Least probability of a mode.
    """

    def __init__(
        self, mode_set: ModeSet, transitions: Sequence[Transition], independent: float, floor: float
    ) -> None:
        modes = mode_set.modes

        @lru_cache(KEPT)
        def bank_of(roughness: float) -> EkfBank:
            return EkfBank(modes.model(roughness, independent), len(mode_set.names))

        @lru_cache(KEPT)
        def filters_of(chain: int, roughness: float) -> ModeFilters:
            own = bank_of(roughness)
            bank = TemperedBank(own, independent, modes.state_angles)
            imm = Imm(bank, transitions[chain], modes.state_angles, floor)
            return ModeFilters(imm, own, independent)

        self.of = filters_of
