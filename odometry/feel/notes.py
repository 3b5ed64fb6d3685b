"""What is to be known of a model beside its figures."""

from collections.abc import Iterator, Sequence
from itertools import combinations

import numpy as np

from odometry.feel.table import FeelTable
from odometry.feel.windows import FeelWindows

FEW_RUNS = 3  # of a terrain
SPEED_SHARE = (0.1, 0.9)  # quantiles between which speeds of a terrain lie
OVERLAP = 0.0  # of these ranges: without any, terrains may differ by speed alone


def notes_of(table: FeelTable, windows: Sequence[FeelWindows], *, by_day: bool) -> tuple[str, ...]:
    """Sentences: columns that only some runs have, few runs, speeds that do not overlap."""
    return tuple(_notes(table, windows, by_day=by_day))


def _notes(table: FeelTable, windows: Sequence[FeelWindows], *, by_day: bool) -> Iterator[str]:
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
                "driven at different speeds: what tells them apart may be the speed."
            )
    if not by_day:
        yield "Runs are held out one by one, not by day: runs of one day may be alike."


def _range(of: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> str:
    return f"{of[0]:.2f} to {of[1]:.2f}"
