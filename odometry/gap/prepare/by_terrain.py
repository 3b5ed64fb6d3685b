"""A base that has ICRs of its own on each terrain, where the calibration shows that they differ."""

from collections.abc import Sequence

import numpy as np

from odometry.effects.interface.recorded import labels_of
from odometry.gap.config import GapConfig
from odometry.gap.prepare.calibration import Calibration, calibrated
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.statistic import squared_errors, sure_sum
from odometry.models.icr import Icr, IcrByTerrain
from odometry.windows.dense.dense import DenseWindows

LEAST_S = 20.0  # on a terrain, for its own ICRs


def by_terrain(
    known: Calibration, scenes: Sequence[DenseWindows], config: GapConfig
) -> Calibration:
    """The calibration with ICRs by terrain, where these explain held-back stretches better.

    By the sum of squared position errors, sure at 95 % over pieces of the runs. The same where the
    base is another model or was given, or fewer than two terrains are labelled for long enough.
    """
    labels = labels_covered(scenes)
    base_is_open = isinstance(known.base.model, Icr) and known.uncertain.free.any()
    if not base_is_open or len(labels) < 2:
        return known
    split = calibrated(scenes, IcrByTerrain(labels), known.base.robot, config)
    kept = [scene for _, scene in known.held_back]
    gains = [
        squared_errors(base, (), scene) - squared_errors(own, (), scene)
        for (base, scene), (own, _) in zip(known.held_back, split.held_back, strict=True)
    ]
    _, piece = np.unique(numbered_pieces(kept, config.part_s), return_inverse=True)
    of_pieces = np.asarray(np.bincount(piece, weights=np.concatenate(gains)), dtype=np.float64)
    return split if sure_sum(of_pieces, config.trimmed) > 0 else known


def labels_covered(scenes: Sequence[DenseWindows]) -> tuple[str, ...]:
    """Terrains on which the runs are for `LEAST_S` or more, the longest first."""
    lasting_s: dict[str, float] = {}
    for scene in scenes:
        for label in sorted(labels_of(scene.inputs)):
            here = np.asarray(scene.inputs.terrain) == label
            lasting_s[label] = lasting_s.get(label, 0.0) + float(scene.steps_s[here].sum())
    covered = [label for label, of in lasting_s.items() if of >= LEAST_S]
    return tuple(sorted(covered, key=lambda label: -lasting_s[label]))
