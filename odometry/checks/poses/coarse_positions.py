"""Positions that were rounded to a step, all along or in a part."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.poses.coarse_part import COARSE_M, CoarsePart, coarse_part
from odometry.checks.poses.map_lines import drawn_to_lines
from odometry.positions.rounding import steps_m


def coarse_positions(
    evidence: Evidence, stamps_s: FloatArray, positions: FloatArray
) -> Iterator[Finding]:
    """What steps the positions (M, 2) at stamps (M,) come in, or lines on which they lie."""
    if (part := coarse_part(evidence)) is not None:
        yield _of_part(evidence, part)
        return
    step_m = steps_m(stamps_s, positions).max()
    if step_m <= COARSE_M:
        return
    new = np.concatenate([[True], (np.diff(positions, axis=0) != 0).any(axis=1)])
    if drawn_to_lines(positions[new]):
        yield Finding(
            "positions_on_lines",
            Level.WARNING,
            "nearly each position has an x or a y of few values, and the other one is free",
            "Positions are drawn to the lines of a map (a network of roads or lanes)",
            "Record positions before they are matched to a map",
        )
    else:
        yield Finding(
            "coarse_positions",
            Level.WARNING,
            f"positions come in steps of {step_m:.3g} m",
            "Positions are rounded: single precision (float32) of large coordinates, or too few "
            "digits in the log; or they are drawn to the cells or the lines of a map",
            "Write positions in double precision, relative to the start; `run` and `batch` take "
            "the steps as noise",
        )


def _of_part(evidence: Evidence, part: CoarsePart) -> Finding:
    began_s = evidence.run.began_s
    when = part.span.words(began_s)
    return Finding(
        "coarse_positions",
        Level.WARNING,
        f"{when} positions come in steps of {part.step_m:.3g} m, and elsewhere they do not",
        f"{when[:1].upper()}{when[1:]} positions are rounded: single precision (float32) or fewer "
        "digits, of another node or receiver",
        "Write positions in double precision there, or leave these poses empty",
        (part.span.run_time_s(began_s, evidence.duration_s),),
    )
