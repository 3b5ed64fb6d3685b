"""Who may see what: no window is judged by a model that was identified on it."""

from collections.abc import Sequence
from dataclasses import dataclass

from odometry.comparison.parts import Part, halves, parts_by_ground
from odometry.run import Robot, Run
from odometry.runs import check_no_run_twice, run_names


@dataclass(frozen=True, eq=False)
class Split:
    """Parts of one robot and ground that are judged, and those that a model may see for it.

    Attributes
    ----------
    robot : str
        Label of the robot.
    ground : str
    judged, seen : tuple of Part
        Without a row in common. There may be nothing to see.
    words : str
        What is seen.
    """

    robot: str
    ground: str
    judged: tuple[Part, ...]
    seen: tuple[Part, ...]
    words: str


def of_all(planned: Sequence[Split]) -> tuple[Split, ...]:
    """One split a robot and ground in which a model sees all that any split lets it see."""
    groups: dict[tuple[str, str], list[Split]] = {}
    for split in planned:
        groups.setdefault((split.robot, split.ground), []).append(split)
    found = []
    for (robot, ground), group in groups.items():
        judged = tuple(part for split in group for part in split.judged)
        known = {part for split in group for part in split.seen}
        every = dict.fromkeys(p for split in group for p in (*split.judged, *split.seen))
        seen = tuple(part for part in every if part in known)
        words = ", ".join(dict.fromkeys(part.name for part in seen))
        found.append(Split(robot, ground, judged, seen, words))
    return tuple(found)


def splits(runs: Sequence[Run], train: Sequence[Run] = ()) -> tuple[Split, ...]:
    """Split runs by robot and ground.

    With `train`, models see those of its runs that are of the same robot and ground. Else each
    run is judged by models that saw the other runs; where a ground has one run, each half of it
    by models that saw the other half.

    Parameters
    ----------
    runs, train : sequence of Run
        Whole, with named grounds.

    Raises
    ------
    RunFolderError
        If a run is there twice.
    """
    check_no_run_twice([*runs, *train])
    names = run_names([*runs, *train])
    labels = robot_labels([run.robot for run in [*runs, *train]])
    judged = _by_robot_and_ground(runs, names[: len(runs)], labels)
    seen = _by_robot_and_ground(train, names[len(runs) :], labels)
    found: list[Split] = []
    for (robot, ground), parts in judged.items():
        if train:
            known = tuple(seen.get((robot, ground), ()))
            found.append(Split(robot, ground, tuple(parts), known, _words(known)))
        else:
            found += left_out(robot, ground, parts)
    return tuple(found)


def robot_labels(robots: Sequence[Robot]) -> dict[tuple[str, float], str]:
    """A short name for every robot: what comes before a bracket where that tells them apart."""
    keys = list(dict.fromkeys((robot.name, robot.track_width) for robot in robots))
    full = {(name, width): name or f"robot {width:g} m wide" for name, width in keys}
    short = {key: name.split(" (")[0] for key, name in full.items()}
    longest = {key: f"{name}, track width {key[1]:g} m" for key, name in full.items()}
    choices = (short, full, longest)
    return next(labels for labels in choices if len(set(labels.values())) == len(keys))


def left_out(robot: str, ground: str, parts: Sequence[Part]) -> list[Split]:
    """Each part judged with the others seen; the halves of the only part in turn."""
    if len(parts) == 1:
        first, second = halves(parts[0])
        return [
            Split(robot, ground, (first,), (second,), "the second half of the run"),
            Split(robot, ground, (second,), (first,), "the first half of the run"),
        ]
    found = []
    for part in parts:
        others = tuple(other for other in parts if other is not part)
        found.append(Split(robot, ground, (part,), others, _words(others)))
    return found


def _by_robot_and_ground(
    runs: Sequence[Run], names: Sequence[str], labels: dict[tuple[str, float], str]
) -> dict[tuple[str, str], list[Part]]:
    groups: dict[tuple[str, str], list[Part]] = {}
    for run, name in zip(runs, names, strict=True):
        label = labels[run.robot.name, run.robot.track_width]
        for ground, part in parts_by_ground(run, name).items():
            groups.setdefault((label, ground), []).append(part)
    return groups


def _words(seen: Sequence[Part]) -> str:
    return ", ".join(part.name for part in seen) or "nothing"
