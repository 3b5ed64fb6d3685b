"""What a receiver says of its fixes: rows without one, and kinds of them."""

from collections import Counter

import numpy as np

from odometry.arrays import BoolArray
from odometry.fixes.fix_columns import Named
from odometry.fixes.fix_file import FixFile, is_number

NO_FIX = frozenset({"v", "void", "no fix", "no_fix", "nofix", "invalid", "false"})
# The least number that is a fix: NavSatFix has -1 for none; receivers count kinds of fix with 2
# and 3 for two and three dimensions; NMEA's quality is 0 for none
LEAST = {"navsat": 0, "kind": 2, "quality": 1, "flag": 1}
MOST_KINDS = 6  # of fixes: a column with more is none of kinds
MOST_NAVSAT = 2  # of the status of NavSatFix: with larger numbers it is a kind of fix


def no_fix(found: FixFile, state: Named) -> BoolArray:
    """Rows (N,) of which a column says that there was no fix."""
    cells = found.cells[state.column]
    texts = [cell.lower() for cell in cells if not is_number(cell)]
    if any(texts):
        return np.array([cell.lower() in NO_FIX for cell in cells])
    values = found.numbers(state.column)
    kind = state.says
    if kind == "navsat" and np.nanmax(values, initial=0) > MOST_NAVSAT:
        kind = "kind"
    return np.asarray(values < LEAST.get(kind, 0))


def kinds(found: FixFile, state: Named, kept: BoolArray) -> str:
    """How many rows have which kind of fix, where there are several; their errors differ."""
    cells = np.array(found.cells[state.column])[kept]
    counts = Counter(cells.tolist()).most_common()
    if not 1 < len(counts) <= MOST_KINDS:
        return ""
    words = ", ".join(f"{cell or 'empty'} in {count}" for cell, count in counts)
    return f"{state.column!r} is {words} rows: fixes of several kinds, whose errors differ"
