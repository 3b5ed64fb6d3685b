"""What all runs of a batch learned, by terrain."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from odometry.merged_parameters import MergedTerrain, learned_by_runs, merged_terrain
from odometry.parameters import ParameterSet, read_parameters, write_parameters
from terrain.batch.row import Row

LEARNED = "learned.toml"


@dataclass(frozen=True)
class Learned:
    """The merged parameter set.

    Attributes
    ----------
    before : ParameterSet
        With which every run began.
    terrains : Mapping of terrain to MergedTerrain
    left_out : tuple of str
        Sentences on what was not merged, and why.
    """

    before: ParameterSet
    terrains: Mapping[str, MergedTerrain]
    left_out: tuple[str, ...]

    @property
    def parameters(self) -> ParameterSet:
        """For a next run: terrains that no run learned stay as they were."""
        merged = {name: of.parameters for name, of in self.terrains.items()}
        return replace(self.before, terrains={**self.before.terrains, **merged})

    @property
    def sentences(self) -> list[str]:
        """What was merged, the spread between runs, and which runs disagree."""
        said = [sentence for name, of in self.terrains.items() for sentence in _said(name, of)]
        return [*said, *self.left_out]


def merge(out: Path, rows: Sequence[Row], before: ParameterSet) -> Learned:
    """Merge what the runs left in their folders; those that something misled are left out.

    Raises
    ------
    ParameterError
        If a file of a run is not as the format says.
    """
    done = [row for row in rows if not row.error]
    robots = dict.fromkeys(row.robot for row in done)
    if len(robots) > 1:
        named = ", ".join(f"{name or 'a robot'} {width:g} m wide" for name, width in robots)
        said = f"Nothing is merged, the runs are of several robots: {named}"
        return Learned(before, {}, (said,))
    after = {
        row.name: read_parameters(out / row.name / LEARNED)
        for row in done
        if not row.flags and (out / row.name / LEARNED).is_file()
    }
    terrains = {
        name: merged_terrain(tables, began_alike=name in before.terrains)
        for name, tables in sorted(learned_by_runs(before, after).items())
    }
    misled = [f"{row.name} ({' '.join(row.flags)})" for row in done if row.flags]
    said = f"Not merged, because something misled the filter: {', '.join(misled)}"
    return Learned(before, terrains, (said,) if misled else ())


def write_learned(learned: Learned, file: Path, comment: str) -> bool:
    """Write the merged set, or remove an earlier one where no run learned; whether it is there."""
    if not learned.terrains:
        file.unlink(missing_ok=True)
        return False
    said = "".join(f"# {sentence}\n" for sentence in learned.sentences)
    write_parameters(file, learned.parameters, comment + said)
    return True


def _said(name: str, of: MergedTerrain) -> list[str]:
    if not of.spread:
        runs = "1 run" if len(of.runs) == 1 else f"{len(of.runs)} runs"
        first = f"{name}: {runs}: no spread between runs: 3 or more runs are needed"
    else:
        sigmas = ", ".join(f"{key} {sigma:.3f}" for key, sigma in of.spread.items())
        first = f"{name}: {len(of.runs)} runs; standard deviation between runs: {sigmas}"
    return [first, *(f"{name}: {sentence}" for sentence in of.disagree)]
