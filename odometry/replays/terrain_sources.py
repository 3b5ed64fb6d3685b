"""Sources of terrain for a replay: names by stamp, an earlier replay, what a run itself names."""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import RunFolderError
from odometry.estimation.estimate import Estimate
from odometry.estimation.kept_estimates import KeptEstimates
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_terrains import Footing


@dataclass(frozen=True)
class NamedTerrain:
    """The latest name at or before each frame; before the first name, the initial terrain.

    Attributes
    ----------
    initial : str
    stamps_s : (N,)
        From when on each name holds, rising.
    names : (N,) of str
    """

    initial: str
    stamps_s: FloatArray
    names: AnyArray

    @classmethod
    def of_answers(
        cls, initial: str, stamps_s: FloatArray, answers: AnyArray, silent: Sequence[str]
    ) -> "NamedTerrain":
        """From answers (N,); those in `silent` keep the terrain in force."""
        named = ~np.isin(answers.astype(str), list(silent))
        return cls(initial, stamps_s[named], answers[named])

    def terrain(self, frame: Frame, estimate: Estimate) -> str:  # noqa: ARG002 - the protocol's
        """The name in force at the stamp of the frame."""
        row = int(np.searchsorted(self.stamps_s, frame.stamp_s, side="right")) - 1
        return str(self.names[row]) if row >= 0 else self.initial


@dataclass(frozen=True)
class ReplayedFooting:
    """The terrain of an earlier replay: the latest footing at or before each frame.

    Attributes
    ----------
    estimates : sequence of Estimate
        Of that replay.
    """

    estimates: Sequence[Estimate]

    @property
    def initial(self) -> str:
        """The terrain at the first estimate."""
        return self.estimates[0].terrain

    @cached_property
    def _footings(self) -> tuple[list[float], list[Footing]]:
        """Stamps (n,) from which on the footing may be another one, and that footing."""
        kept = self.estimates
        if not isinstance(kept, KeptEstimates):
            kept = KeptEstimates(kept)
        stamps_s, footings = list[float](), list[Footing]()
        stretches = zip(kept.lasting("terrain"), kept.lasting("crossing"), strict=True)
        for (rows, terrain), (_, crossing) in stretches:
            first = slice(rows.start, rows.start + 1)
            stamps_s += kept.numbers("stamp_s", first).tolist()
            shares = None if crossing is None else crossing.shares
            footings.append(Footing.of(terrain) if shares is None else Footing(terrain, shares))
        return stamps_s, footings

    def terrain(self, frame: Frame, estimate: Estimate) -> Footing:  # noqa: ARG002 - the protocol's
        """The footing in force at the stamp of the frame."""
        stamps_s, footings = self._footings
        return footings[max(bisect_right(stamps_s, frame.stamp_s) - 1, 0)]


def labelled_terrain(run: Run, initial: str | None = None) -> NamedTerrain:
    """The terrain that the run itself names: what a source of terrain could do at best.

    Of truth.csv where that has a column `terrain`, else of odometry.csv. An empty label or
    `unknown` keeps the terrain in force.

    Parameters
    ----------
    run : Run
    initial : str, optional
        In force before the first label; by default the first label.

    Raises
    ------
    RunFolderError
        If neither file names a terrain.
    """
    for table in (run.truth, run.odometry):
        if table is None or "terrain" not in table:
            continue
        found = NamedTerrain.of_answers("", table.stamps_s, table["terrain"], ("", UNKNOWN))
        if len(found.names):
            return NamedTerrain(initial or str(found.names[0]), found.stamps_s, found.names)
    raise RunFolderError(
        f"{run.folder}: no column `terrain` of odometry.csv or truth.csv names a terrain; expected "
        "one where the run's own labels are the source of terrain"
    )
