"""Rows of a steady sensor that came late by chance, at even stamps."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.stamps.timing import TOGETHER, lags_of
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.preparation.row_rates import EARLY_S
from odometry.recording.run import Run, with_stamps, with_table
from odometry.tables.late_rows import NEARLY_ALL, LateRows, late_rows

SIGMAS = 3.0  # of the lag beyond that


def with_even_rows(run: Run, config: IcrEkfConfig) -> tuple[Run, tuple[FilterEvent, ...]]:
    """The run with even stamps of odometry.csv and imu.csv: theirs are of arrival, or coarse.

    Rows that share a stamp are there again. See `odometry.tables.late_rows`. What is left, the
    delay of the rows that came fastest, is that by which poses with yaw then are too early against
    the gyroscope. Unless `config` is `causal` or does not watch its sensors; with an event for each
    file.
    """
    if config.causal or not config.watch_sensors:
        return run, ()
    late = {
        name: found
        for name in ("odometry", "imu")
        if (table := getattr(run, name)) is not None and (found := late_rows(table)) is not None
    }
    for name, rows in late.items():
        run = with_table(run, name, rows.at(rows.even_s))
    gyroscope, left_s = _left(run, late) if late and not config.pose_delay_s else ("", 0.0)
    events = []
    for name, rows in late.items():
        of_all_s = left_s if name == gyroscope else 0.0
        run = with_stamps(run, name, rows.even_s - of_all_s)
        events.append(_event(f"{name}.csv", rows, of_all_s))
    return run, tuple(events)


def _left(run: Run, late: dict[str, LateRows]) -> tuple[str, float]:
    """The table that has the gyroscope, and the delay of all of its rows by the poses' yaw."""
    evidence = Evidence(run)
    name = evidence.gyroscope_file.removesuffix(".csv")
    lag = lags_of(evidence).get(("pose", "gyroscope"))
    if name not in late or lag is None or lag.together < TOGETHER:
        return name, 0.0
    left_s = -lag.seconds - EARLY_S
    certain = left_s > SIGMAS * lag.sigma_s
    return name, left_s if certain and left_s < np.quantile(late[name].late_s, NEARLY_ALL) else 0.0


def _event(file: str, late: LateRows, of_all_s: float) -> FilterEvent:
    begin_s, end_s = late.rows.stamps_s[[0, -1]].tolist()
    left = f", {of_all_s:.2g} s by the yaw of poses, was undone" if of_all_s else " is not known"
    stamps = (
        f"stamps in steps of {late.step_s:g} s, which {late.at_once.max()} rows share at most: "
        if late.are_coarse
        else f"stamps of arrival, late by {late.late_s.mean():.2g} s in the mean "
        f"and {late.late_s.max():.2g} s at most beside even ones: "
    )
    text = (
        f"rows of {file} have {stamps}they were taken at even stamps; what all of them are late by"
        f"{left}"
    )
    return FilterEvent("late_rows", begin_s, end_s, text, (late.uneven_s, of_all_s))
