"""Unknown terrain, learned under a name of its own, and contradictions in sentences."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from odometry.estimation.estimate import Estimate
from odometry.parameters import ParameterSet
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_terrains import Footing
from odometry.replays.estimates import Replay
from odometry.replays.learned_parameters import learned_parameters
from odometry.replays.pipeline import Estimator, replay
from odometry.replays.terrain_sources import ReplayedFooting
from terrain.result.contradictions_so_far import Contradiction
from terrain.result.run_result import RunResult

NEW = "unknown {number}"


@dataclass(frozen=True)
class Renamed:
    """The terrain of an earlier replay, but within spans another terrain.

    Attributes
    ----------
    replayed : ReplayedFooting
    name : str
    spans_s : tuple of (float, float)
    """

    replayed: ReplayedFooting
    name: str
    spans_s: tuple[tuple[float, float], ...]

    @property
    def initial(self) -> str:
        """The terrain at the first estimate."""
        return self.replayed.initial

    def terrain(self, frame: Frame, estimate: Estimate) -> Footing:
        """The footing in force at the stamp of the frame."""
        if any(begin_s <= frame.stamp_s <= end_s for begin_s, end_s in self.spans_s):
            return Footing.of(self.name)
        return self.replayed.terrain(frame, estimate)


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
    """What was learned, and the ICRs of the stretches on unknown terrain under a name of their own.

    The run is replayed once more with that name in force there; the estimates stay those of the
    first replay. Nothing is learned where no pose was taken in, see `learned_parameters`. All
    such stretches of a run get one name: feel does not determine whether they are the same.
    """
    if not spans_s:
        return learned
    name = new_name((*learned.terrains, UNKNOWN))
    source = Renamed(ReplayedFooting(first.estimates), name, spans_s)
    again = replay(run, estimator, source, causal=causal)
    found = learned_parameters(learned, again, run.name).terrains.get(name)
    if found is None:
        return learned
    return replace(learned, terrains={**learned.terrains, name: found})


MOST_SENTENCES = 4  # that are given as sentences


def contradiction_columns(found: Sequence[Contradiction]) -> dict[str, Any]:
    """Columns of contradictions.csv by name; none without any."""
    if not found:
        return {}
    return {
        "t": np.array([one.begin_s for one in found]),
        "until": np.array([one.end_s for one in found]),
        "camera": np.array([one.camera for one in found]),
        "camera_probability": np.array([one.camera_probability for one in found]),
        "feel": np.array([one.feel for one in found]),
        "feel_probability": np.array([one.feel_probability for one in found]),
        "motion": np.array([one.motion for one in found]),
    }


def contradiction_lines(result: RunResult) -> list[str]:
    """What differs and for how long, then what to do; nothing where all agree."""
    return list(_lines(result))


def _lines(result: RunResult) -> Iterator[str]:
    began_s = result.run.began_s
    differ = [one for one in result.contradictions if not one.is_new]
    for one in differ[:MOST_SENTENCES]:
        yield f"From {one.begin_s - began_s:.1f} to {one.end_s - began_s:.1f} s {_sentence(one)}."
    if len(differ) > MOST_SENTENCES:
        yield f"{len(differ) - MOST_SENTENCES} more contradictions, see contradictions.csv."
    if differ:
        yield (
            "Look at the images of these stretches: where the camera is wrong, label them and "
            "train again; where feel is wrong, add runs of that terrain to identify-feel."
        )
    new = [one for one in result.contradictions if one.is_new]
    if not new:
        return
    spans = " ".join(
        f"--span {one.begin_s - began_s:.1f}:{one.end_s - began_s:.1f}=NAME"
        for one in new[:MOST_SENTENCES]
    )
    whole_s = sum(one.end_s - one.begin_s for one in new)
    name = next((of for of in result.learned.terrains if _is_new(result, of)), None)
    learned = "; its ICRs are in learned.toml" if name else ""
    yield (
        f"{whole_s:.0f} s are of a terrain that no source knows "
        f"({name or NEW.format(number=1)}{learned}). If it has a name, `label RUN {spans}` makes "
        "patches of it, and identify-feel learns it from runs that name it."
    )


def _is_new(result: RunResult, name: str) -> bool:
    return name.startswith("unknown ") and name not in result.parameters.terrains


def _sentence(one: Contradiction) -> str:
    named = [
        (one.camera, "the camera shows", one.camera_probability),
        (one.feel, "by feel it is", one.feel_probability),
        (one.motion, "by the motion it is", float("nan")),
    ]
    parts = []
    for name, words, probability in named:
        if name:
            sure = f" ({probability:.2f})" if np.isfinite(probability) else ""
            parts.append(f"{words} {name}{sure}")
    return ", ".join(parts)
