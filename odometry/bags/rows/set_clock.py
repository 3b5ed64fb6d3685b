"""A clock that was set back while a bag was recorded: rows of two times have the same stamps."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Row = tuple[float, ...]
LEAST_NS, LEAST_ROWS = 100_000_000, 5  # of a clock that was set
MOST_ROWS = 10_000  # in a row behind the latest stamp: no row merely comes so late
IN_ORDER = 0.9  # share of them that lie behind the one before
PACE = 1.5  # of the usual one, at most, at which their stamps rise
NEAR = 1 / 4  # of the way back is left when the latest stamp is passed, or less
SAME_NS = 2_000_000_000  # topics whose clock was set at times that differ by less: one event


@dataclass(frozen=True)
class SetBack:
    """A clock that was set back.

    Attributes
    ----------
    at_ns : int
        The last stamp before.
    by_ns : int
        How far the next stamp is behind it.
    """

    at_ns: int
    by_ns: int


class SetClock:
    """Parts rows that come late from rows behind a clock that was set back, which are left out.

    Where a clock is set back, all rows that follow lie behind the latest stamp, until theirs have
    come up to it: they would lie among rows of another time. Rows that merely come late are fewer,
    in no order, farther apart, or the next in time comes before they have come near.

    Attributes
    ----------
    found : list of SetBack
    left_out : int
        Rows.
    """

    def __init__(self) -> None:
        self.found: list[SetBack] = []
        self.left_out = 0
        self._count, self._first_ns, self._latest_ns = 0, 2**63, -(2**63)
        self._late: list[tuple[int, Row]] = []  # not yet decided
        self._is_set = False
        self._file_begins = True

    def begin_file(self) -> None:
        """Rows of another file come next, which may be of the time of the one before."""
        self._file_begins = True

    def add(self, stamp_ns: int, row: Row) -> Iterable[tuple[int, Row]]:
        """Take in a row; those, in the order in which they came, that are to be used."""
        self._count += 1
        if stamp_ns >= self._latest_ns or self._file_begins:
            self._first_ns = min(self._first_ns, stamp_ns)
            used = (*self._decided(), (stamp_ns, row))
            self._latest_ns, self._file_begins, self._is_set = stamp_ns, False, False
            return used
        if self._is_set:
            self.left_out += 1
            return ()
        self._late.append((stamp_ns, row))
        return self.rest() if len(self._late) == MOST_ROWS else ()

    def rest(self) -> tuple[tuple[int, Row], ...]:
        """Rows that are to be used, where the time before them does not come again."""
        return self._decided(comes_near=True)

    def _decided(self, *, comes_near: bool = False) -> tuple[tuple[int, Row], ...]:
        """Rows that came late, without those behind a clock that was set back."""
        late, self._late = tuple(self._late), []
        if len(late) < LEAST_ROWS:
            return late
        stamps_ns = np.array([stamp_ns for stamp_ns, _ in late])
        by_ns = self._latest_ns - late[0][0]
        near = comes_near or self._latest_ns - stamps_ns.max() <= NEAR * by_ns
        period_ns = (self._latest_ns - self._first_ns) / max(self._count - len(late), 1)
        at_pace = np.ptp(stamps_ns) <= PACE * period_ns * len(late)
        in_order = np.mean(np.diff(stamps_ns) > 0) >= IN_ORDER
        if by_ns < LEAST_NS or not (near and at_pace and in_order):
            return late
        self.found.append(SetBack(self._latest_ns, by_ns))
        self.left_out += len(late)
        self._is_set = True
        return ()


def set_back_table(clocks: Mapping[str, SetClock]) -> list[dict[str, Any]]:
    """`clock_set_back` of the table [source]: stamp and size in seconds, and the topics."""
    apart: list[tuple[SetBack, dict[str, None]]] = []
    for topic, clock in clocks.items():
        for one in clock.found:
            near = [topics for of, topics in apart if abs(of.at_ns - one.at_ns) < SAME_NS]
            if near:
                near[0][topic] = None
            else:
                apart.append((one, {topic: None}))
    return [
        {"t": one.at_ns / 1e9, "by": one.by_ns / 1e9, "topics": list(topics)}
        for one, topics in apart
    ]
