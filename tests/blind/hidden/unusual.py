"""Effects of heat, load, cables and controllers, and of references that make up what they say."""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import math

import numpy as np
from scipy.signal import lfilter

from tests.blind.hidden.courses import lagged, sign
from tests.blind.hidden.kind import Hidden, Kind


def hot_motor(rng, scene):
    """Each motor grows weaker with the heat of its own work, and cools within 10 to 40 s."""
    most, constant_s = rng.uniform(0.1, 0.3), rng.uniform(10.0, 40.0)

    def hide(rng, clock):
        kept = math.exp(-clock.step_s / constant_s)

        def treads(asked):
            heat = lfilter([1 - kept], [1, -kept], (asked / scene.speed_m_s) ** 2, axis=0)
            return asked * (1 - np.clip(most * heat, 0.0, 0.6))

        return Hidden({"most": most, "constant_s": constant_s}, treads=treads)

    return hide


def coarse_controller(rng, scene):
    """A controller that sets speeds in steps of 0.1 to 0.25 m/s."""
    step_m_s = rng.uniform(0.1, 0.25)

    def hide(rng, clock):
        return Hidden({"step_m_s": step_m_s}, treads=lambda v: step_m_s * np.round(v / step_m_s))

    return hide


def crabbing(rng, scene):
    """Bent axles: the robot moves to one side in proportion to its speed."""
    share = sign(rng) * rng.uniform(0.03, 0.12)

    def hide(rng, clock):
        def twist(values, treads):
            return values + np.column_stack(
                [0 * values[:, 0], share * values[:, 0], 0 * values[:, 0]]
            )

        return Hidden({"share": share}, twist=twist)

    return hide


def leaning_load(rng, scene):
    """A tall load leans back as the robot drives forward: where it turns about moves with speed."""
    share_s = rng.uniform(0.05, 0.3)

    def hide(rng, clock):
        def twist(values, treads):
            leans_m = share_s * lagged(values[:, :1], 0.5, clock.step_s)[:, 0]
            slides = leans_m * values[:, 2]
            return values + np.column_stack([0 * slides, slides, 0 * slides])

        return Hidden({"share_s": share_s}, twist=twist)

    return hide


def dragged_cable(rng, scene):
    """A cable paid out behind: the farther from the start, the more it brakes."""
    share_1_m = rng.uniform(0.01, 0.05)

    def hide(rng, clock):
        start = []

        def at_place(row, pose, twist):
            if not start:
                start.append(complex(*pose[:2]))
            far_m = abs(complex(*pose[:2]) - start[0])
            return twist[0] * (1 - min(share_1_m * far_m, 0.5)), twist[1], twist[2]

        return Hidden({"share_1_m": share_1_m}, at_place=at_place)

    return hide


def stiff_turns(rng, scene):
    """Scrubbing tyres: the first 0.05 to 0.2 rad/s of a turn bend rubber and do not turn."""
    least_rad_s = rng.uniform(0.05, 0.2)

    def hide(rng, clock):
        def twist(values, treads):
            turn = values[:, 2]
            left = np.sign(turn) * np.maximum(np.abs(turn) - least_rad_s, 0.0)
            return np.column_stack([values[:, :2], left])

        return Hidden({"least_rad_s": least_rad_s}, twist=twist)

    return hide


def wide_when_fast(rng, scene):
    """The faster the robot, the less it turns: by a quarter to a half at its speed."""
    share = rng.uniform(0.33, 1.0)

    def hide(rng, clock):
        def twist(values, treads):
            less = 1 / (1 + share * np.abs(values[:, 0]) / scene.speed_m_s)
            return np.column_stack([values[:, :2], less * values[:, 2]])

        return Hidden({"share": share}, twist=twist)

    return hide


