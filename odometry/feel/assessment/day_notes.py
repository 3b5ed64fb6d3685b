"""Terrains that were recorded on days of their own: what distinguishes them may be the day."""

from collections.abc import Iterator, Sequence


def notes_of_days(labels: Sequence[str], days: Sequence[str] | None) -> Iterator[str]:
    """A sentence of terrains of whose days no other terrain has a run.

    Parameters
    ----------
    labels, days : sequence of str, length R
        Of each run, "" where it names no terrain; no days where they are not known.
    """
    if days is None:
        return
    runs = {(name, day) for name, day in zip(labels, days, strict=True) if name}
    shared = {name for name, day in runs for other, its in runs if its == day and other != name}
    alone = sorted({name for name, _ in runs} - shared)
    if alone:
        yield (
            f"No other terrain was recorded on the days of {', '.join(alone)}: load, tyres, "
            "mounting or weather of the day may be what distinguishes it, held out as well. Record "
            "two terrains on one day."
        )
