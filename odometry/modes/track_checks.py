"""What is held against the most probable mode: gyroscope, modes alike, turns and travel."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.between_modes import BetweenModes, between_modes
from odometry.modes.bias_reading import bias_readings
from odometry.modes.gyroscope_trust import GyroscopeTrust, gyroscope_trust
from odometry.modes.innovation_test import Innovations
from odometry.modes.mode_set import ModeSet
from odometry.modes.modes_config import ModesConfig
from odometry.modes.signals import Signals
from odometry.modes.similar_modes import similar_modes
from odometry.modes.travel_check import TravelCheck, travel_check
from odometry.modes.turn_agreement import turns_disagree
from odometry.modes.turn_test import turns_are_off
from odometry.modes.velocity import VelocityModes


def gyroscope_trust_of(
    signals: Signals,
    mode_set: ModeSet,
    state: tuple[FloatArray, FloatArray],
    config: ModesConfig,
) -> GyroscopeTrust | None:
    """Of biases (N,) and their deviations (N,); None where filters measure headings themselves."""
    if mode_set.modes.state_angles:
        return None
    return gyroscope_trust(signals, *state, bias_readings(signals), config)


def contradictions(
    signals: Signals,
    mode_set: ModeSet,
    left: Innovations,
    biases_rad_s: FloatArray,
    config: ModesConfig,
) -> tuple[
    BoolArray | None, BoolArray | None, TravelCheck | None, BetweenModes | None, BoolArray | None
]:
    """Modes alike, turns that contradict, travel, turns between two modes, headings at odds.

    None of modes that hear poses themselves.
    """
    modes = mode_set.modes
    if not isinstance(modes, VelocityModes):
        return None, None, None, None, None
    asked = modes.steady_yaw_rates(signals.tread_speeds_m_s)
    before = np.vstack([np.zeros(asked.shape[1]), asked[:-1]])
    alike = similar_modes(signals, modes, left.leading, config)
    between = between_modes(signals, modes, biases_rad_s, left.independent, config)
    off = turns_are_off(left, before, config)
    travel = travel_check(signals, modes, config)
    disagree = turns_disagree(signals, modes, left.leading, biases_rad_s, config)
    return alike, off, travel, between, disagree
