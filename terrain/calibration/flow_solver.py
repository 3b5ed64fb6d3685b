"""How terrain flows through the image, and the mount under which it does as the odometer says."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from odometry.arrays import BoolArray, FloatArray
from terrain.calibration.carried_rays import carried_derivatives, carried_rays
from terrain.calibration.tracks import Tracks

# Standard deviations of the odometer's steps: shares of the way (x, y) and of the turn
ALONG, ASIDE, ASIDE_PER_RAD_M, TURN_RAD, TURN = 0.02, 0.02, 0.05, 0.003, 0.05
LOST = 1e6  # squared scales by which a ray that meets no terrain counts as off


@dataclass(frozen=True, eq=False)
class GroundFlow:
    """Tracked features, and what they should do under a mount.

    Attributes
    ----------
    tracks : Tracks
    place_m : (2,)
        x and y of the mount.
    focus_px : float
    """

    tracks: Tracks
    place_m: FloatArray
    focus_px: float

    def residuals(self, values: FloatArray, steps: FloatArray) -> FloatArray:
        """Where the second images show the features, less where they should.

        Parameters
        ----------
        values : (4,)
            z [m], roll, pitch, yaw [rad] of the mount.
        steps : (P, 3)
            Motion of the robot in each pair.

        Returns
        -------
        (N, 2)
            In pixels near the axis; NaN for rays that do not meet the terrain.
        """
        tracks = self.tracks
        after = carried_rays(tracks.before, values, self.place_m, steps[tracks.pair])
        return np.asarray((after - tracks.after) * self.focus_px)

    def derivatives(self, values: FloatArray, steps: FloatArray) -> tuple[FloatArray, FloatArray]:
        """`residuals`, and their derivatives (N, 2, 7) by `values` and by x, y, yaw of a step."""
        tracks = self.tracks
        after, slopes = carried_derivatives(tracks.before, values, self.place_m, steps[tracks.pair])
        return (after - tracks.after) * self.focus_px, slopes * self.focus_px

    def cost(self, values: FloatArray, motions: FloatArray, feature_px: float) -> float:
        """Cauchy's loss of the residuals, and the squares of what was added to the steps (P, 3)."""
        residuals = self.residuals(values, self.tracks.steps + motions)
        squares = (residuals**2).sum(axis=1) / feature_px**2
        loss = np.log1p(np.nan_to_num(squares, nan=LOST))
        return float(loss.sum() + ((motions / self.step_sigmas) ** 2).sum())

    @cached_property
    def features_of_pairs(self) -> csr_array:
        """1 in row p and column n where feature n is of pair p: (P, N)."""
        count, pairs = len(self.tracks.pair), len(self.tracks.steps)
        places = (self.tracks.pair, np.arange(count))
        return csr_array((np.ones(count), places), shape=(pairs, count))

    @cached_property
    def step_sigmas(self) -> FloatArray:
        """Standard deviations (P, 3) of the odometer's steps."""
        steps = self.tracks.steps
        length_m, turn_rad = np.linalg.norm(steps[:, :2], axis=1), np.abs(steps[:, 2])
        aside_m = ASIDE * length_m + ASIDE_PER_RAD_M * turn_rad
        return np.column_stack([ALONG * length_m, aside_m, TURN_RAD + TURN * turn_rad])


FEATURE_PX = 0.5  # scale of Cauchy's loss: features that are farther off count ever less
STEPS = 40
AT_REST = 1e-7  # of a change of the mount [m, rad]
ENOUGH = 1e-3  # of the loss [nats]: a smaller decrease changes the mount by some 1e-6
MOST_DAMPING = 1e6


@dataclass(frozen=True, eq=False)
class Solution:
    """What fits best.

    Attributes
    ----------
    values : (4,)
        z [m], roll, pitch, yaw [rad] of the mount.
    motions : (P, 3)
        What was added to the steps of the odometer.
    residuals_px : (N, 2)
        Of the features; NaN where they would be above the horizon.
    """

    values: FloatArray
    motions: FloatArray
    residuals_px: FloatArray


