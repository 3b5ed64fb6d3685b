"""The table of the gap study: shares with 95 % intervals, by kind, by group and over all."""

from collections.abc import Mapping, Sequence

import numpy as np

Row = Mapping[str, str]
SCORES = ("right", "acceptable", "wrong", "unknown", "none", "failed")
Z_95 = 1.959964


def table_of(rows: Sequence[Row]) -> list[str]:
    """Lines of Markdown: each kind, each group, and all."""
    heads = ("kind", "cases", *SCORES, "all named", "course", "worse", "closed", "CPU s, most")
    lines = [heads, ["---"] * len(heads)]
    for group in dict.fromkeys(row["group"] for row in rows):
        of_group = [row for row in rows if row["group"] == group]
        kinds = dict.fromkeys(row["kind"] for row in of_group)
        by_kind = [[row for row in of_group if row["kind"] == kind] for kind in kinds]
        lines += [cells(of[0]["kind"], of, short=True) for of in by_kind]
        lines.append(cells(f"**{group}**", of_group))
    lines.append(cells("**all**", rows))
    return [f"| {' | '.join(line)} |" for line in lines]


def mistakes_of(rows: Sequence[Row]) -> list[str]:
    """A line for each wrong name, each name with a worse held-out gap and each failure."""
    bad = [row for row in rows if row["score"] in ("wrong", "failed") or row["worse"] == "1"]
    return [
        f"{row['kind']} {row['seed']}: {row['score']}, {row['verdict']} ({row['effects']}) for "
        f"{row['true'] or 'none'}, gap {row['before']} to {row['after']} {row['error']}".rstrip()
        for row in bad
    ]


def cells(name: str, rows: Sequence[Row], *, short: bool = False) -> list[str]:
    """One line; the intervals are left out where it is `short`."""
    share = _percent if short else with_interval
    counts = [share(sum(row["score"] == score for row in rows), len(rows)) for score in SCORES]
    judged = [row for row in rows if row["score"] != "failed"]
    named = [row for row in judged if row["effects"]]
    timed = [row for row in named if row["course"]]
    return [
        name,
        f"{len(rows)}",
        *counts,
        share(sum(row["all_named"] == "1" for row in judged), len(judged)),
        share(sum(row["course_right"] == "1" for row in timed), len(timed)),
        share(sum(row["worse"] == "1" for row in named), len(named)),
        closed(judged),
        cpu(rows),
    ]


def with_interval(count: int, of: int) -> str:
    """Share with Wilson's 95 % interval, in percent."""
    if of == 0:
        return "-"
    share, more = count / of, Z_95**2 / of
    middle = (share + more / 2) / (1 + more)
    half = Z_95 * np.sqrt(share * (1 - share) / of + more / (4 * of)) / (1 + more)
    low, high = max(middle - half, 0.0), min(middle + half, 1.0)
    return f"{100 * share:.0f} ({100 * low:.0f} to {100 * high:.0f})"


def closed(rows: Sequence[Row]) -> str:
    """Median of the share of the excess closed, of all and of those that are unknown."""
    shares = [float(row["closed"]) for row in rows if row["closed"]]
    unknown = [
        float(row["closed"]) for row in rows if row["closed"] and row["verdict"] == "unknown"
    ]
    words = _median(shares)
    return f"{words}; unknown {_median(unknown)}" if unknown else words


def cpu(rows: Sequence[Row]) -> str:
    """Median and most seconds."""
    seconds = [float(row["cpu_s"]) for row in rows if row["cpu_s"]]
    return f"{np.median(seconds):.0f}, {max(seconds):.0f}" if seconds else "-"


def _median(shares: Sequence[float]) -> str:
    """Median, and its 95 % interval by resampling where there are enough."""
    if not shares:
        return "-"
    words = f"{np.median(shares):.2f}"
    if len(shares) < 10:
        return words
    draws = np.random.default_rng(0).choice(shares, (1000, len(shares)))
    low, high = np.quantile(np.median(draws, axis=1), [0.025, 0.975])
    return f"{words} ({low:.2f} to {high:.2f})"


def _percent(count: int, of: int) -> str:
    return f"{100 * count / of:.0f}" if of else "-"
