"""A recorded run fed to `LiveFeel`, as if it came in."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.feel.labels.felt import FeelConfig, FeltWindows
from odometry.feel.labels.follow import Felt, follow_feel
from odometry.feel.labels.live import LiveFeel
from odometry.feel.model import FeelModel
from odometry.feel.recorded.signals import ACCEL, CURRENTS, GYRO, axes_of
from odometry.recording.run import Run


def follow_feel_live(run: Run, model: FeelModel, config: FeelConfig | None = None) -> Felt:
    """As `follow_feel`, with nothing that is later than the stamp from which a window is known.

    The sampling rate is that of the first window, and tread speeds have gaps as `GapsSoFar` finds
    them. A run that no window of which becomes known before its last frame gives those of
    `follow_feel`.

    Raises
    ------
    RunFolderError
        As `follow_feel`.
    """
    felt = follow_feel(run, model, config)
    parts = [_last(one) for one in _followed(run, LiveFeel(model, run.robot, config=config))]
    if not parts:
        return felt
    found = FeltWindows.joined(parts)
    return replace(felt, windows=found.windows, scores=found.scores, foreign=found.foreign)


def _followed(run: Run, live: LiveFeel) -> Iterator[FeltWindows]:
    table, axes = axes_of(run)
    stamps_s = table.stamps_s
    gyro, accel = (
        np.stack([axes.get(name, np.full(len(stamps_s), np.nan)) for name in names], axis=-1)
        for names in (GYRO, ACCEL)
    )
    currents = _currents(run)
    row = current_row = 0
    for frame in run.frames():
        while row < len(stamps_s) and stamps_s[row] <= frame.stamp_s:
            live.imu(float(stamps_s[row]), gyro=gyro[row], accel=accel[row])
            row += 1
        while currents is not None and current_row <= frame.odometry_row:
            stamp_s = float(run.odometry.stamps_s[current_row])
            live.currents(stamp_s, *currents[current_row].tolist())
            current_row += 1
        yield from live.step(frame)


def _currents(run: Run) -> FloatArray | None:
    if not all(name in run.odometry for name in CURRENTS):
        return None
    return run.odometry.stack(*CURRENTS)


def _last(felt: FeltWindows) -> FeltWindows:
    return felt.since(len(felt.windows) - 1)
