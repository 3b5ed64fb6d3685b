"""Identify velocity modes from runs: least squares of simulated motion, and the noise left."""

from collections.abc import Iterable, Sequence

import numpy as np
from tqdm import tqdm

from odometry.identification.errors import IdentificationError
from odometry.modes.response import Record, Response, errors_of, fitted_response
from odometry.modes.signals import forward_speed_m_s, velocity_signals
from odometry.modes.stretches import stretches_by_label
from odometry.modes.velocity import VelocityModes
from odometry.run import UNKNOWN, Run

LEAST_S = 10.0  # of a ground
SPEED, OMEGA, LEFT, RIGHT = range(4)
FOLLOWS_HZ, FOLLOWS_SIGMA = 10.0, 0.05  # a speed that only the wheels tell: rate, error [m/s]
CORRECTED_S = 2.0  # within which measurements correct the state of a model that is a little off


def identify_velocity_modes(
    runs: Sequence[Run],
    *,
    shared: bool = False,
    common_noise: bool = False,
    show_progress: bool = False,
) -> VelocityModes:
    """Identify A, B and the noise of each ground that the runs name (Salvi 2024 eq. 2).

    Each row of eq. 2 is fitted by itself: what it answers to what was measured of the other
    quantity and to the treads, simulated over whole stretches.

    Parameters
    ----------
    runs : sequence of Run
        With a yaw rate; grounds as the runs name them.
    shared : bool
        One A and B for all grounds, which then differ in their noise alone (the paper's other
        approach).
    common_noise : bool
        The median noise for all grounds: then only the answer to the treads tells them apart, and
        not how fast or how roughly the runs on each were driven.
    show_progress : bool

    Raises
    ------
    IdentificationError
        If a run names no ground, or less than 10 s of one are recorded.
    RunFolderError
        If a run has no yaw rate.
    """
    records: dict[str, list[Record]] = {}
    bar: Iterable[Run] = tqdm(runs, unit="run", disable=None if show_progress else True)
    for run in bar:
        for label, record in _records(run):
            records.setdefault(label, []).append(record)
    names = tuple(sorted(records))
    for name in names:
        lasts_s = sum(record.lasts_s for record in records[name])
        if lasts_s < LEAST_S:
            raise IdentificationError(
                f"{name}: {lasts_s:.1f} s recorded, expected {LEAST_S:g} s or more"
            )
    pooled = [record for name in names for record in records[name]]
    speed_is_measured = all(forward_speed_m_s(run) is not None for run in runs)
    blocks = np.zeros((len(names), 2, 4))
    measurement = np.full((len(names), 2), FOLLOWS_SIGMA**2)
    lasting_s = []
    for place, name in enumerate(names):
        of = records[name]
        for row in (SPEED, OMEGA):
            if row == SPEED and not speed_is_measured:
                response = Response(FOLLOWS_HZ, np.array([0.0, 0.5, 0.5]) * FOLLOWS_HZ)
            else:
                response = fitted_response(pooled if shared else of, row)
                errors = errors_of(of, row, response)
                measurement[place, row] = errors.variance
                lasting_s.append(errors.power / errors.variance)
            blocks[place, row] = response.row_of(row)
    if common_noise:
        measurement[:] = np.median(measurement, axis=0)
    step_s = float(np.median([record.step_s for record in pooled]))
    process = measurement * step_s / CORRECTED_S**2
    return VelocityModes(
        names,
        blocks[..., :2],
        blocks[..., 2:],
        process,
        measurement,
        float(np.median(lasting_s)),
    )


def _records(run: Run) -> Iterable[tuple[str, Record]]:
    """Stretches of each ground at even times."""
    signals = velocity_signals(run)
    speed = forward_speed_m_s(run)
    if speed is None:
        speed = signals.tread_speeds_m_s.mean(axis=1)
    table = np.column_stack([speed, signals.measured[:, 1], signals.tread_speeds_m_s])
    step_s = float(np.median(np.diff(signals.stamps_s)))
    for label, rows in stretches_by_label(signals.stamps_s, signals.labels):
        if label == UNKNOWN:
            raise IdentificationError(
                f"{run.folder}: rows {rows[0]} to {rows[-1]} of odometry.csv have no ground; "
                "expected [run] terrain in run.toml or a column terrain"
            )
        known = rows[np.isfinite(table[rows]).all(axis=1)]
        if len(known) < 2:
            continue
        begin_s, end_s = signals.stamps_s[known[[0, -1]]]
        even_s = begin_s + step_s * np.arange(int((end_s - begin_s) / step_s) + 1)
        held = known[np.searchsorted(signals.stamps_s[known], even_s + 1e-9, side="right") - 1]
        columns = [np.interp(even_s, signals.stamps_s[known], c) for c in table[known, :2].T]
        yield label, Record(step_s, np.column_stack([*columns, table[held, 2:]]))
