"""Rows that repeat the stamp before and were dropped: copies, several sources, few digits."""

from collections.abc import Iterator

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.stamps.bursts import TWO_OF_EACH
from odometry.checks.stamps.stamps import tables_of
from odometry.tables.row_values import are_copies, take_turns
from odometry.tables.table import Table

FEW = 0.2  # share of the rows, up to which those that are left are of their times


def repeated_stamps(evidence: Evidence) -> Iterator[Finding]:
    """Rows that were dropped, and what their values say of the cause."""
    for name, table in tables_of(evidence.run).items():
        if table.repeated is not None:
            yield _finding(name, table, table.repeated_lines.tolist())


def _finding(name: str, table: Table, dropped: list[int]) -> Finding:
    rows = table.with_repeated()
    few = len(dropped) <= FEW * len(rows)
    copies = are_copies(table)
    cause, remedy = _cause(name, few=few, turns=take_turns(rows))
    if copies:
        cause, remedy = "Rows are written twice or more", "Nothing to do: the first ones were used"
    first = ", ".join(map(str, dropped[:3])) + (" ..." if len(dropped) > 3 else "")
    return Finding(
        "repeated_rows" if copies else "repeated_stamps",
        Level.NOTE if few or copies else Level.WARNING,
        f"{name} repeats the stamp{' and the values' * copies} of the row before in "
        f"{counted(len(dropped), 'row')} ({100 * len(dropped) / len(rows):.3g} %; row {first}), "
        "and they were dropped",
        cause,
        remedy,
    )


def _cause(file: str, *, few: bool, turns: bool) -> tuple[str, str]:
    """Cause and remedy where rows of one stamp differ, and are no steady sensor's."""
    if turns:
        return (
            "Rows of several sources are mixed (two topics, publishers or robots, commands beside "
            "measured speeds), of which the first was used: a row is nearer to one further up than "
            "to the one before",
            "Write the rows of one source alone, and check again",
        )
    if few:
        return "The logger wrote a stamp twice", "Nothing to do"
    others = TWO_OF_EACH * (file == "odometry.csv")
    left = "; the rows that are left are not of their times, so that delays were not judged"
    return (
        "Stamps have too few digits, or are those of arrival of rows that were sent several at "
        f"once, or two recordings were merged{others}" + left * (file != "images.csv"),
        "Write stamps with more digits, or one source alone, and check again",
    )
