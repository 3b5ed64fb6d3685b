"""What is held against the most probable mode: gyroscope, modes alike, turns and travel."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.between_modes import BetweenModes, between_modes
from odometry.modes.bias_reading import bias_readings
from odometry.modes.gyroscope_trust import GyroscopeTrust, gyroscope_trust
from odometry.modes.innovation_test import Innovations
from odometry.modes.mode_set import ModeSet
from odometry.modes.signals import Signals
from odometry.modes.similar_modes import similar_modes
from odometry.modes.travel_check import TravelCheck, travel_check
from odometry.modes.turn_agreement import turns_disagree
from odometry.modes.turn_test import turns_are_off
from odometry.modes.velocity import VelocityModes


def gyroscope_trust_of(
    signals: Signals, mode_set: ModeSet, biases_rad_s: FloatArray, sigmas_rad_s: FloatArray
) -> GyroscopeTrust | None:
    """None where the filters measure headings, which confirm a bias."""
    if mode_set.modes.state_angles:
        return None
    return gyroscope_trust(signals, biases_rad_s, sigmas_rad_s, bias_readings(signals))


def contradictions(
    signals: Signals, mode_set: ModeSet, left: Innovations, biases_rad_s: FloatArray
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
    alike = similar_modes(signals, modes, left.leading)
    between = between_modes(signals, modes, biases_rad_s, left.independent)
    off, travel = turns_are_off(left, before), travel_check(signals, modes)
    disagree = turns_disagree(signals, modes, left.leading, biases_rad_s)
    return alike, off, travel, between, disagree
