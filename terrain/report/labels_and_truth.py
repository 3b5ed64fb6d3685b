"""Labels of images against the true terrain, and which images to show."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import IntArray
from odometry.evaluation.stretches import terrain_at
from odometry.recording.run import UNKNOWN
from terrain.image_labels.image_label import ImageLabel
from terrain.result.run_result import RunResult
from terrain.result.switch_delay import true_stretches
from terrain.switch.switch import SwitchEvent


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
    """Compare each label with the true terrain of its place.

    That place is where the robot is after the wheel travel of the region ahead. Labels of places
    that the run does not reach are left out. None where nothing can be compared.
    """
    truth = true_stretches(result)
    pairs = [
        (image_label.label, terrain_at(truth, _arrival_s(result, image_label)))
        for image_label in (result.watcher.image_labels if result.watcher else ())
        if image_label.label and image_label.region is not None
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
    image_labels: Sequence[ImageLabel], events: Sequence[SwitchEvent], most: int = 6
) -> list[ImageLabel]:
    """Labelled image labels that show the switches: the first of each, then their neighbours.

    Parameters
    ----------
    image_labels : sequence of ImageLabel
    events : sequence of SwitchEvent
        Without any, the image labels are spread evenly over the run.
    most : int

    Returns
    -------
    list of ImageLabel
        At most `most`, in order of time.
    """
    labelled = [image_label for image_label in image_labels if image_label.label]
    firsts = [
        place
        for event in events
        for place, image_label in enumerate(labelled)
        if image_label.stamp_s == event.first_label.stamp_s
    ]
    if not firsts:
        places = np.linspace(0, len(labelled) - 1, min(most, len(labelled))).astype(int).tolist()
    else:
        places = [first + move for move in (0, -1, 1) for first in firsts]
    inside = [place for place in dict.fromkeys(places) if 0 <= place < len(labelled)]
    return [labelled[place] for place in sorted(inside[:most])]


def _arrival_s(result: RunResult, image_label: ImageLabel) -> float:
    """When the robot gets to the middle of the region, infinite if it never does."""
    assert image_label.region is not None  # noqa: S101 - checked by the caller
    stamps_s, travel_m = result.run.odometry.stamps_s, result.run.wheel_travel_m
    there_m = (
        np.interp(image_label.stamp_s, stamps_s, travel_m) + image_label.region.distance_ahead_m
    )
    if there_m > travel_m[-1]:
        return float("inf")
    return float(stamps_s[np.searchsorted(travel_m, there_m)])
