"""The terrain by the camera as a prior on the modes."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import ParameterError
from odometry.estimation.imm.markov import ModeChain
from odometry.io.csv_table import read_csv_table
from odometry.recording.run import UNKNOWN, Run

NO_LABELS = ("", "nan", UNKNOWN)  # a column without any is one of numbers
BLIND_LENGTHS = 3.0  # of the robot, after which a label is of another place
PULLED_S = 1.0  # within which a mode of confidence 1 becomes probable where motion is no evidence


@dataclass(frozen=True)
class SeenTerrain:
    """A terrain that vision saw ahead, from when the robot is on it.

    Attributes
    ----------
    stamp_s : float
        When the robot gets there: the place was ahead in the image.
    label : str
        A mode, or "unknown": from here on there is no label.
    confidence : float
        Probability of the label, 0 to 1.
    """

    stamp_s: float
    label: str
    confidence: float


def seen_terrains(file: Path, run: Run) -> tuple[SeenTerrain, ...]:
    """What `terrain-odometry run` saw along a run: its terrain.csv.

    A label belongs to the place that it was read from: it counts when the wheels have gone there,
    and no longer when they have gone on by BLIND_LENGTHS of the robot without another label.
    Places that overlap one of the same label that counts are not news, and are left out.

    Raises
    ------
    RunFolderError
        If the file is not such a table.
    """
    table = read_csv_table(file, required=("t", "label", "confidence", "distance_ahead"))
    odometry_s, travel_m = run.odometry.stamps_s, run.wheel_travel_m
    length_m = run.robot.length or run.robot.track_width
    places_m = np.interp(table.stamps_s, odometry_s, travel_m) + table["distance_ahead"]
    labels = table["label"].astype(str)
    located = np.isfinite(places_m) & ~np.isin(labels, NO_LABELS) & (places_m <= travel_m[-1])
    found: list[SeenTerrain] = []
    last_m = -np.inf
    for row in np.flatnonzero(located)[np.argsort(places_m[located], kind="stable")]:
        label, gone_m = str(labels[row]), last_m + BLIND_LENGTHS * length_m
        if found and places_m[row] > gone_m:
            found.append(SeenTerrain(_when(run, gone_m), UNKNOWN, 0.0))
        if found and found[-1].label == label and places_m[row] - last_m < length_m:
            continue
        stamp_s, last_m = _when(run, float(places_m[row])), float(places_m[row])
        found.append(SeenTerrain(stamp_s, label, float(table["confidence"][row])))
    if found and last_m + BLIND_LENGTHS * length_m < travel_m[-1]:
        found.append(SeenTerrain(_when(run, last_m + BLIND_LENGTHS * length_m), UNKNOWN, 0.0))
    return tuple(found)


def _when(run: Run, place_m: float) -> float:
    """The stamp at which the wheels have gone so far [s]."""
    return float(run.odometry.stamps_s[np.searchsorted(run.wheel_travel_m, place_m)])


def seen_labels(seen: Sequence[SeenTerrain], stamps_s: FloatArray) -> AnyArray:
    """The terrain (N,) under the robot by the camera; "unknown" before the first label."""
    labels = np.array([UNKNOWN, *(one.label for one in seen)], dtype=object)
    return labels[np.searchsorted([one.stamp_s for one in seen], stamps_s, side="right")]


def mode_chains(
    seen: Sequence[SeenTerrain], names: Sequence[str], dwell_s: FloatArray
) -> tuple[ModeChain, ...]:
    """How modes change before the first label, and from each label on.

    A label is a prior on where modes change to: from the labelled place on, every other mode
    leads to the labelled one, within PULLED_S where the label is certain, and as before where its
    confidence is that of chance. So it decides where motion is no evidence; motion that
    contradicts it for long overrules it.

    Returns
    -------
    tuple of ModeChain
        One more than `seen`.

    Raises
    ------
    ParameterError
        If a label is not a mode, or a confidence is not 0 to 1.
    """
    usual = ModeChain(dwell_s)
    return (usual, *(_pulled(usual, one, tuple(names)) for one in seen))


def _pulled(usual: ModeChain, one: SeenTerrain, names: tuple[str, ...]) -> ModeChain:
    if one.label == UNKNOWN:
        return usual
    if one.label not in names:
        raise ParameterError(
            f"vision saw {one.label!r} at {one.stamp_s:g} s, which is no mode; expected one of "
            f"{', '.join(names)}"
        )
    if not 0 <= one.confidence <= 1:
        raise ParameterError(f"confidence {one.confidence} at {one.stamp_s:g} s, expected 0 to 1")
    if len(names) == 1:
        return usual
    chance = 1 / len(names)
    rates = usual.rates - np.diag(np.diag(usual.rates))
    certain = max(0.0, (one.confidence - chance) / (1 - chance))
    rates[:, names.index(one.label)] += certain / PULLED_S
    np.fill_diagonal(rates, 0.0)
    leaving = rates.sum(axis=1)
    return ModeChain(1 / leaving, rates / leaving[:, None])
