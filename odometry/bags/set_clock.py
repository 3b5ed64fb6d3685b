"""A clock that was set back while a bag was recorded: rows of two times have the same stamps."""

from collections.abc import Iterable
from dataclasses import dataclass

Row = tuple[float, ...]
LEAST_NS = 100_000_000  # of a clock that was set: rows out of order come later by less
LEAST_ROWS = 5  # in a row, each behind the one before
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

    Rows that come late are few in a row, or late by little: they are used. Five in a row with
    rising stamps, the first of them behind the latest stamp by 0.1 s and more, are of a clock that
    was set back; what follows up to the latest stamp would lie among the rows of another time.

    Attributes
    ----------
    found : list of SetBack
    """

    def __init__(self) -> None:
        self.found: list[SetBack] = []
        self._latest_ns = -(2**63)
        self._late: list[tuple[int, Row]] = []  # not yet decided
        self._is_set = False
        self._file_begins = True

    def begin_file(self) -> None:
        """Rows of another file come next: its first ones may be of the time of the one before."""
        self._file_begins = True

    def add(self, stamp_ns: int, row: Row) -> Iterable[tuple[int, Row]]:
        """Take in a row; those, in the order in which they came, that are to be used."""
        begins, self._file_begins = self._file_begins, False
        if stamp_ns >= self._latest_ns or begins:
            late = self.rest()
            self._latest_ns = max(stamp_ns, self._latest_ns) if not begins else stamp_ns
            return (*late, (stamp_ns, row))
        if self._is_set:
            return ()
        if self._late and stamp_ns <= self._late[-1][0]:
            return (*self.rest(), (stamp_ns, row))
        self._late.append((stamp_ns, row))
        by_ns = self._latest_ns - self._late[0][0]
        if by_ns < LEAST_NS:
            return self.rest()
        if len(self._late) == LEAST_ROWS:
            self.found.append(SetBack(self._latest_ns, by_ns))
            self._late, self._is_set = [], True
        return ()

    def rest(self) -> tuple[tuple[int, Row], ...]:
        """Rows that came late and are used, as no more follow."""
        late, self._late, self._is_set = tuple(self._late), [], False
        return late
