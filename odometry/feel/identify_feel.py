"""Identify how terrains feel, how well they are distinguished on runs held out, and notes of it."""

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.config import require
from odometry.errors import IdentificationError
from odometry.feel.assessment.assessment import assessed, choice_words
from odometry.feel.assessment.day_notes import notes_of_days
from odometry.feel.assessment.doubted_runs import notes_of_doubted
from odometry.feel.assessment.selection import main_labels, selected
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.members import fitted_members
from odometry.feel.classifier.sensor import SensorShape
from odometry.feel.classifier.table import FeelTable, days_of, fold_groups
from odometry.feel.model import FeelModel
from odometry.feel.recorded.whole_drives import WholeDrives, whole_drives
from odometry.feel.recorded.windows import LONGEST_S, SHORTEST_S, FeelWindows, feel_windows
from odometry.identification.identify import robot_of
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import Run

LEAST_RUNS = 2  # of a terrain: one to fit, one to hold out
LEAST_WINDOWS = 5  # of a terrain and run on the average


def identify_feel(
    runs: Sequence[Run], *, window_s: float | Sequence[float] = 2.0, seed: int = 0
) -> FeelModel:
    """Identify how the terrains that runs name feel on one robot.

    Log power of bands of the IMU's axes, yaw response and motor currents of windows, whichever all
    runs have; the effect of speed is taken out; shrunk linear discriminants and a logistic
    regression. Shrinkage, what evidence is worth, and from where on nothing known fits are found
    on runs held out, and the figures of `report` on runs that all of that never saw.

    Parameters
    ----------
    runs : sequence of Run
        Of one robot; two or more on each terrain. Parts of one drive count as one, where each of
        their terrains has another drive, and else a note says so.
    window_s : float or sequence of float
        1 to 5 s; of several the one that is best on runs held out.
    seed : int
        Of the folds.

    Raises
    ------
    IdentificationError
        If fewer than two terrains are named, a terrain has fewer than two runs, or next to none of
        the time was driven.
    RunFolderError
        If a run lacks the signals (see `feel_signals`), or is there twice, whole or in part.

    Examples
    --------
    >>> from dataclasses import replace
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> parts = [odometry.cut_run(run, odometry.Span(9.0 * i, 9.0 * i + 9.0)) for i in range(6)]
    >>> named = [
    ...     replace(part, settings={**part.settings, "run": {"terrain": name}})
    ...     for part, name in zip(parts, ["gravel", "grass"] * 3)
    ... ]
    >>> model = odometry.identify_feel(named)
    >>> model.names, model.design.columns
    (('grass', 'gravel'), ('gyro_z',))
    """
    lengths_s = (window_s,) if isinstance(window_s, (int, float)) else tuple(window_s)
    for one in lengths_s:
        require(
            SHORTEST_S <= one <= LONGEST_S,
            f"window_s = {one}, expected {SHORTEST_S:g} to {LONGEST_S:g}",
        )
    robot = robot_of(runs)
    check_no_run_twice(runs)
    windows = [[feel_windows(run, one) for run in runs] for one in lengths_s]
    drives = whole_drives(runs, windows[0])
    tables = [_table(of, drives.numbers) for of in windows]
    labels = main_labels(tables[0], len(drives))
    days = days_of([runs[place] for place in drives.first])
    groups = fold_groups(labels.tolist(), days)
    found = assessed(tables, groups, seed)
    everyone = np.ones(len(drives), dtype=bool)
    best = selected(tables, groups, everyone, np.random.default_rng(seed))
    table = tables[best.place]
    by_day = len(np.unique(groups)) < len(drives)
    names = [runs[place].name for place in drives.first]
    notes = (
        *drives.notes(),
        *notes_of_doubted(found, names),
        *notes_of_days(labels.tolist(), days),
        *notes_of(table, windows[best.place], drives, by_day=by_day),
    )
    return FeelModel(
        table.names,
        table.design,
        best.choice,
        fitted_members(table, everyone, table.names, [best.choice])[0],
        best.calibration,
        best.strangeness,
        best.limits,
        SensorShape.of(windows[best.place], table.design, drives.numbers),
        robot.track_width,
        robot.name,
        ", ".join(dict.fromkeys(run.name for run in runs)),
        {
            **found.to_table(),
            "chosen": choice_words(table.design.window_s, best.choice),
            "held_out": "days" if by_day else "runs",
            "one_drive": list(drives.of_one),
            "notes": list(notes),
        },
        max(one.most_repeats(table.design.axes) for one in windows[best.place]),
    )


