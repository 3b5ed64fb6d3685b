"""Faults of one side alone: brakes, encoders, tracks, motors and controllers."""
# ruff: noqa: ARG001, ARG005 - all have one face, and few need all of it

import math

import numpy as np
from scipy.signal import lfilter

from tests.blind.commands import followed
from tests.blind.hidden.courses import bursts, delayed, lagged
from tests.blind.hidden.kind import Hidden, Kind


def side_of(rng):
    """Mask (2,) of one of both sides."""
    return np.arange(2) == rng.integers(2)


def dragging_brake(rng, scene):
    """A brake of one side drags: whatever is asked, 0.03 to 0.1 m/s of it are lost."""
    side, lost_m_s = side_of(rng), rng.uniform(0.03, 0.1)

    def hide(rng, clock):
        def treads(asked):
            braked = np.sign(asked) * np.maximum(np.abs(asked) - lost_m_s, 0.0)
            return np.where(side, braked, asked)

        return Hidden({"lost_m_s": lost_m_s}, treads=treads)

    return hide


def late_encoder(rng, scene):
    """The encoder of one side is read 0.1 to 0.3 s late."""
    side, late_s = side_of(rng), round(rng.uniform(0.1, 0.3), 2)

    def hide(rng, clock):
        return Hidden(
            {"late_s": late_s},
            reported=lambda asked, v: np.where(side, delayed(v, late_s, clock.step_s), v),
        )

    return hide


def smooth_encoder(rng, scene):
    """The speed of one side is recorded through a filter of 0.15 to 0.4 s."""
    side, constant_s = side_of(rng), rng.uniform(0.15, 0.4)

    def hide(rng, clock):
        return Hidden(
            {"constant_s": constant_s},
            reported=lambda asked, v: np.where(side, lagged(v, constant_s, clock.step_s), v),
        )

    return hide


def side_on_ice(rng, scene):
    """One side runs over ice for 1 to 4 s, now and then, and keeps 40 to 80 % of its speed."""
    side, kept = side_of(rng), rng.uniform(0.4, 0.8)

    def hide(rng, clock):
        mask, events = bursts(rng, clock, (1.0, 4.0), (6.0, 20.0))
        factor = np.where(mask[:, None] & side, kept, 1.0)
        return Hidden({"kept": kept, "events": events}, treads=lambda v: v * factor)

    return hide


def side_runs_on(rng, scene):
    """One side has no brake: it speeds up as asked and slows down within 0.2 to 0.8 s."""
    side, kept_s = side_of(rng), rng.uniform(0.2, 0.8)

    def hide(rng, clock):
        kept = math.exp(-clock.step_s / kept_s)

        def treads(asked):
            result, state = np.empty_like(asked), asked[0].copy()
            for row, wanted in enumerate(asked):
                runs_on = side & (np.abs(wanted) < np.abs(state))
                state = np.where(runs_on, wanted + kept * (state - wanted), wanted)
                result[row] = state
            return result

        return Hidden({"kept_s": kept_s}, treads=treads)

    return hide


def weak_in_turns(rng, scene):
    """One motor gives way under the load of turns, the more the sharper they are."""
    side, share_s_m = side_of(rng), rng.uniform(0.05, 0.3) / scene.speed_m_s

    def hide(rng, clock):
        def treads(asked):
            load = np.abs(asked[:, :1] - asked[:, 1:])
            return asked * (1 - np.clip(share_s_m * load, 0.0, 0.8) * side)

        return Hidden({"share_s_m": share_s_m}, treads=treads)

    return hide


def hot_side(rng, scene):
    """One motor grows weaker with the heat of its own work, and cools within 10 to 40 s."""
    side, most, constant_s = side_of(rng), rng.uniform(0.1, 0.4), rng.uniform(10.0, 40.0)

    def hide(rng, clock):
        kept = math.exp(-clock.step_s / constant_s)

        def treads(asked):
            heat = lfilter([1 - kept], [1, -kept], (asked / scene.speed_m_s) ** 2, axis=0)
            return asked * (1 - np.clip(most * heat, 0.0, 0.6) * side)

        return Hidden({"most": most, "constant_s": constant_s}, treads=treads)

    return hide


def coarse_side(rng, scene):
    """The controller of one side sets speeds in steps of 0.1 to 0.3 m/s."""
    side, step_m_s = side_of(rng), rng.uniform(0.1, 0.3)

    def hide(rng, clock):
        return Hidden(
            {"step_m_s": step_m_s},
            treads=lambda v: np.where(side, step_m_s * np.round(v / step_m_s), v),
        )

    return hide


def slack_side(rng, scene):
    """After each reversal one side turns freely through 4 to 20 cm of its track."""
    side, play_m = side_of(rng), rng.uniform(0.04, 0.2)

    def hide(rng, clock):
        def treads(asked):
            travel_m = np.cumsum(asked * clock.step_s, axis=0)
            result, held_m = np.empty_like(asked), travel_m[0] - play_m / 2
            for row, place_m in enumerate(travel_m):
                moved_m = np.clip(held_m, place_m - play_m, place_m)
                result[row], held_m = (moved_m - held_m) / clock.step_s, moved_m
            return np.where(side, result, asked)

        return Hidden({"play_m": play_m}, treads=treads)

    return hide


def gentle_side(rng, scene):
    """The drive of one side changes its speed by at most 0.15 to 0.4 m/s a second."""
    side, most_m_s2 = side_of(rng), rng.uniform(0.15, 0.4)

    def hide(rng, clock):
        steps = np.where(side, most_m_s2, np.inf) * clock.step_s

        def treads(asked):
            sides = zip(asked.T, steps.tolist(), strict=True)
            return np.column_stack([followed(one, step, one[0]) for one, step in sides])

        return Hidden({"most_m_s2": most_m_s2}, treads=treads)

    return hide


ONE_SIDE = {
    "dragging_brake": Kind(dragging_brake, acceptable=("drive limits", "tread slip")),
    "late_encoder": Kind(late_encoder),
    "smooth_encoder": Kind(smooth_encoder),
    "side_on_ice": Kind(
        side_on_ice,
        acceptable=("wheel size in_bursts", "traction in_bursts", "tread slip in_bursts"),
        course="in_bursts",
    ),
    "side_runs_on": Kind(side_runs_on, acceptable=("slow drive", "drive limits")),
    "weak_in_turns": Kind(weak_in_turns, acceptable=("tread slip",)),
    "hot_side": Kind(
        hot_side,
        acceptable=("tread slip", "traction gradual", "wheel size gradual", "drive limits"),
    ),
    "coarse_side": Kind(coarse_side, acceptable=("drive limits",)),
    "slack_side": Kind(slack_side, acceptable=("drive limits", "slow drive", "late commands")),
    "gentle_side": Kind(gentle_side, (("drive limits",),), acceptable=("slow drive",)),
}
