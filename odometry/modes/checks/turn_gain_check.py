"""Whether the last turns were those of the most probable velocity mode, also on the straight after.

A name outlives the turn that it came of: on a straight most modes predict the same motion, and what
one turn made probable stays so until the next. The gain of that turn as a whole may lie beside the
mode all the same, some way to its neighbour. How far gains are off on turns that a mode was not
identified from, `identify-modes` has measured (`turn_spread`, `turn_power`).
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.checks.between_modes import LEFT_BIAS_RAD_S
from odometry.modes.identify.held_out_gains import gain_sums
from odometry.modes.identify.held_out_turns import TURNED_S, turning_clock
from odometry.modes.models.innovation_test import windowed
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

TOLERANCE = 0.01  # as a share: no gain is identified better
# Of the way to the next mode: what is nearer to a mode moves the robot nearly as it does.
LEAST_WAY = 0.3
# After rows that were lost the treads of before are in force: the robot was at other speeds.
LOST_STEPS, SETTLES_S = 3.0, 0.5


def turn_gain_check(
    signals: Signals,
    modes: VelocityModes,
    leading: IntArray,
    biases_rad_s: FloatArray,
    config: ModesConfig | None = None,
) -> BoolArray | None:
    """Where (N,) the gain of the last turns is off by more than the most probable mode's may be.

    Over the first of TURNED_S of turning whichever mode led, and over the second while this one
    did: a turn may begin on one terrain and end on another. `signals` are measured where they
    depend on the modes, `leading` (N,) is the most probable one, `biases_rad_s` (N,) are those of
    the filters. None of a set that does not state how far the gains of turns are off.
    """
    config = config or ModesConfig()
    if modes.turn_spread is None or modes.turn_power is None:
        return None
    predicted = modes.yaw_rates_rad_s(signals.stamps_s, signals.tread_speeds_m_s)
    measured, lasts_s = _settled(signals)
    off = np.zeros(len(signals), dtype=np.bool_)
    for mode in np.unique(leading):
        leads, said = leading == mode, predicted[:, mode]
        more, less = LEAST_WAY * ways_to_next(modes, mode, config.alike_sigmas)
        errors = measured - biases_rad_s - said
        for place, counted in enumerate((errors, np.where(leads, errors, np.nan))):
            clock_s, window_s = turning_clock(said, counted, lasts_s), TURNED_S[place]
            share, information, _ = gain_sums(said, counted, clock_s, window_s)
            turned_rad = windowed(said * np.diff(clock_s, prepend=0.0), clock_s, window_s)
            spread, power = modes.turn_spread[mode, place], modes.turn_power[mode, place]
            of_bias = LEFT_BIAS_RAD_S * turned_rad / information
            sigma = np.sqrt(spread**2 + power / information + of_bias**2 + TOLERANCE**2)
            beyond = np.abs(share) > config.turn_gain_sigmas * sigma
            off |= leads & beyond & ((share > more) | (share < -less))
    return off


def ways_to_next(modes: VelocityModes, mode: int, alike_sigmas: float) -> FloatArray:
    """To the next mode that turns more, and less (2,), as shares; as far as on the other side else.

    Modes that are equal in motion are no next ones; infinite where there is none.
    """
    gains, lasting = modes.turn_gains()[:, 0], modes.lasting_share()
    away = gains / gains[mode] - 1
    spread = np.hypot(np.maximum(lasting, lasting[mode]), TOLERANCE)
    away = away[np.abs(away) > alike_sigmas * spread]
    ways = np.array([np.abs(away[side * away > 0]).min(initial=np.inf) for side in (1, -1)])
    return np.where(np.isfinite(ways), ways, ways.min())


def _settled(signals: Signals) -> tuple[FloatArray, FloatArray]:
    """Yaw rates (N,) without spikes, NaN after lost rows, and how long (N,) each counts [s].

    A gyroscope may be slower than the rows of the treads: a rate counts since the one before.
    """
    rates, stamps_s = signals.measured[:, -1].copy(), signals.stamps_s
    read = np.flatnonzero(np.isfinite(rates))
    one, lasts_s = rates[read], np.zeros(len(rates))
    if len(read) > 2:
        rates[read[1:-1]] = np.median(np.stack([one[:-2], one[1:-1], one[2:]]), axis=0)
        since_s = np.diff(stamps_s[read], prepend=stamps_s[read[0]])
        lasts_s[read] = np.minimum(since_s, np.median(since_s))
    steps_s = np.diff(stamps_s, prepend=stamps_s[0])
    lost_s = np.where(steps_s > LOST_STEPS * float(np.median(steps_s)), stamps_s, -np.inf)
    rates[stamps_s - np.maximum.accumulate(lost_s) < SETTLES_S] = np.nan
    return rates, lasts_s
