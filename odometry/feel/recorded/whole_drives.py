"""Recordings that are parts of one drive, as the files of one bag are: no test of each other."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.feel.recorded.windows import FeelWindows
from odometry.recording.run import UNKNOWN, Run

PAUSE_S = 10.0  # between parts: within it a robot is brought to no other place
OVERLAP_S = 1.0  # of parts, whose messages are late by unlike times


@dataclass(frozen=True)
class WholeDrives:
    """Which runs count as one.

    Attributes
    ----------
    numbers : (R,)
        Of the drive that each run is a part of.
    of_one : tuple of str
        Terrains of which all runs are parts of one drive; these count as runs all the same.
    """

    numbers: IntArray
    of_one: tuple[str, ...]

    def __len__(self) -> int:
        return len(np.unique(self.numbers))

    @property
    def first(self) -> IntArray:
        """The place of the first part of each drive."""
        return np.asarray(np.unique(self.numbers, return_index=True)[1])

    def notes(self) -> Iterator[str]:
        """Sentences of terrains that were felt on one drive, and of runs that count as one."""
        for name in self.of_one:
            yield (
                f"All runs of {name} are parts of one drive, each going on where another ends: how "
                "it feels on another drive is not known. Figures and probabilities are too good; "
                "record it once more, at another place."
            )
        if len(self) < len(self.numbers):
            yield (
                f"{len(self.numbers)} runs count as {len(self)}: some go on where another ends, as "
                "the files of one recording do, and are no test of each other."
            )


def whole_drives(runs: Sequence[Run], windows: Sequence[FeelWindows]) -> WholeDrives:
    """Parts of one drive count as one run where each of their terrains has a second drive.

    Parts are cut from one folder, or follow each other: by their stamps one begins at most PAUSE_S
    after the end of another.
    """
    numbers = drive_numbers(runs)
    terrains = [set(one.labels[one.felt].tolist()) - {UNKNOWN} for one in windows]
    pairs = zip(numbers.tolist(), terrains, strict=True)
    drives = Counter(name for name, _ in {(name, of) for of, names in pairs for name in names})
    counts = Counter(name for names in terrains for name in names)
    of_one = {name for name, count in drives.items() if count == 1 < counts[name]}
    for place, names in enumerate(terrains):
        if names & of_one:
            numbers[place] = len(runs) + place
    return WholeDrives(np.unique(numbers, return_inverse=True)[1], tuple(sorted(of_one)))


def drive_numbers(runs: Sequence[Run]) -> IntArray:
    """The same number (R,) for all parts of a drive.

    Stamps of one clock do not overlap. Where runs that go on where another ends do, every drive
    began at 0, and which parts belong together is not known but for those of one folder.
    """
    spans_s = np.array([run.odometry.stamps_s[[0, -1]] for run in runs])
    pauses_s = spans_s[:, None, 0] - spans_s[None, :, 1]
    pauses_s = np.maximum(pauses_s, pauses_s.T)  # below 0 where two overlap
    folders = np.array([str(run.folder.resolve()) for run in runs])
    apart = pauses_s >= -OVERLAP_S
    of_folder = (folders[:, None] == folders) & apart
    numbers = _connected(of_folder)
    together = _connected(of_folder | (apart & (pauses_s <= PAUSE_S)))
    for number in np.unique(together):
        of = np.flatnonzero(together == number)
        if (apart[np.ix_(of, of)] | np.eye(len(of), dtype=np.bool_)).all():
            numbers[of] = of[0]
    return numbers


def _connected(linked: BoolArray) -> IntArray:
    """The least place (R,) that is linked (R, R) with each, over others as well."""
    numbers = np.arange(len(linked))
    for first, second in np.argwhere(np.triu(linked, 1)).tolist():
        low, high = sorted((numbers[first], numbers[second]))
        numbers[numbers == high] = low
    return numbers
