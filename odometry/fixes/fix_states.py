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
# The best first; errors of single fixes are a hundred times as large, and a change is a jump
SOLUTIONS = (
    *("fix", "float", "ppp", "dgps", "sbas", "pps", "single"),
    *("simulated", "manual", "estimated"),
)
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


def lesser(found: FixFile, state: Named, kept: BoolArray) -> tuple[BoolArray, str]:
    """Rows (N,) of a lesser kind of solution than the most frequent one, and why they are left out.

    Of logs whose kinds are known: `state.says` is "solution".
    """
    if state.says != "solution":
        return np.zeros_like(kept), ""
    cells = np.array(found.cells[state.column])
    ranks = {kind: rank for rank, kind in enumerate(SOLUTIONS)}
    counts = Counter(cells[kept].tolist())
    usual = min(counts, key=lambda kind: (-counts[kind], ranks.get(kind, len(ranks))))
    worse = [kind for kind in counts if ranks.get(kind, len(ranks)) > ranks.get(usual, len(ranks))]
    words = " and ".join(f"{kind!r} in {counts[kind]}" for kind in worse)
    return np.isin(cells, worse) & kept, f"of a lesser kind than {usual!r} ({words})"


def kinds(found: FixFile, state: Named, kept: BoolArray) -> str:
    """How many rows have which kind of fix, where there are several; their errors differ."""
    cells = np.array(found.cells[state.column])[kept]
    counts = Counter(cells.tolist()).most_common()
    if not 1 < len(counts) <= MOST_KINDS:
        return ""
    words = ", ".join(f"{cell or 'empty'} in {count}" for cell, count in counts)
    return f"{state.column!r} is {words} rows: fixes of several kinds, whose errors differ"
