"""Rounding of the reference, named where that is the gap."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.reference_rounding import RoundedPositions
from odometry.gap.answer.result import NamedEffect
from odometry.gap.config import GapConfig
from odometry.gap.name.verdict import within_noise
from odometry.gap.prepare.calibration import Calibration
from odometry.gap.prepare.end_residuals import ends_of
from odometry.gap.prepare.statistic import Gap, Shown, floor_there, gap_m, gap_of
from odometry.windows.dense.dense import DenseWindows


def named_rounding(
    measured: Sequence[DenseWindows],
    held_out: Sequence[DenseWindows],
    known: Calibration,
    floor: Gap,
    config: GapConfig,
) -> NamedEffect | None:
    """Rounding of the measured runs, where it explains most of the gap on held-out data.

    None where the calibration runs are rounded as coarsely: their noise holds it. `floor` is that
    of the calibration runs.
    """
    steps_m = [one.rounded_m for one in measured]
    if not all(steps_m) or max(one.rounded_m for _, one in known.held_back) >= min(steps_m):
        return None
    before = [
        (
            gap_of(known.base, (), scenes, config.part_s),
            floor_there(floor, known, _unrounded(scenes), config),
        )
        for scenes in (held_out, measured)
    ]
    if within_noise(Shown(*before), config):
        return None
    gap, plain = before[0]
    rounded = floor_there(floor, known, held_out, config)
    closed = (rounded.value**2 - plain.value**2) / (gap.value**2 - plain.value**2)
    evidence = _evidence(measured, known, config)
    if closed < config.least_of_rest or evidence < config.least_evidence:
        return None
    before_m = gap_m(known.base, (), measured)
    return NamedEffect(
        Added(RoundedPositions(), np.array([np.mean(steps_m)])),
        np.array([min(steps_m)]),
        np.array([max(steps_m)]),
        before_m,
        before_m,
        evidence,
    )


def _evidence(scenes: Sequence[DenseWindows], known: Calibration, config: GapConfig) -> float:
    """Twice the log-likelihood of the ends of windows that their rounding gains."""
    less, more = (
        ends_of(known.base, (), of, known, config.part_s) for of in (_unrounded(scenes), scenes)
    )
    costs = [
        float((one.motion**2 / one.variance + np.log(one.variance))[:, :2].sum())
        for one in (less, more)
    ]
    return costs[0] - costs[1]


def _unrounded(scenes: Sequence[DenseWindows]) -> list[DenseWindows]:
    return [replace(one, rounded_m=0.0) for one in scenes]
