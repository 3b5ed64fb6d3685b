"""Estimates of a run on disk, so that a long run takes no more memory than a short one."""

import weakref
from collections.abc import Iterable, Iterator, Sequence
from tempfile import TemporaryFile
from typing import Any, NamedTuple, overload

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate, Innovation
from odometry.estimation.noise_scale import NoiseScale
from odometry.estimation.transition import STATES
from odometry.io.files import naming_temporary

BLOCK = 256  # estimates that are written together, each number beside its own kind
SIZES = {
    "stamp_s": 1,
    "mean": STATES,
    "variances": STATES,
    "covariance": STATES**2,
    "tread_speeds_m_s": 2,
    "yaw_rate_rad_s": 1,
    "believed_yaw_rate_rad_s": 1,
    "added_speeds_m_s": 2,
    "added_twist": 3,
    "jumped": 1,
    "measured": 1,  # numbers of the innovation; NaN where there is none
    "residual": 3,
    "normalised_squared": 1,
    "accepted": 1,
}
ENDS = np.cumsum(list(SIZES.values())).tolist()
PLACES = {
    name: slice(end - size, end) for (name, size), end in zip(SIZES.items(), ENDS, strict=True)
}
WIDTH = ENDS[-1]
EVERY = slice(None)


class _Lasting(NamedTuple):
    """What seldom changes from estimate to estimate, see `Estimate`."""

    terrain: str
    learned: Any
    crossing: Any
    course: Any
    events: Any


class KeptEstimates(Sequence[Estimate]):
    """A sequence of estimates whose numbers lie in a file that ends with the program.

    What a filter only carries on (`watch`, `scale`, `recent`, `refused`) is kept of the last alone.
    """

    def __init__(self, estimates: Iterable[Estimate] = ()) -> None:
        self._file = TemporaryFile()  # noqa: SIM115 - open as long as the sequence
        weakref.finalize(self, self._file.close)
        self._unwritten = np.empty((BLOCK, WIDTH))
        self._count = 0
        self._lasting: list[tuple[int, _Lasting]] = []
        self._last: Estimate | None = None
        for estimate in estimates:
            self.append(estimate)

    def append(self, estimate: Estimate) -> None:
        """Add the next estimate."""
        _write(self._unwritten[self._count % BLOCK], estimate)
        self._last = estimate
        self._note(estimate, self._count)
        self._count += 1
        if self._count % BLOCK == 0:
            with naming_temporary():
                self._file.write(self._unwritten.T.tobytes())

    def end_with(self, last: Estimate) -> None:
        """Put an estimate with other events in place of the last."""
        self._last = last
        self._note(last, self._count - 1)

    def numbers(self, name: str, rows: slice = EVERY, columns: slice = EVERY) -> FloatArray:
        """One of `SIZES` of all estimates or some rows of them, (N,) or (N, columns)."""
        begin, end, _ = rows.indices(self._count)
        first, last, _ = columns.indices(SIZES[name])
        place = slice(PLACES[name].start + first, PLACES[name].start + last)
        found = np.empty((max(end - begin, 0), last - first))
        for start in range(begin - begin % BLOCK, end, BLOCK):
            some = slice(max(begin, start), min(end, start + BLOCK))
            numbers = self._read(start, place)[:, some.start - start : some.stop - start]
            found[some.start - begin : some.stop - begin] = numbers.T
        return found[:, 0] if SIZES[name] == 1 else found

    def lasting(self, name: str) -> Iterator[tuple[range, Any]]:
        """Stretches of estimates with one terrain, learned, crossing, course or events."""
        ends = [first for first, _ in self._lasting[1:]] + [self._count]
        for (first, lasting), end in zip(self._lasting, ends, strict=True):
            yield range(first, end), getattr(lasting, name)

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, index: int) -> Estimate: ...
    @overload
    def __getitem__(self, index: slice) -> list[Estimate]: ...
    def __getitem__(self, index: int | slice) -> Estimate | list[Estimate]:
        if isinstance(index, slice):
            return [self[place] for place in range(*index.indices(self._count))]
        place = range(self._count)[index]
        if place == self._count - 1 and self._last is not None:
            return self._last
        row = self._read(place - place % BLOCK, slice(0, WIDTH))[:, place % BLOCK]
        after = np.searchsorted([first for first, _ in self._lasting], place, side="right")
        return _estimate(row, self._lasting[int(after) - 1][1])

    def __iter__(self) -> Iterator[Estimate]:
        stretches = iter([*self._lasting[1:], (self._count, None)])
        lasting, (until, after) = self._lasting[0][1] if self._lasting else None, next(stretches)
        for start in range(0, self._count, BLOCK):
            rows = self._read(start, slice(0, WIDTH)).T[: self._count - start]
            for place, row in enumerate(np.ascontiguousarray(rows), start):
                if place == until and after is not None:
                    lasting, (until, after) = after, next(stretches)
                if place == self._count - 1 and self._last is not None:
                    yield self._last
                elif lasting is not None:
                    yield _estimate(row, lasting)

    def __reduce__(self) -> tuple[Any, ...]:
        return KeptEstimates, (list(self),)

    def _note(self, estimate: Estimate, place: int) -> None:
        lasting = _Lasting(
            estimate.terrain,
            estimate.learned,
            estimate.crossing,
            estimate.course,
            estimate.events,
        )
        if self._lasting and self._lasting[-1][0] == place:
            self._lasting.pop()
        if not self._lasting or not _alike(self._lasting[-1][1], lasting):
            self._lasting.append((place, lasting))

    def _read(self, start: int, numbers: slice) -> FloatArray:
        """Some numbers (size, BLOCK) of the block that starts at an estimate."""
        if start + BLOCK > self._count:
            return self._unwritten.T[numbers]
        size = numbers.stop - numbers.start
        self._file.seek((start * WIDTH + numbers.start * BLOCK) * 8)
        found = np.frombuffer(self._file.read(size * BLOCK * 8)).reshape(size, BLOCK)
        self._file.seek(0, 2)
        return found


