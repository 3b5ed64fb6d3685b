"""Settings of the estimator of modes and of its answers, each with its reason."""

from dataclasses import dataclass, fields

from odometry.config import require, require_positive


@dataclass(frozen=True)
class ModesConfig:
    """Settings of the estimator and of its answers.

    Numbers of deviations and shares were chosen on seeds of
    `tests/studies/modes/modes_faults.py`, as the tests that use them say.

    Attributes
    ----------
    floor : float
        Least probability of a mode: one that was impossible could never come back.
    sure : float
        The probability from which a mode is named; below it the answer is "undetermined".
    most_doubt : float
        A named mode stays named, while it leads, up to so many times the doubt 1 - sure: near one
        threshold an answer comes and goes.
    agreed : float
        Probability from which the rolling test, or feel, takes a mode for the one that fits.
    lasting_s : float
        A disagreement of camera and feel that lasts so long is reported.
    misfit_share : float
        Share of the time in which no mode of the set fits, before anything was measured.
    long_sigmas : float
        Of a sum of innovations over six seconds, beyond which no mode is named: small misfits last.
    turn_sigmas, turn_holds_s : float
        Of a sum of innovations by the side of the turn, and for how long after it no mode is named:
        clean runs of models that err a little reach 3 and more. Traction modes have no such sums:
        one that six seconds contradicted is not named again for as long.
    turn_gain_sigmas : float
        By which the gain of a velocity mode may be off over the last turns: with 1.5 a terrain that
        was not calibrated has a wrong name for 3.4 % of the time instead of 2.8 (5.3 without the
        test), 34 % of the worst run instead of 19, and clean runs lose 0.8 points instead of 1.3
        (development).
    one_bias_sigmas : float
        By which the gain of a velocity mode may be off over a minute with one bias of the
        gyroscope: with 1.5 wrong names of slow robots with faults are 1.7 % of the time instead of
        2.1 (4.2 without the test), and their clean runs lose 0.8 points instead of 0.3
        (development).
    travel_sigmas : float
        By which a mode travels another distance than was measured.
    headings_share, headings_sigmas : float
        Gyroscope and headings turn apart by more than this share of what distinguishes two modes,
        and by so many deviations of the headings: with a half a soft limit is another terrain.
    between_sigmas, between_half_sigmas : float
        By which the share of a mixture of two modes lies between 0 and 1, over a window and over
        each half of it: a change from one to the other is no mixture.
    gain_sigmas : float
        By which the gain of a traction mode may be off over a window: with 2.5 a terrain between
        two modes has a wrong name for 17.0 % of the time instead of 14.8, and clean runs lose 0.8
        points instead of 1.8 (development, one spread for all modes).
    centre_sigmas : float
        By which the turning centre of a traction mode may be off over a window: with 2 wrong names
        of terrains and sets that were not calibrated are 7.8 % of the time instead of 8.9, and
        clean runs lose 0.45 points instead of 0.28, those with late poses 0.25 (development).
    drift_sigmas : float
        By which places drift in one direction of the world: with 3 clean runs lose 0.1 points more,
        and with 3.5 wrong names on slopes stay for 0.1 % of the time more (development).
    point_sigmas : float
        By which the robot may turn about another point than in the runs of velocity modes: with 3 a
        load shows in 55 % of its windows instead of 71, and of clean drives 0.0 % instead of 0.1
        are taken for one (development).
    alike_sigmas : float
        Of what lasts of the errors of modes; below it two modes are taken for equal.
    bias_sigmas : float
        Within so many of them a bias is expected; only a mode that is not true needs a larger one.
    """

    floor: float = 1e-6
    sure: float = 0.9
    most_doubt: float = 2.0
    agreed: float = 0.6
    lasting_s: float = 2.0
    misfit_share: float = 0.05
    long_sigmas: float = 3.5
    turn_sigmas: float = 3.5
    turn_holds_s: float = 3.0
    turn_gain_sigmas: float = 1.25
    one_bias_sigmas: float = 2.0
    travel_sigmas: float = 3.0
    headings_share: float = 1 / 3
    headings_sigmas: float = 5.0
    between_sigmas: float = 3.0
    between_half_sigmas: float = 2.0
    gain_sigmas: float = 2.25
    centre_sigmas: float = 2.5
    drift_sigmas: float = 3.25
    point_sigmas: float = 2.0
    alike_sigmas: float = 2.0
    bias_sigmas: float = 3.0

    def __post_init__(self) -> None:
        require(0 <= self.floor < 0.5, f"floor = {self.floor}, expected 0 to below 0.5")
        require(0.5 < self.sure < 1, f"sure = {self.sure}, expected above 0.5 and below 1")
        require(self.most_doubt >= 1, f"most_doubt = {self.most_doubt}, expected 1 or more")
        require(0 < self.agreed < 1, f"agreed = {self.agreed}, expected above 0 and below 1")
        require(
            0 < self.misfit_share < 0.5,
            f"misfit_share = {self.misfit_share}, expected above 0 and below 0.5",
        )
        sigmas = [field.name for field in fields(self) if field.name.endswith("sigmas")]
        require_positive(self, "lasting_s", "turn_holds_s", "headings_share", *sigmas)