@dataclass(frozen=True, eq=False)
class _Blocks:
    """J^T W J and J^T W r: mount (F, F), (F,); both (P, F, 3); steps (P, 3, 3), (P, 3)."""

    mount: FloatArray
    both: FloatArray
    step: FloatArray
    mount_right: FloatArray
    step_right: FloatArray


def solve_mount(
    flow: GroundFlow, start: FloatArray, free: BoolArray, feature_px: float = FEATURE_PX
) -> Solution:
    """Search the mount, and small errors of each step, that make the flow agree.

    Gauss-Newton with Levenberg's damping on Cauchy's loss by reweighting. The errors of steps, of
    which each concerns one pair of images, are eliminated (Schur complement).

    Parameters
    ----------
    flow : GroundFlow
    start : (4,)
        z, roll, pitch, yaw.
    free : (4,)
        Which of them are searched.
    feature_px : float
        Scale of the loss.
    """
    values, motions = start.copy(), np.zeros_like(flow.tracks.steps)
    damping, cost = 1e-3, flow.cost(values, motions, feature_px)
    for _ in range(STEPS):
        blocks = _blocks(flow, values, motions, free, feature_px)
        change, gained = np.zeros(0), 0.0
        while damping < MOST_DAMPING:
            change, changes = _change(blocks, flow.step_sigmas, motions, damping)
            tried, tried_motions = values.copy(), motions + changes
            tried[free] += change
            new_cost = flow.cost(tried, tried_motions, feature_px) if tried[0] > 0 else np.inf
            if new_cost <= cost:
                gained = cost - new_cost
                values, motions, cost, damping = tried, tried_motions, new_cost, damping / 5
                break
            damping *= 5
        if gained < ENOUGH or np.abs(change).max(initial=0.0) < AT_REST:
            break
    return Solution(values, motions, flow.residuals(values, flow.tracks.steps + motions))


def _blocks(
    flow: GroundFlow, values: FloatArray, motions: FloatArray, free: BoolArray, feature_px: float
) -> _Blocks:
    here, slopes = flow.derivatives(values, flow.tracks.steps + motions)
    slopes = slopes[..., np.append(free, [True, True, True])]
    rows = np.concatenate([slopes, here[..., None]], axis=-1) / feature_px
    weights = 1 / (1 + (rows[..., -1] ** 2).sum(axis=1))  # Cauchy's
    rows = np.nan_to_num(rows * np.sqrt(weights)[:, None, None])
    size = rows.shape[2]
    squares = (rows.swapaxes(1, 2) @ rows).reshape(-1, size * size)
    summed = (flow.features_of_pairs @ squares).reshape(-1, size, size)
    mount, step = slice(0, -4), slice(-4, -1)
    return _Blocks(
        summed[:, mount, mount].sum(axis=0),
        summed[:, mount, step],
        summed[:, step, step],
        summed[:, mount, -1].sum(axis=0),
        summed[:, step, -1],
    )


def _change(
    blocks: _Blocks, sigmas: FloatArray, motions: FloatArray, damping: float
) -> tuple[FloatArray, FloatArray]:
    """The change of the mount (F,) and of the steps (P, 3)."""
    known = blocks.step + np.eye(3) * (1 / sigmas**2)[:, None, :]
    right = blocks.step_right + motions / sigmas**2
    eliminated = blocks.both @ np.linalg.inv(known)
    left = blocks.mount - (eliminated @ np.swapaxes(blocks.both, 1, 2)).sum(axis=0)
    left = left + damping * np.diag(np.diag(blocks.mount) + 1e-9)
    mount_right = blocks.mount_right - (eliminated @ right[..., None]).sum(axis=0)[:, 0]
    change = -np.linalg.solve(left, mount_right)
    shifted = right + np.einsum("pfk,f->pk", blocks.both, change)
    return change, np.asarray(-np.linalg.solve(known, shifted[..., None])[..., 0])
