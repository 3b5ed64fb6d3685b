"""Runs of one terrain that do not fit one model: each is fitted alone, and compared."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

from odometry.errors import IdentificationError
from odometry.identification.fit import Fit
from odometry.identification.fit_pair import FitPair
from odometry.identification.fitters import FitTo
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows


@dataclass(frozen=True)
class RunsApart:
    """Groups of runs whose parameters differ from group to group.

    Attributes
    ----------
    groups : tuple of tuple of str
        Names of runs, two groups or more. A run that differs from none is in none.
    farthest : FitPair
        The two runs that lie farthest apart, each fitted alone: the first of the first two groups.
    """

    groups: tuple[tuple[str, ...], ...]
    farthest: FitPair

    def note(self) -> str:
        """A sentence on what disagrees, and what to do."""
        said = " against ".join(", ".join(group) for group in self.groups)
        one, other = (group[0] for group in self.groups[:2])
        return (
            f"the runs do not fit one model: {said}. Identified alone, {one} and {other} give "
            f"different parameters ({self.farthest.values_named}), and with those of the other the "
            f"error of each is {self.farthest.worse:.1f} times as large: the values are an average "
            "that is true of neither. Name their terrains apart ([run] terrain), leave out the run "
            "that is of another robot or load, or identify each alone; `batch` learns every run "
            "by itself and states their spread"
        )


def runs_apart(
    windows: Windows | Stretches, fit_to: FitTo, near: Mapping[str, float]
) -> RunsApart | None:
    """Groups of runs that differ; None where all agree.

    Every run that determines parameters is fitted alone. The two that lie farthest apart begin a
    group each, and so does a run that differs from all that began one; the others that differ from
    any of these join the one under whose parameters their error grows least.

    Parameters
    ----------
    windows : Windows or Stretches
        Of one terrain.
    fit_to : callable
        From windows to a fit.
    near : Mapping of name to float
        Where the searches start.
    """
    alone = _alone(windows, fit_to, near)
    pairs = {names: FitPair(*(alone[n] for n in names)) for names in combinations(alone, 2)}
    apart = {names: pair.worse for names, pair in pairs.items() if pair.differs}
    if not apart:
        return None
    farthest = max(apart, key=lambda names: apart[names])
    differ = {frozenset(names) for names in apart}
    groups = {name: [name] for name in farthest}
    others = [name for name in alone if name not in groups]
    for name in others:
        if all(frozenset((name, first)) in differ for first in groups):
            groups[name] = [name]
    for name in others:
        if name not in groups and any(frozenset((name, first)) in differ for first in groups):
            nearest = min(groups, key=lambda first: FitPair(alone[name], alone[first]).worse)
            groups[nearest].append(name)
    return RunsApart(tuple(map(tuple, groups.values())), pairs[farthest])


def _alone(
    windows: Windows | Stretches, fit_to: FitTo, near: Mapping[str, float]
) -> dict[str, Fit]:
    """Fits of runs alone, without those that do not determine the parameters."""
    names = list(dict.fromkeys(map(str, windows.run)))
    found: dict[str, Fit] = {}
    for name in names if len(names) > 1 else ():
        try:
            found[name] = fit_to(windows.where(windows.run == name), near)
        except IdentificationError:
            continue
    return found