def _alike(one: _Lasting, other: _Lasting) -> bool:
    return (
        one.terrain == other.terrain
        and one.learned is other.learned
        and one.crossing is other.crossing
        and one.course is other.course
        and not one.events
        and not other.events
    )


def _write(row: FloatArray, estimate: Estimate) -> None:
    row.fill(np.nan)
    for name in ("mean", "tread_speeds_m_s", "added_speeds_m_s", "added_twist"):
        row[PLACES[name]] = getattr(estimate, name)
    for name in ("stamp_s", "yaw_rate_rad_s", "believed_yaw_rate_rad_s", "jumped"):
        row[PLACES[name].start] = getattr(estimate, name)
    row[PLACES["variances"]] = estimate.covariance.diagonal()
    row[PLACES["covariance"]] = estimate.covariance.ravel()
    if estimate.innovation is not None:
        residual, squared, accepted = estimate.innovation
        first = PLACES["residual"].start
        row[PLACES["measured"]] = len(residual)
        row[first : first + len(residual)] = residual
        row[PLACES["normalised_squared"]], row[PLACES["accepted"]] = squared, accepted


def _estimate(row: FloatArray, lasting: _Lasting) -> Estimate:
    of = {name: row[place] for name, place in PLACES.items()}
    innovation = None
    if not np.isnan(of["measured"][0]):
        residual = of["residual"][: int(of["measured"][0])].copy()
        squared, accepted = float(of["normalised_squared"][0]), bool(of["accepted"][0])
        innovation = Innovation(residual, squared, accepted)
    return Estimate(
        stamp_s=float(of["stamp_s"][0]),
        mean=of["mean"].copy(),
        covariance=of["covariance"].reshape(STATES, STATES).copy(),
        tread_speeds_m_s=of["tread_speeds_m_s"].copy(),
        terrain=lasting.terrain,
        yaw_rate_rad_s=float(of["yaw_rate_rad_s"][0]),
        believed_yaw_rate_rad_s=float(of["believed_yaw_rate_rad_s"][0]),
        added_speeds_m_s=of["added_speeds_m_s"].copy(),
        added_twist=of["added_twist"].copy(),
        innovation=innovation,
        jumped=bool(of["jumped"][0]),
        learned=lasting.learned,
        crossing=lasting.crossing,
        scale=NoiseScale(),
        course=lasting.course,
        events=lasting.events,
    )
