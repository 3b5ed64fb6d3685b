"""Stamps that run at another pace than time: a replay, rows that were numbered, minutes.

All rates that are integrated over such stamps are wrong by one factor: the turn of the gyroscope
and the travel of the treads, while poses keep their turns and distances.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.unit_tables import ORDINARY_FORWARD
from odometry.recording.run import Run

LEAST = 1.4  # factor: nearer ones may be the gyroscope's and the wheels' own
ALIKE = (0.6, 1.2)  # metres for each metre of the treads, with the pace undone
TIGHT = 0.9  # share of the turns explained, or correlation
SHORT_S = 12.0  # a drive in so many seconds leaves too few windows for that
MINUTES = 20.0  # times faster than the treads, that positions move then
MINUTE_S = 60.0


def stamp_pace(evidence: Evidence) -> Iterator[Finding]:
    """One factor in the turns of the gyroscope and in the travel of the treads."""
    yield from _minutes(evidence)
    turns, along = evidence.pose_turn_by_gyroscope, evidence.metres_per_metre
    if turns is None or not turns.certain() or turns.explained < TIGHT or along is None:
        return
    pace = 1 / abs(turns.slope)  # of the stamps' seconds in one second
    odd = not 1 / LEAST < pace < LEAST and not 1 / LEAST < ORDINARY_FORWARD / along < LEAST
    if not odd or not ALIKE[0] < along * pace < ALIKE[1]:
        return
    yield Finding(
        "stamp_pace",
        Level.WARNING,
        f"gyro_z turns {pace:.3g} times as far as the poses, and the treads travel "
        f"{1 / along:.3g} times as far",
        f"Stamps run {1 / pace:.3g} times as fast as time (a replay at another speed, "
        "rows that were numbered at a rate which is not theirs)",
        f"Divide the stamps of all files by {pace:.3g}; compare the duration with a watch",
        mend=lambda run: _at_pace(run, 1 / pace),
    )


def _minutes(evidence: Evidence) -> Iterator[Finding]:
    """A drive of a few seconds in which positions race and treads do not."""
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or used.sum() < 20 or evidence.duration_s > SHORT_S:
        return
    steps_m = np.hypot(*np.diff(pose.stack("x", "y")[used], axis=0).T)
    speed_m_s = float(np.quantile(steps_m / np.diff(pose.stamps_s[used]), 0.9))
    if evidence.fastest_m_s <= 0 or speed_m_s < MINUTES * evidence.fastest_m_s:
        return
    yield Finding(
        "stamp_pace",
        Level.WARNING,
        f"positions move at {speed_m_s:.3g} m/s, the treads at {evidence.fastest_m_s:.3g} m/s, for "
        f"{evidence.duration_s:.3g} s",
        "Stamps are in minutes, not seconds; or positions are in cm or mm",
        "Convert the column t of all files to seconds",
        mend=lambda run: _at_pace(run, MINUTE_S),
    )


def _at_pace(run: Run, factor: float) -> Run:
    """A run whose stamps count at another pace from where they begin."""
    begin_s = float(run.odometry.stamps_s[0])
    tables = {
        name: replace(
            table,
            columns={**table.columns, "t": begin_s + factor * (table.stamps_s - begin_s)},
        )
        for name in ("odometry", "imu", "pose", "velocity", "images", "truth")
        if (table := getattr(run, name)) is not None
    }
    return replace(run, **tables)
