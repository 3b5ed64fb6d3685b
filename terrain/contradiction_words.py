"""Contradictions as a table and as sentences with what to do."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from terrain.contradictions import Contradiction
from terrain.new_terrain import NEW
from terrain.run_result import RunResult

MOST = 4  # that are given as sentences


def contradiction_columns(found: Sequence[Contradiction]) -> dict[str, Any]:
    """Columns of contradictions.csv by name; none without any."""
    if not found:
        return {}
    return {
        "t": np.array([one.begin_s for one in found]),
        "until": np.array([one.end_s for one in found]),
        "seen": np.array([one.seen for one in found]),
        "seen_probability": np.array([one.seen_probability for one in found]),
        "felt": np.array([one.felt for one in found]),
        "felt_probability": np.array([one.felt_probability for one in found]),
        "motion": np.array([one.moved for one in found]),
    }


def contradiction_lines(result: RunResult) -> list[str]:
    """What differs and for how long, then what to do; nothing where all agree."""
    return list(_lines(result))


def _lines(result: RunResult) -> Iterator[str]:
    began_s = result.run.began_s
    differ = [one for one in result.contradictions if not one.is_new]
    for one in differ[:MOST]:
        yield f"From {one.begin_s - began_s:.1f} to {one.end_s - began_s:.1f} s {_told(one)}."
    if len(differ) > MOST:
        yield f"{len(differ) - MOST} more contradictions, see contradictions.csv."
    if differ:
        yield (
            "Look at the images of these stretches: where the camera is wrong, label them and "
            "train again; where feel is wrong, add runs of that terrain to identify-feel."
        )
    new = [one for one in result.contradictions if one.is_new]
    if not new:
        return
    spans = " ".join(
        f"--span {one.begin_s - began_s:.1f}:{one.end_s - began_s:.1f}=NAME" for one in new[:MOST]
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


def _told(one: Contradiction) -> str:
    named = [
        (one.seen, "the camera shows", one.seen_probability),
        (one.felt, "by feel it is", one.felt_probability),
        (one.moved, "by the motion it is", float("nan")),
    ]
    parts = []
    for name, words, probability in named:
        if name:
            sure = f" ({probability:.2f})" if np.isfinite(probability) else ""
            parts.append(f"{words} {name}{sure}")
    return ", ".join(parts)
