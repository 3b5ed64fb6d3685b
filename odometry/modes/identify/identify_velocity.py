"""Identify velocity modes from runs: least squares of simulated motion, and the noise left."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from tqdm import tqdm

from odometry.arrays import FloatArray
from odometry.errors import IdentificationError
from odometry.identification.identify import robot_of
from odometry.modes.identify.gain_spread import gain_spread
from odometry.modes.identify.held_out_turns import turn_errors
from odometry.modes.identify.mode_windows import stretches_by_label
from odometry.modes.identify.travel_power import travel_power
from odometry.modes.identify.turn_excitation import LEAST_EXCITATION, turn_excitation
from odometry.modes.identify.turning_range import turning_range
from odometry.modes.models.response import (
    Record,
    Response,
    errors_of,
    fitted_response,
    without_biases,
)
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import (
    BIAS_SIGMA_RAD_S,
    forward_speed_m_s,
    velocity_signals,
)
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import UNKNOWN, Run

LEAST_S = 10.0  # of a terrain
SPEED, OMEGA = range(2)  # rows of A and B, columns of a record
FOLLOWS_SIGMA = 0.05  # error [m/s] of a speed that only the wheels measure
FOLLOWING = 10.0 * np.array([[-1.0, 0.0, 0.5, 0.5], [0.0] * 4])  # which follows them in 0.1 s
CORRECTED_S = 2.0  # within which measurements correct the state of a model that is a little off


def identify_velocity_modes(
    runs: Sequence[Run],
    *,
    shared: bool = False,
    common_noise: bool = False,
    show_progress: bool = False,
) -> VelocityModes:
    """Identify A, B and the noise of each terrain that the runs name (Salvi 2024 eq. 2).

    Each row of eq. 2 is fitted by itself: what it answers to what was measured of the other
    quantity and to the treads, simulated over whole stretches. The gains of the yaw rate are found
    with a bias of the gyroscope on each stretch; their errors are those of gains without it, which
    differ from one drive to the next as much as a bias may.

    Parameters
    ----------
    runs : sequence of Run
        With a yaw rate; terrains as the runs name them.
    shared : bool
        One A and B for all terrains, which then differ in their noise alone (the paper's other
        approach).
    common_noise : bool
        The median noise for all terrains: then the response to the treads distinguishes them, and
        not how fast or how roughly the runs on each were driven.
    show_progress : bool

    Raises
    ------
    IdentificationError
        If a run names no terrain, less than 10 s of one are recorded, its runs go straight on or
        turn alike all the time, or the runs are of several robots.
    RunFolderError
        If a run has no yaw rate, or is there twice, whole or in part.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> on_gravel = replace(run, settings={**run.settings, "run": {"terrain": "gravel"}})
    >>> modes = odometry.identify_velocity_modes([on_gravel])
    >>> modes.names, modes.A.shape
    (('gravel',), (1, 2, 2))
    """
    track_width = robot_of(runs).track_width
    check_no_run_twice(runs)
    speeds = [forward_speed_m_s(run) for run in runs]
    records: dict[str, list[Record]] = {}
    pairs = zip(runs, speeds, strict=True)
    bar = tqdm(pairs, unit="run", total=len(runs), disable=None if show_progress else True)
    for run, speed in bar:
        for label, record in _records(run, speed):
            records.setdefault(label, []).append(record)
    _check(records, shared=shared)
    names = tuple(sorted(records))
    pooled = [record for name in names for record in records[name]]
    measured_rows = (OMEGA,) if any(speed is None for speed in speeds) else (SPEED, OMEGA)
    blocks = np.tile(FOLLOWING, (len(names), 1, 1))
    measurement = np.full((len(names), 2), FOLLOWS_SIGMA**2)
    lasting_s = []
    speed_power, spread = np.zeros((len(names), 2)), np.zeros(len(names))
    of_turns: dict[str, Response] = {}
    for place, name in enumerate(names):
        fitted = pooled if shared else records[name]
        for row in measured_rows:
            response = fitted_response(fitted, row)
            errors = errors_of(records[name], row, response)
            blocks[place, row] = response.row_of(row)
            measurement[place, row] = errors.variance
            lasting_s.append(errors.power / errors.variance)
            if row == SPEED:
                speed_power[place] = travel_power(records[name], row, response, by=OMEGA)
            else:
                spread[place] = gain_spread(records[name], row, response)
                of_turns[name] = response
                unbiased = without_biases(fitted, row, response, BIAS_SIGMA_RAD_S)
                blocks[place, row] = unbiased.row_of(row)
    if common_noise:
        measurement[:] = np.median(measurement, axis=0)
    process = measurement * np.median([record.step_s for record in pooled]) / CORRECTED_S**2
    errors_last_s = float(np.median(lasting_s))
    fastest_m_s = max(float(np.abs(record.table[:, 2:]).max()) for record in pooled)
    # one model for all errs on each terrain by what that differs from the others
    found = None if shared else turn_errors(records, OMEGA, of_turns)
    turn_spread, turn_power = found or (None, None)
    return VelocityModes(
        names,
        blocks[..., :2],
        blocks[..., 2:],
        process,
        measurement,
        errors_last_s,
        fastest_m_s,
        speed_power if SPEED in measured_rows else None,
        spread,
        turn_spread,
        turn_power,
        track_width,
        *turning_range(runs),
    )


def _check(records: Mapping[str, Sequence[Record]], *, shared: bool) -> None:
    for name, of in records.items():
        lasts_s = sum(record.lasts_s for record in of)
        if lasts_s < LEAST_S:
            raise IdentificationError(
                f"{name}: {lasts_s:.1f} s recorded, expected {LEAST_S:g} s or more"
            )
        # one alone is compared with none; of a shared model the runs of others determine the turns
        share = 1.0 if shared or len(records) == 1 else turn_excitation(of)
        if share < LEAST_EXCITATION:
            raise IdentificationError(
                f"{name}: its runs go straight on, or turn alike all the time: the difference of "
                f"the treads changes by {share:.1%} of their speed where it does not go with it, "
                f"expected {LEAST_EXCITATION:.0%} or more. By how much the treads turn the robot "
                "is not known: record turns of several radii to both sides, or leave them out"
            )


def _records(run: Run, speed: FloatArray | None) -> Iterable[tuple[str, Record]]:
    """Stretches of each terrain at even times; speed (N,) as measured."""
    signals = velocity_signals(run)
    if speed is None:
        speed = signals.tread_speeds_m_s.mean(axis=1)
    table = np.column_stack([speed, signals.measured[:, 1], signals.tread_speeds_m_s])
    step_s = float(np.median(np.diff(signals.stamps_s)))
    for label, rows in stretches_by_label(run, signals.labels):
        if label == UNKNOWN:
            raise IdentificationError(
                f"{run.folder}: rows {rows[0]} to {rows[-1]} of odometry.csv have no terrain; "
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
