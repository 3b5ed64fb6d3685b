"""A terrain that nobody knows: its stretches get a name, and its ICRs are learned apart."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from odometry.estimates import Replay
from odometry.estimation.estimate import Estimate
from odometry.footing import Footing
from odometry.frames import Frame
from odometry.learned_parameters import learned_parameters
from odometry.parameters import ParameterSet
from odometry.pipeline import Estimator, replay
from odometry.run import UNKNOWN, Run
from odometry.terrain_sources import ToldFooting
from terrain.contradictions import Contradiction

NEW = "unknown {number}"


@dataclass(frozen=True)
class Renamed:
    """The terrain of an earlier replay, but within spans another terrain.

    Attributes
    ----------
    told : ToldFooting
    name : str
    spans_s : tuple of (float, float)
    """

    told: ToldFooting
    name: str
    spans_s: tuple[tuple[float, float], ...]

    @property
    def initial(self) -> str:
        """The terrain at the first estimate."""
        return self.told.initial

    def terrain(self, frame: Frame, estimate: Estimate) -> Footing:
        """The footing in force at the stamp of the frame."""
        if any(begin_s <= frame.stamp_s <= end_s for begin_s, end_s in self.spans_s):
            return Footing.of(self.name)
        return self.told.terrain(frame, estimate)


def new_name(taken: Iterable[str]) -> str:
    """Give "unknown 1", or with the next number that no terrain has."""
    names, number = set(taken), 1
    while NEW.format(number=number) in names:
        number += 1
    return NEW.format(number=number)


def new_spans(found: Sequence[Contradiction]) -> tuple[tuple[float, float], ...]:
    """The stretches that no source knows."""
    return tuple((one.begin_s, one.end_s) for one in found if one.is_new)


def learned_apart(
    run: Run,
    estimator: Estimator,
    first: Replay,
    spans_s: tuple[tuple[float, float], ...],
    learned: ParameterSet,
    *,
    causal: bool,
) -> ParameterSet:
    """What was learned, and the ICRs of the stretches that nobody knows under a name of their own.

    The run is replayed once more with that name in force there; the estimates stay those of the
    first replay. Nothing is learned where no pose was taken in, see `learned_parameters`. All
    such stretches of a run get one name: feel does not determine whether they are the same.
    """
    if not spans_s:
        return learned
    name = new_name((*learned.terrains, UNKNOWN))
    source = Renamed(ToldFooting(first.estimates), name, spans_s)
    again = replay(run, estimator, source, causal=causal)
    found = learned_parameters(learned, again, run.name).terrains.get(name)
    if found is None:
        return learned
    return replace(learned, terrains={**learned.terrains, name: found})