def _table(windows: Sequence[FeelWindows], numbers: IntArray) -> FeelTable:
    design = Design.shared(windows)
    if not design.groups:
        raise IdentificationError("the runs have no column in common that terrain is felt by")
    table = FeelTable.of(windows, design, numbers)
    _check(table, windows)
    return table


def _check(table: FeelTable, windows: Sequence[FeelWindows]) -> None:
    if len(table) == 0 or len(table.names) < 2:
        driven = f"{len(table)} windows in which the robot moves on a terrain that a run names"
        raise IdentificationError(
            f"{driven}, of {', '.join(table.names) or 'no terrain'}; expected two terrains or more"
        )
    for name in table.names:
        of = table.labels == name
        count = len(np.unique(table.runs[of]))
        if count < LEAST_RUNS:
            raise IdentificationError(
                f"{name}: {count} run of {len(windows)}, expected {LEAST_RUNS} or more: windows "
                "of one run are no test of each other"
            )
        if of.sum() < LEAST_WINDOWS * count:
            raise IdentificationError(
                f"{name}: {of.sum()} windows in {count} runs, expected {LEAST_WINDOWS} a run or "
                "more"
            )


FEW_RUNS = 3  # of a terrain
SPEED_SHARE = (0.1, 0.9)  # quantiles between which speeds of a terrain lie
RATES_APART = 1.1  # times: sampling rates of one sensor differ by less
OVERLAP = 0.0  # of these ranges: without any, terrains may differ by speed alone


def notes_of(
    table: FeelTable, windows: Sequence[FeelWindows], drives: WholeDrives, *, by_day: bool
) -> Iterator[str]:
    """Sentences: columns that some runs lack, few runs, speeds and rates that do not overlap."""
    used = set(table.design.axes) | set(table.design.motion)
    for name in sorted({n for one in windows for n in (*one.axes, *one.motion)} - used):
        lack = [one.run_name for one in windows if name not in (*one.axes, *one.motion)]
        where = f"{', '.join(lack[:3])} lacks it" if lack else "it carries no band"
        yield f"{name} is not used: {where}."
    for name in table.names:
        count = len(np.unique(table.runs[table.labels == name]))
        if count < FEW_RUNS:
            yield f"{name} has {count} runs: its figures are uncertain."
    ranges = {
        name: np.quantile(table.speeds_m_s[table.labels == name], SPEED_SHARE)
        for name in table.names
    }
    for one, other in combinations(table.names, 2):
        apart = max(ranges[one][0], ranges[other][0]) - min(ranges[one][1], ranges[other][1])
        if apart > OVERLAP:
            yield (
                f"{one} ({_range(ranges[one])} m/s) and {other} ({_range(ranges[other])} m/s) were "
                "driven at different speeds: what distinguishes them may be the speed."
            )
    yield from _of_rates(table, np.array([2 * windows[place].top_hz for place in drives.first]))
    if not by_day:
        yield "Runs are held out one by one, not by day: runs of one day may be correlated."


def _of_rates(table: FeelTable, rates_hz: FloatArray) -> Iterator[str]:
    """Terrains all of whose runs (of rates (n,)) were sampled at rates that no other has."""
    for name in table.names:
        of = table.labels == name
        own, others = (rates_hz[np.unique(table.runs[rows])] for rows in (of, ~of))
        if own.max() * RATES_APART < others.min() or others.max() * RATES_APART < own.min():
            yield (
                f"All runs of {name} were sampled {_rates(own)} times a second, those of other "
                f"terrains {_rates(others)} times: another IMU or its filter may be what "
                "distinguishes it, held out as well."
            )


def _rates(of: FloatArray) -> str:
    return " to ".join(dict.fromkeys(f"{one:.0f}" for one in (of.min(), of.max())))


def _range(of: FloatArray) -> str:
    return f"{of[0]:.2f} to {of[1]:.2f}"
