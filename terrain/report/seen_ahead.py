"""What was seen against what was there, and which images show it best."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import IntArray
from odometry.evaluation.stretches import terrain_at
from odometry.run import UNKNOWN
from terrain.run_result import RunResult
from terrain.sighting import Sighting
from terrain.switch import SwitchEvent
from terrain.switch_delay import true_stretches


@dataclass(frozen=True)
class Confusion:
    """How often each label was given on each true terrain.

    Attributes
    ----------
    names : tuple of str
        True terrains, the columns.
    said : tuple of str
        Labels, the rows: the true terrains first, then others, then `unknown`.
    counts : (len(said), len(names))
    """

    names: tuple[str, ...]
    said: tuple[str, ...]
    counts: IntArray


def confusion(result: RunResult) -> Confusion | None:
    """Compare each label with the true terrain of the place that it speaks of.

    That place is where the robot is after the wheel travel of the region ahead. Labels of places
    that the run does not reach are left out. None where nothing can be compared.
    """
    truth = true_stretches(result)
    pairs = [
        (sighting.label, terrain_at(truth, _arrival_s(result, sighting)))
        for sighting in (result.watcher.sightings if result.watcher else ())
        if sighting.label and sighting.region is not None
    ]
    pairs = [(label, true) for label, true in pairs if true]
    if not pairs:
        return None
    names = tuple(sorted({true for _, true in pairs}))
    others = {label for label, _ in pairs} - set(names)
    said = (*names, *sorted(others - {UNKNOWN}), *sorted(others & {UNKNOWN}))
    counts = np.zeros((len(said), len(names)), dtype=np.int64)
    for label, true in pairs:
        counts[said.index(label), names.index(true)] += 1
    return Confusion(names, said, counts)


def around_switches(
    sightings: Sequence[Sighting], events: Sequence[SwitchEvent], most: int = 6
) -> list[Sighting]:
    """Labelled sightings that show the switches: the first of each, then their neighbours.

    Parameters
    ----------
    sightings : sequence of Sighting
    events : sequence of SwitchEvent
        Without any, the sightings are spread evenly over the run.
    most : int

    Returns
    -------
    list of Sighting
        At most `most`, in order of time.
    """
    labelled = [sighting for sighting in sightings if sighting.label]
    firsts = [
        place
        for event in events
        for place, sighting in enumerate(labelled)
        if sighting.stamp_s == event.sight.stamp_s
    ]
    if not firsts:
        places = np.linspace(0, len(labelled) - 1, min(most, len(labelled))).astype(int).tolist()
    else:
        places = [first + move for move in (0, -1, 1) for first in firsts]
    inside = [place for place in dict.fromkeys(places) if 0 <= place < len(labelled)]
    return [labelled[place] for place in sorted(inside[:most])]


def _arrival_s(result: RunResult, sighting: Sighting) -> float:
    """When the robot gets to the middle of the region, infinite if it never does."""
    assert sighting.region is not None  # noqa: S101 - asked by the caller
    stamps_s, travel_m = result.run.odometry.stamps_s, result.run.wheel_travel_m
    there_m = np.interp(sighting.stamp_s, stamps_s, travel_m) + sighting.region.distance_ahead_m
    if there_m > travel_m[-1]:
        return float("inf")
    return float(stamps_s[np.searchsorted(travel_m, there_m)])
