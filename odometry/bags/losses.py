"""What could not be read, in sentences."""

from collections.abc import Iterable

MOST = 30


class Losses:
    """Sentences in their order; a badly damaged bag has thousands, of which the first are kept."""

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self._lines: list[str] = []
        self._more = 0
        self += lines

    def append(self, line: str) -> None:
        """Add a sentence."""
        if len(self._lines) < MOST:
            self._lines.append(line)
        else:
            self._more += 1

    def __iadd__(self, lines: Iterable[str]) -> "Losses":
        for line in lines:
            self.append(line)
        return self

    @property
    def lines(self) -> tuple[str, ...]:
        """The sentences that are kept, and how many more there were."""
        more = (f"and {self._more} more losses of such kinds",) if self._more else ()
        return (*self._lines, *more)
