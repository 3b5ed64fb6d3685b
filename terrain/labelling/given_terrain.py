"""The terrain that a recording or its owner gives: by time or by image."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import RunFolderError
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_terrains import row_terrains

SOURCES = ("truth.csv", "odometry.csv", "images.csv", "run.toml")
SPANS = "the spans"


@dataclass(frozen=True)
class TerrainSpan:
    """A terrain from one moment of run time to another.

    Attributes
    ----------
    from_s, to_s : float
        From the first stamp of the odometry.
    terrain : str

    Examples
    --------
    >>> import terrain
    >>> terrain.TerrainSpan(0.0, 12.5, "grass").terrain
    'grass'
    """

    from_s: float
    to_s: float
    terrain: str

    def __post_init__(self) -> None:
        if not 0 <= self.from_s < self.to_s < float("inf"):
            raise RunFolderError(
                f"a span of {self.from_s:g} to {self.to_s:g} s for {self.terrain!r}: expected a "
                "start of 0 or more, and an end after it"
            )


@dataclass(frozen=True)
class GivenTerrain:
    """Names of terrain, each from its stamp until the next one; "" where none is given.

    Attributes
    ----------
    source : str
        Their source.
    stamps_s : (N,)
    names : tuple of str, length N
    of_images : bool
        Whether a name is of what an image shows; else of the terrain under the robot.
    probabilities : (N,), optional
        Of each name, where the source has some.
    notes : tuple of str
        What makes the names doubtful.
    """

    source: str
    stamps_s: FloatArray
    names: tuple[str, ...]
    of_images: bool = False
    probabilities: FloatArray | None = None
    notes: tuple[str, ...] = ()

    def between(self, begin_s: float, end_s: float) -> frozenset[str]:
        """All names that hold at a moment between two, these included; "" where none does."""
        first, end = self._rows(begin_s, end_s)
        before = {""} if first < 0 else set()
        return frozenset(before | set(self.names[max(first, 0) : end]))

    def least_probability(self, begin_s: float, end_s: float) -> float:
        """The least one of the names that hold between two moments; NaN where none is known."""
        if self.probabilities is None:
            return float("nan")
        first, end = self._rows(begin_s, end_s)
        return float(np.min(self.probabilities[max(first, 0) : end], initial=1.0))

    def _rows(self, begin_s: float, end_s: float) -> tuple[int, int]:
        """First and end row of the names that hold between two moments; -1 before all."""
        first = int(np.searchsorted(self.stamps_s, begin_s, side="right")) - 1
        return first, int(np.searchsorted(self.stamps_s, end_s, side="right"))

    @property
    def terrains(self) -> tuple[str, ...]:
        """The names of terrain, sorted."""
        return tuple(sorted({*self.names} - {""}))


def given_by_spans(run: Run, spans: Sequence[TerrainSpan], start_s: float) -> GivenTerrain:
    """Spans of run time; no terrain is given between them.

    Parameters
    ----------
    run : Run
    spans : sequence of TerrainSpan
    start_s : float
        The stamp from which they count.

    Raises
    ------
    RunFolderError
        If two spans overlap, or a name cannot name a folder.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> span = terrain.TerrainSpan(5.0, 12.5, "grass")
    >>> given = terrain.given_by_spans(run, [span], start_s=0.0)
    >>> given.between(6.0, 7.0), given.between(0.0, 1.0)
    (frozenset({'grass'}), frozenset({''}))
    """
    ordered = sorted(spans, key=lambda span: span.from_s)
    stamps_s: list[float] = []
    names: list[str] = []
    end_s = 0.0
    for span in ordered:
        if span.from_s < end_s:
            raise RunFolderError(
                f"{run.folder}: the span of {span.terrain!r} from {span.from_s:g} s begins before "
                f"the one before it ends, at {end_s:g} s"
            )
        if span.from_s > end_s:
            stamps_s, names = [*stamps_s, start_s + end_s], [*names, ""]
        stamps_s, names = [*stamps_s, start_s + span.from_s], [*names, span.terrain]
        end_s = span.to_s
    return _given(SPANS, np.array([*stamps_s, start_s + end_s]), [*names, ""])


def given_terrain(run: Run, source: str | None = None) -> GivenTerrain:
    """The terrain that a file of the run gives.

    Parameters
    ----------
    run : Run
    source : {"truth.csv", "odometry.csv", "images.csv", "run.toml"}, optional
        By default the first of these that names a terrain.

    Raises
    ------
    RunFolderError
        If it names none, or one that cannot name a folder.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> given = terrain.given_terrain(run)
    >>> given.source, given.names[0]
    ('truth.csv', 'gravel')
    """
    for name in SOURCES if source is None else (source,):
        found = _of_file(run, name)
        if found is not None and found.terrains:
            return found
    raise RunFolderError(
        f"{run.folder}: no terrain is named by {source or 'any file'}; expected a column `terrain` "
        "of truth.csv, odometry.csv or images.csv, [run] terrain of run.toml, or spans "
        "(--span 0:20=grass)"
    )


def _of_file(run: Run, name: str) -> GivenTerrain | None:
    start_s = run.odometry.stamps_s[:1]
    if name == "odometry.csv":
        if "terrain" not in run.odometry:
            return None
        return _given(name, run.odometry.stamps_s, row_terrains(run).tolist())
    if name == "run.toml":
        return None if run.terrain is None else _given(name, start_s, [run.terrain])
    table = run.truth if name == "truth.csv" else run.images
    if table is None or "terrain" not in table:
        return None
    of_images = name == "images.csv"
    return _given(name, table.stamps_s, table["terrain"].tolist(), of_images=of_images)


def _given(
    source: str, stamps_s: FloatArray, names: Sequence[str], *, of_images: bool = False
) -> GivenTerrain:
    known = tuple("" if name == UNKNOWN else str(name) for name in names)
    for name in sorted(set(known)):
        if name.startswith(".") or any(sign in name for sign in "/\\\0"):
            raise RunFolderError(
                f"{source}: the terrain {name!r} cannot name a folder of patches; expected a name "
                "without slashes that does not begin with a dot"
            )
    return GivenTerrain(source, stamps_s, known, of_images)