def lost_teeth(rng, scene):
    """An encoder of one side counts every second tooth of what is above half of the speed."""
    side, most = int(rng.integers(2)), rng.uniform(0.4, 0.6) * scene.speed_m_s

    def hide(rng, clock):
        def reported(asked, v):
            read = np.array(v)
            beyond = np.maximum(np.abs(v[:, side]) - most, 0.0)
            read[:, side] -= np.sign(v[:, side]) * beyond / 2
            return read

        return Hidden({"side": side, "most_m_s": most}, reported=reported)

    return hide


def slow_turns(rng, scene):
    """Turns begin and end 0.15 to 0.5 s late, speeds do not: a long robot on soft terrain."""
    constant_s = rng.uniform(0.15, 0.5)

    def hide(rng, clock):
        def twist(values, treads):
            late = lagged(values[:, 1:], constant_s, clock.step_s)
            return np.column_stack([values[:, 0], late])

        return Hidden({"constant_s": constant_s}, twist=twist)

    return hide


def coasting(rng, scene):
    """Treads speed up as asked, and run out over 0.2 to 0.8 s when they are to be slower."""
    constant_s = rng.uniform(0.2, 0.8)

    def hide(rng, clock):
        kept = math.exp(-clock.step_s / constant_s)

        def treads(asked):
            result, state = np.empty_like(asked), asked[0].copy()
            for row, wanted in enumerate(asked):
                slower = np.abs(wanted) < np.abs(state)
                state = np.where(slower, wanted + kept * (state - wanted), wanted)
                result[row] = state
            return result

        return Hidden({"constant_s": constant_s}, treads=treads)

    return hide


def course_for_yaw(rng, scene):
    """A receiver reports the direction in which its antenna moves for the heading."""
    ahead_m = sign(rng) * rng.uniform(0.1, 0.4)

    def hide(rng, clock):
        def reference(times_s, poses):
            x_m_s, y_m_s = np.gradient(poses[:, :2], times_s, axis=0).T
            rate = np.gradient(poses[:, 2], times_s)
            along = x_m_s * np.cos(poses[:, 2]) + y_m_s * np.sin(poses[:, 2])
            fast = np.abs(along) > 0.2
            slip = np.where(fast, np.arctan(ahead_m * rate / np.where(fast, along, 1.0)), 0.0)
            return times_s, np.column_stack([poses[:, :2], poses[:, 2] + slip])

        return Hidden({"ahead_m": ahead_m}, reference=reference)

    return hide


def straight_between_fixes(rng, scene):
    """The reference has a pose each 1 to 3 s and draws straight lines between them."""
    period_s = rng.uniform(1.0, 3.0)

    def hide(rng, clock):
        def reference(times_s, poses):
            known_s = np.append(np.arange(times_s[0], times_s[-1], period_s), times_s[-1])
            known = [np.interp(known_s, times_s, column) for column in poses.T]
            between = [np.interp(times_s, known_s, column) for column in known]
            return times_s, np.column_stack(between)

        return Hidden({"period_s": period_s}, reference=reference)

    return hide


UNUSUAL = {
    "hot_motor": Kind(
        hot_motor,
        acceptable=("tread slip", "traction gradual", "wheel size gradual", "drive limits"),
    ),
    "coarse_controller": Kind(coarse_controller, acceptable=("drive limits",)),
    "crabbing": Kind(crabbing, acceptable=("sensor heading",)),
    "leaning_load": Kind(leaning_load, acceptable=("inertia",)),
    "dragged_cable": Kind(dragged_cable),
    "stiff_turns": Kind(stiff_turns, acceptable=("drive limits", "turn radius")),
    "wide_when_fast": Kind(wide_when_fast),
    "lost_teeth": Kind(lost_teeth),
    "slow_turns": Kind(slow_turns, acceptable=("slow drive", "late commands", "inertia")),
    "coasting": Kind(coasting, acceptable=("slow drive", "drive limits")),
    "course_for_yaw": Kind(course_for_yaw, (("reference",),)),
    "straight_between_fixes": Kind(straight_between_fixes, (("reference",),)),
}
