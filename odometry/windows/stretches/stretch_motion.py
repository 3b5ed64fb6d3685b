"""What a model predicts over stretches of positions, laid over the measured ones.

Where a stretch starts is that of its first position; where it points is not known, and is the
rotation that brings the predicted shape nearest to the measured one (Procrustes, in the plane).
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.models.base import KinematicModel, Linearised
from odometry.models.inputs import Inputs
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.motion import Moving, linearised_window_motion, window_motion


def shape_residuals(model: KinematicModel, values: FloatArray, of: Stretches) -> FloatArray:
    """Predicted less measured rows (K, R).

    In turn the ways along x and y of the antenna from each first position, and, where a gyroscope
    carries the yaw, the turns from there.
    """
    motion = window_motion(carried(model, of), values, of.ends).reshape(len(of), of.steps, 3)
    ways, _ = antenna_ways(motion, of.arm_m)
    off = _turned(ways, rotations(ways, of.measured)) - of.measured
    rows = off.reshape(len(of), -1)
    if of.turns_rad is None:
        return rows
    turned = _between(model.twist(values, of.ends.inputs)[:, 2], of)
    return np.concatenate([rows, turned - of.turns_rad], axis=1)


def change_by_late_turns(model: KinematicModel, values: FloatArray, of: Stretches) -> FloatArray:
    """Change (K, 2n) of the ways of `shape_residuals` by a gyroscope `turns_late_s` late.

    A yaw that lags moves a body that drives ahead aside, as another x_icr does.
    """
    off = []
    for late_s in (0.0, of.turns_late_s):
        motion = window_motion(_Carried(model, late_s), values, of.ends)
        ways, _ = antenna_ways(motion.reshape(len(of), of.steps, 3), of.arm_m)
        off.append(_turned(ways, rotations(ways, of.measured)))
    return np.asarray((off[1] - off[0]).reshape(len(of), -1))


def linearised_shape_residuals(
    model: KinematicModel, values: FloatArray, of: Stretches
) -> tuple[FloatArray, FloatArray]:
    """`shape_residuals` (K, R) and their derivative (K, R, P) by the parameters."""
    found, by_values = linearised_window_motion(carried(model, of), values, of.ends)
    motion = found.reshape(len(of), of.steps, 3)
    by_values = by_values.reshape(len(of), of.steps, 3, -1)
    ways, by_yaw = antenna_ways(motion, of.arm_m)
    change = by_values[:, :, :2] + by_yaw[..., None] * by_values[:, :, 2:]
    turn = rotations(ways, of.measured)
    laid = _turned(ways, turn)
    change = np.moveaxis(_turned(np.moveaxis(change, 3, 0), turn), 0, 3)
    changed_turn = _rotation_change(laid, change, of.measured)
    change = change + _perpendicular(laid)[..., None] * changed_turn[:, None, None, :]
    rows = (laid - of.measured).reshape(len(of), -1)
    by_rows = change.reshape(len(of), -1, change.shape[-1])
    if of.turns_rad is None:
        return rows, by_rows
    twists, by_twist = model.linearised(values, of.ends.inputs)
    turned = _between(twists[:, 2], of) - of.turns_rad
    by_turned = np.stack([_between(column, of) for column in by_twist[:, 2].T], axis=-1)
    return np.concatenate([rows, turned], axis=1), np.concatenate([by_rows, by_turned], axis=1)


def shape_errors(
    model: KinematicModel, values: FloatArray, of: Stretches
) -> tuple[FloatArray, FloatArray]:
    """Errors (K,) of the ways and of the turns per metre of wheel travel.

    The first is the root mean square distance of the predicted shape, its yaw by the treads, laid
    over the measured one; the second the turn error of the whole stretch against the gyroscope,
    or where there is none, of its second half laid apart against its first, by half the travel.
    """
    motion = window_motion(model, values, of.ends).reshape(len(of), of.steps, 3)
    ways, _ = antenna_ways(motion, of.arm_m)
    off = _turned(ways, rotations(ways, of.measured)) - of.measured
    apart_m = np.sqrt(np.sum(off**2, axis=(1, 2)) / (of.steps + 1))
    if of.turns_rad is not None:
        turned = np.abs(motion[:, -1, 2] - of.turns_rad[:, -1])
        return apart_m / of.travel_m, turned / of.travel_m
    half = of.steps // 2
    first = rotations(ways[:, :half], of.measured[:, :half])
    origin = slice(half - 1, half)
    second = rotations(
        ways[:, half:] - ways[:, origin], of.measured[:, half:] - of.measured[:, origin]
    )
    return apart_m / of.travel_m, np.abs(wrap(second - first)) / (of.travel_m / 2)


@dataclass(frozen=True)
class _Carried:
    """A model whose yaw follows the gyroscope of the inputs, late by some time."""

    model: KinematicModel
    late_s: float = 0.0

    def twist(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        twists = self.model.twist(values, inputs).copy()
        twists[:, 2] = inputs.yaw_rate_rad_s
        if self.late_s:
            lags = np.outer(self.late_s * twists[:, 2], (0.0, 0.0, 1.0))
            twists[:, :2] = se2.transform(lags, twists[:, :2])
        return np.asarray(twists)

    def linearised(self, values: FloatArray, inputs: Inputs) -> Linearised:
        twists, by_parameters = (part.copy() for part in self.model.linearised(values, inputs))
        twists[:, 2], by_parameters[:, 2] = inputs.yaw_rate_rad_s, 0.0
        return Linearised(twists, by_parameters)


def carried(model: KinematicModel, of: Stretches) -> Moving:
    """The model, or where there is a gyroscope the model with its yaw carried by that."""
    return model if of.turns_rad is None else _Carried(model)


def _between(rates: FloatArray, of: Stretches) -> FloatArray:
    """Integrals (K, n) of rates (N,) from each first position to the others."""
    return of.ends.integrated(rates).reshape(-1, of.steps)


def rotations(ways: FloatArray, measured: FloatArray) -> FloatArray:
    """Angle (K,) that brings ways (K, n, 2) nearest to measured ones, both from a first place."""
    middle = _centred(measured)
    sine = -np.sum(ways * _perpendicular(middle), axis=(1, 2))
    return np.asarray(np.arctan2(sine, np.sum(ways * middle, axis=(1, 2))))


def _rotation_change(laid: FloatArray, change: FloatArray, measured: FloatArray) -> FloatArray:
    """Derivative (K, P) of the angle, of laid ways (K, n, 2) that change by (K, n, 2, P)."""
    middle = _centred(measured)
    cosine = np.maximum(np.sum(laid * middle, axis=(1, 2)), np.finfo(float).tiny)
    return np.asarray(-np.einsum("kni,knip->kp", _perpendicular(middle), change) / cosine[:, None])


def antenna_ways(motion: FloatArray, arm_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ways (K, n, 2) of the antenna of a robot that moved so, and their derivative by its yaw."""
    cosine, sine = np.cos(motion[..., 2]), np.sin(motion[..., 2])
    turned = np.stack(
        [cosine * arm_m[0] - sine * arm_m[1], sine * arm_m[0] + cosine * arm_m[1]], axis=-1
    )
    return motion[..., :2] + turned - arm_m, _perpendicular(turned)


def _turned(ways: FloatArray, angle: FloatArray) -> FloatArray:
    """Ways (..., K, n, 2) turned by the angle (K,) of their stretch."""
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = ways[..., 0], ways[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def _perpendicular(ways: FloatArray) -> FloatArray:
    return np.stack([-ways[..., 1], ways[..., 0]], axis=-1)


def _centred(ways: FloatArray) -> FloatArray:
    """Places (K, n, 2) from a first one, about the middle of all n + 1.

    In sums of products with other places from a first one, that first one adds nothing.
    """
    return np.asarray(ways - ways.sum(axis=1, keepdims=True) / (ways.shape[1] + 1))
