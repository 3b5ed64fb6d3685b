"""The twist at which the forces on a robot balance, for many samples at once.

Newton's method with damping. Without centrifugal force the balance is the minimum of a convex
function, the power that friction and gravity take; with it there is no such function. One rule
serves both: a step is good unless the forces at its end push back more than half as hard as
those at its start pushed ahead.
"""

from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.models.contact_balance import Balance, balance_at
from odometry.models.contact_stance import Stance
from odometry.models.icr import GUESSED_WIDTHS
from odometry.models.three_equations import dot, solve_3x3

NEAR = 1e-9  # of the weight; nearer than this, rounding decides which way the forces push
ITERATIONS, STAGE_ITERATIONS, LAST_ITERATIONS, NEAR_ITERATIONS = 20, 4, 60, 8
SLIP_SCALE_FALL = 0.3  # from stage to stage
PUSH_BACK = 0.5
FIRST_DAMPING, LEAST_DAMPING, RAISED_DAMPING = 3.0, 0.01, 1.0  # of the friction at tread speed
DAMPING_FALL, DAMPING_RISE = 0.3, 4.0
LONGEST_STEP = 1.0  # of the larger tread speed


def balanced_twist(stance: Stance) -> FloatArray:
    """Body twist (3, N) at which all forces balance.

    The search starts from an effective width without sideways motion. Samples that do not
    settle are led to their slip scale from a large one, at which friction is all but linear, in
    stages. What settles nowhere keeps the twist of least residual.
    """
    twist, least = descend(stance, _start(stance), ITERATIONS)
    lost = least > NEAR
    if np.any(lost):
        twist[:, lost] = _led_by_slip_scale(stance.rows(np.flatnonzero(lost)))
    return twist


def balanced_near(stance: Stance, known: FloatArray) -> FloatArray:
    """The same from twists (3, N) that balance forces a little different, where that settles."""
    twist, least = descend(stance, known, NEAR_ITERATIONS, damping=0.0)
    lost = least > NEAR
    if np.any(lost):
        twist[:, lost] = balanced_twist(stance.rows(np.flatnonzero(lost)))
    return twist


def descend(
    stance: Stance, start: FloatArray, iterations: int, *, damping: float = FIRST_DAMPING
) -> tuple[FloatArray, FloatArray]:
    """Damped Newton steps: the twist (3, N) of least residual on the way, and its size (N,).

    The start counts. Samples that are near a balance take one undamped step more, to the last
    digit, after the size of their residual, and are not moved any more.
    """
    best, least = start.copy(), np.full(start.shape[1], np.inf)
    left = np.arange(start.shape[1])  # samples that have not settled yet
    twist, step = start, np.zeros_like(start)
    force, matrix = np.zeros_like(start), np.zeros((3, *start.shape))
    damped = np.full(start.shape[1], damping)
    for _ in range(iterations):
        tried = balance_at(stance, twist + step)
        size = _size(stance, tried.residual)
        good = _is_good(force, tried, step) | (size < NEAR)
        twist = np.where(good, twist + step, twist)
        force = np.where(good, tried.residual, force)
        matrix = np.where(good, tried.by_twist, matrix)
        closer = np.flatnonzero(good & (size < least[left]))
        best[:, left[closer]], least[left[closer]] = twist[:, closer], size[closer]
        open_ = least[left] > NEAR
        if not np.all(open_):
            settled = np.flatnonzero(~open_)
            best[:, left[settled]] += solve_3x3(-matrix[..., settled], force[:, settled])
            chosen = np.flatnonzero(open_)
            if not len(chosen):
                break
            left, stance, good = left[chosen], stance.rows(chosen), good[chosen]
            twist, force, matrix, damped = (
                array.take(chosen, axis=-1) for array in (twist, force, matrix, damped)
            )
        damped = np.where(good, _fallen(damped), np.maximum(DAMPING_RISE * damped, RAISED_DAMPING))
        step = _step(stance, force, matrix, damped)
    return best, least


def _start(stance: Stance) -> FloatArray:
    left, right = stance.tread_speeds_m_s
    omega = (right - left) / (2 * GUESSED_WIDTHS * stance.base_m[1])
    return np.array([(left + right) / 2, np.zeros_like(omega), omega])


def _led_by_slip_scale(stance: Stance) -> FloatArray:
    twist = _start(stance)
    scale = np.abs(stance.tread_speeds_m_s).max(axis=0)
    while len(larger := np.flatnonzero(scale > stance.slip_scale_m_s)):
        eased = replace(stance, slip_scale_m_s=scale).rows(larger)
        twist[:, larger], _ = descend(eased, twist[:, larger], STAGE_ITERATIONS)
        scale = SLIP_SCALE_FALL * scale
    twist, least = descend(stance, twist, LAST_ITERATIONS)
    twist[:, np.isinf(least)] = np.nan  # an input is not known
    return twist


def _is_good(force: FloatArray, tried: Balance, step: FloatArray) -> BoolArray:
    ahead, back = dot(force, step), -dot(tried.residual, step)
    return np.asarray((ahead >= 0) & (back <= PUSH_BACK * ahead))


def _fallen(damping: FloatArray) -> FloatArray:
    fallen = DAMPING_FALL * damping
    return np.where(fallen < LEAST_DAMPING, 0.0, fallen)


def _step(stance: Stance, force: FloatArray, matrix: FloatArray, damping: FloatArray) -> FloatArray:
    """Damped Newton step (3, N), no longer than the treads are fast."""
    speed = np.abs(stance.tread_speeds_m_s).max(axis=0) + stance.slip_scale_m_s
    radius = np.hypot(*stance.base_m)
    damped = -matrix
    resisted = damping * stance.mu / speed
    damped[0, 0] += resisted
    damped[1, 1] += resisted
    damped[2, 2] += damping * radius**2 * stance.mu / speed
    step = solve_3x3(damped, force)
    length = np.sqrt(step[0] ** 2 + step[1] ** 2 + (radius * step[2]) ** 2)
    return np.asarray(step / np.maximum(1.0, length / (LONGEST_STEP * speed)))


def _size(stance: Stance, force: FloatArray) -> FloatArray:
    """Size (N,) of a wrench, the moment by the half diagonal of the base."""
    moment = force[2] / np.hypot(*stance.base_m)
    return np.asarray(np.sqrt(force[0] ** 2 + force[1] ** 2 + moment**2))
