"""What each fit may use: no window is evaluated with a model that was identified on it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray
from odometry.comparison.file_names import check_file_names
from odometry.errors import WindowError
from odometry.identification.shorter_windows import enough_of
from odometry.identification.stretch_fit import stretches_for
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import Run, robot_labels, run_names
from odometry.recording.run_terrains import row_terrains
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.measured_poses import lacks_yaw
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows, windows_of

MOST_FOLDS = 10  # so that the cost of a comparison is linear in the number of runs


@dataclass(frozen=True, eq=False)
class Part:
    """Some rows of a run, as far as they lie on one terrain.

    Attributes
    ----------
    run : Run
        Whole, with named terrains.
    name : str
        Of the run, unlike that of any other.
    terrain : str
    start, stop : int
        Rows of odometry.csv, `stop` not included.
    """

    run: Run
    name: str
    terrain: str
    start: int
    stop: int

    @property
    def rows(self) -> BoolArray:
        """Whether each row (N,) of the whole run is in this part."""
        inside = np.zeros(len(self.run.odometry), dtype=np.bool_)
        inside[self.start : self.stop] = True
        return np.asarray(inside & (row_terrains(self.run) == self.terrain))

    def cut(self) -> Run:
        """A run of these rows and the poses within their time, and nothing else."""
        odometry = self.run.odometry.rows(slice(self.start, self.stop))
        pose = self.run.pose
        if pose is not None:
            first = int(np.searchsorted(pose.stamps_s, odometry.stamps_s[0]))
            end = int(np.searchsorted(pose.stamps_s, odometry.stamps_s[-1], side="right"))
            pose = pose.rows(slice(first, end))
        return replace(self.run, odometry=odometry, pose=pose)


def parts_by_terrain(run: Run, name: str) -> dict[str, Part]:
    """All of a run, by terrain."""
    terrains = dict.fromkeys(map(str, row_terrains(run)))
    return {terrain: Part(run, name, terrain, 0, len(run.odometry)) for terrain in terrains}


def halves(part: Part) -> tuple[Part, Part]:
    """A part cut where half of its wheel travel between its first and last pose is done."""
    run = part.run
    step_m = np.append(np.diff(run.wheel_travel_m), 0.0) * part.rows
    if run.pose is not None:
        stamps_s, of_poses_s = run.odometry.stamps_s, run.pose.stamps_s
        step_m *= (stamps_s >= of_poses_s[0]) & (stamps_s <= of_poses_s[-1])
    travel_m = np.cumsum(step_m)
    middle = int(np.searchsorted(travel_m, travel_m[-1] / 2))
    middle = min(max(middle, part.start + 1), part.stop - 1)
    return replace(part, stop=middle), replace(part, start=middle)


def windows_of_parts(parts: Sequence[Part], config: WindowConfig) -> Windows:
    """Windows of parts of one terrain.

    Raises
    ------
    WindowError
        If there is none.
    """
    windows = windows_of([part.cut() for part in parts], config)
    here = windows.terrain == parts[0].terrain
    if not here.any():
        raise WindowError(
            f"no window lies wholly on {parts[0].terrain!r} in "
            f"{', '.join(part.name for part in parts)}; choose a shorter horizon"
        )
    return windows.where(here)


def training_windows(parts: Sequence[Part], config: WindowConfig) -> Windows | Stretches:
    """`windows_of_parts`, shorter where they are too few; stretches of positions without yaw.

    Raises
    ------
    OdometryError
        If there is none.
    """
    cut = [part.cut() for part in parts]
    if not any(map(lacks_yaw, cut)):
        return enough_of(windows_of_parts(parts, config), cut, config)[0]
    stretches = stretches_for(cut, config)
    return stretches.where(stretches.terrain == parts[0].terrain)


@dataclass(frozen=True, eq=False)
class Split:
    """Parts of one robot and terrain that are held out, and those to identify models on for them.

    Attributes
    ----------
    robot : str
        Label of the robot.
    terrain : str
    held_out, training : tuple of Part
        Without a row in common. There may be nothing to identify on.
    training_names : str
        What is identified on, for readers.
    """

    robot: str
    terrain: str
    held_out: tuple[Part, ...]
    training: tuple[Part, ...]
    training_names: str


def of_all(planned: Sequence[Split]) -> tuple[Split, ...]:
    """One split a robot and terrain, with all training parts of its splits together."""
    groups: dict[tuple[str, str], list[Split]] = {}
    for split in planned:
        groups.setdefault((split.robot, split.terrain), []).append(split)
    found = []
    for (robot, terrain), group in groups.items():
        held_out = tuple(part for split in group for part in split.held_out)
        known = {part for split in group for part in split.training}
        every = dict.fromkeys(p for split in group for p in (*split.held_out, *split.training))
        training = tuple(part for part in every if part in known)
        names = ", ".join(dict.fromkeys(part.name for part in training))
        found.append(Split(robot, terrain, held_out, training, names))
    return tuple(found)


def splits(runs: Sequence[Run], train: Sequence[Run] = ()) -> tuple[Split, ...]:
    """Split runs by robot and terrain.

    With `train`, models are identified on those of its runs that are of the same robot and
    terrain. Else the runs are held out in turn (see `folds`) and models are identified on the
    others.

    Parameters
    ----------
    runs, train : sequence of Run
        Whole, with named terrains.

    Raises
    ------
    RunFolderError
        If a run is there twice.
    ComparisonError
        As `check_file_names`.
    """
    check_no_run_twice([*runs, *train])
    names = run_names([*runs, *train])
    labels = robot_labels([run.robot for run in [*runs, *train]])
    evaluated = _by_robot_and_terrain(runs, names[: len(runs)], labels)
    check_file_names(evaluated)
    training = _by_robot_and_terrain(train, names[len(runs) :], labels)
    found: list[Split] = []
    for (robot, terrain), parts in evaluated.items():
        if train:
            known = tuple(training.get((robot, terrain), ()))
            found.append(Split(robot, terrain, tuple(parts), known, _names(known)))
        else:
            found += folds(robot, terrain, parts)
    return tuple(found)


def folds(robot: str, terrain: str, parts: Sequence[Part]) -> list[Split]:
    """Each part held out in turn; the halves of the only part in turn.

    More than ten parts are put into ten groups, and each group is held out in turn. Neighbours
    are in one group: runs that are given one after the other were often recorded so, and are
    similar.
    """
    if len(parts) == 1:
        first, second = halves(parts[0])
        return [
            Split(robot, terrain, (first,), (second,), "the second half of the run"),
            Split(robot, terrain, (second,), (first,), "the first half of the run"),
        ]
    found = []
    for group in np.array_split(np.arange(len(parts)), min(len(parts), MOST_FOLDS)):
        held_out = tuple(parts[group[0] : group[-1] + 1])
        others = (*parts[: group[0]], *parts[group[-1] + 1 :])
        found.append(Split(robot, terrain, held_out, others, _names(others)))
    return found


def _by_robot_and_terrain(
    runs: Sequence[Run], names: Sequence[str], labels: dict[tuple[str, float], str]
) -> dict[tuple[str, str], list[Part]]:
    groups: dict[tuple[str, str], list[Part]] = {}
    for run, name in zip(runs, names, strict=True):
        label = labels[run.robot.name, run.robot.track_width]
        for terrain, part in parts_by_terrain(run, name).items():
            groups.setdefault((label, terrain), []).append(part)
    return groups


def _names(parts: Sequence[Part]) -> str:
    return ", ".join(part.name for part in parts) or "nothing"
