"""Labels of images against the terrain that the run names: confusion tables."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import IntArray
from odometry.recording.run import UNKNOWN, Run
from terrain.image_labels.image_label import ImageLabel
from terrain.result.run_result import RunResult

NO_LABEL = "no label"


@dataclass(frozen=True)
class LabelConfusion:
    """How often each true terrain got each label.

    Attributes
    ----------
    true : tuple of str
        T terrains, in order of their names.
    labels : tuple of str
        L labels, in order of their names; last `unknown` and `no label`, where they were given.
    counts : (T, L)
    """

    true: tuple[str, ...]
    labels: tuple[str, ...]
    counts: IntArray

    @property
    def right_share(self) -> float | None:
        """Share of the named labels that are right; None where there is none."""
        named = [column for column, label in enumerate(self.labels) if label not in _SILENT]
        right = [
            int(self.counts[self.true.index(self.labels[column]), column])
            for column in named
            if self.labels[column] in self.true
        ]
        total = int(self.counts[:, named].sum())
        return sum(right) / total if total else None

    def to_table(self) -> dict[str, Any]:
        """Plain values for result.json."""
        counts = {
            true: dict(zip(self.labels, row, strict=True))
            for true, row in zip(self.true, self.counts.tolist(), strict=True)
        }
        return {"counts": counts, "right_share": self.right_share}


_SILENT = (UNKNOWN, NO_LABEL)


def label_confusions(result: RunResult) -> dict[str, LabelConfusion]:
    """Labels against what the run itself names, by the file that names it.

    "images.csv" names what an image shows, by its column `terrain`; "truth.csv" what the robot
    drove on where the region of the image was. Images of which nothing is named do not count.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict of str to LabelConfusion
        Empty without vision, or where neither file names a terrain.
    """
    if result.watcher is None:
        return {}
    image_labels = result.watcher.image_labels
    by_file = {
        "images.csv": _of_images(result.run, image_labels),
        "truth.csv": _of_truth(result.run, image_labels),
    }
    found = {file: _confusion(names, image_labels) for file, names in by_file.items()}
    return {file: confusion for file, confusion in found.items() if confusion.true}


def label_confusion_table(result: RunResult) -> dict[str, Any]:
    """The confusion tables as plain values, for result.json."""
    return {file: of.to_table() for file, of in label_confusions(result).items()}


def _confusion(true: Sequence[str], image_labels: Sequence[ImageLabel]) -> LabelConfusion:
    """Of the image labels whose true terrain is named; "" and `unknown` are no names."""
    pairs = [
        (name, image_label.label or NO_LABEL)
        for name, image_label in zip(true, image_labels, strict=True)
        if name not in ("", UNKNOWN)
    ]
    names = sorted({name for name, _ in pairs})
    labels = sorted({label for _, label in pairs} - set(_SILENT))
    labels += [label for label in _SILENT if any(label == of for _, of in pairs)]
    counts = np.zeros((len(names), len(labels)), dtype=np.int64)
    for name, label in pairs:
        counts[names.index(name), labels.index(label)] += 1
    return LabelConfusion(tuple(names), tuple(labels), counts)


def _of_images(run: Run, image_labels: Sequence[ImageLabel]) -> list[str]:
    if run.images is None or "terrain" not in run.images:
        return [""] * len(image_labels)
    named = dict(zip(run.images.stamps_s.tolist(), run.images["terrain"].tolist(), strict=True))
    return [str(named[image_label.stamp_s]) for image_label in image_labels]


def _of_truth(run: Run, image_labels: Sequence[ImageLabel]) -> list[str]:
    """Where the wheel travel to the region has been driven; "" where the run ends before."""
    if run.truth is None or "terrain" not in run.truth:
        return [""] * len(image_labels)
    stamps_s, travel_m = run.odometry.stamps_s, run.wheel_travel_m
    names = []
    for image_label in image_labels:
        ahead_m = 0.0 if image_label.region is None else image_label.region.distance_ahead_m
        there_m = float(np.interp(image_label.stamp_s, stamps_s, travel_m)) + ahead_m
        there_s = float(np.interp(there_m, travel_m, stamps_s)) if ahead_m else image_label.stamp_s
        row = int(np.searchsorted(run.truth.stamps_s, there_s, side="right")) - 1
        known = row >= 0 and there_m <= travel_m[-1]
        names.append(str(run.truth["terrain"][row]) if known else "")
    return names
