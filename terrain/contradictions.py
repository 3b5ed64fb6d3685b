"""Where camera, feel and motion name different terrains for long, and unknown terrain."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.feel.follow import SILENT, Felt
from odometry.geometry import se2
from odometry.run import UNKNOWN
from odometry.run_terrains import NamedTerrain
from odometry.trajectory import Trajectory
from terrain.image_label import ImageLabel

STRETCH_S = 4.0  # of feel, half before a moment and half after
BREAK_S = 2.5  # a shorter time between two equal stretches ends none
LASTS_S = 5.0  # what is shorter is an edge between terrains, or chance


Names = tuple[str, str, str]  # by camera, feel and motion


@dataclass(frozen=True)
class Contradiction:
    """A span in which sources differ, or in which neither knows the terrain.

    Attributes
    ----------
    begin_s, end_s : float
    camera, feel, motion : str
        The terrain by each source; "" of a source that names nothing.
    camera_probability, feel_probability : float
        Means over the span; NaN without a name.
    """

    begin_s: float
    end_s: float
    camera: str
    feel: str
    motion: str
    camera_probability: float
    feel_probability: float

    @property
    def is_new(self) -> bool:
        """Whether no source knows the terrain, and it is unknown by feel."""
        return self.feel == UNKNOWN and self.camera in ("", UNKNOWN)


@dataclass(frozen=True)
class Beneath:
    """Earlier labels of the place where the robot is, at N moments: names and shares."""

    names: AnyArray
    probabilities: FloatArray


def contradictions(
    felt: Felt, beneath: Beneath | None = None, motion: NamedTerrain | None = None
) -> tuple[Contradiction, ...]:
    """Spans of LASTS_S or more.

    Parameters
    ----------
    felt : Felt
        What the run feels like; put together over STRETCH_S around each moment.
    beneath : Beneath, optional
        At the `moments_s` of the same run.
    motion : NamedTerrain, optional
        What the motion names.
    """
    around = replace(felt, config=replace(felt.config, stretch_s=STRETCH_S))
    moments_s = moments_of(felt)
    names = np.where(
        np.isin(around.lasting_answers.astype(str), SILENT), "", around.lasting_answers
    )
    sure = np.where(names == UNKNOWN, np.nan, around.lasting_probabilities.max(axis=1))
    nothing = np.full(len(moments_s), "", dtype=object)
    camera = nothing if beneath is None else beneath.names
    by_motion = nothing if motion is None else _names_at(motion, moments_s)
    share = np.full(len(moments_s), np.nan) if beneath is None else beneath.probabilities
    rows = zip(camera.tolist(), names.tolist(), by_motion.tolist(), strict=True)
    found = [
        Contradiction(
            float(moments_s[first]),
            float(moments_s[last]),
            *by_source,
            _mean(share[first : last + 1]),
            _mean(sure[first : last + 1]),
        )
        for by_source, first, last in _spans(moments_s, list(rows))
    ]
    return tuple(found)


def differ(camera: str, feel: str, motion: str) -> bool:
    """Whether two sources that name a terrain name different ones, or feel knows none.

    A camera that knows no terrain contradicts nobody, nor does feel where the camera knows one.
    """
    named = {name for name in (camera, feel, motion) if name not in ("", UNKNOWN)}
    return len(named) > 1 or (feel == UNKNOWN and not named)


def moments_of(felt: Felt) -> FloatArray:
    """The moments (W,) in the middle of what is put together."""
    return np.asarray(felt.stamps_s - STRETCH_S / 2)


def labels_beneath(
    felt: Felt, image_labels: Sequence[ImageLabel], odometer: Trajectory, radius_m: float
) -> Beneath:
    """The most frequent label of places within `radius_m` of the robot, and its mean probability.

    Parameters
    ----------
    felt : Felt
    image_labels : sequence of ImageLabel
        Of the same run.
    odometer : Trajectory
        No measured pose moves it, so that places do not move under the robot.
    radius_m : float
    """
    of = [one for one in image_labels if one.label and one.region is not None]
    stamps_s = np.array([one.stamp_s for one in of])
    kept = odometer.covers(stamps_s) if of else np.zeros(0, dtype=bool)
    of = [one for one, inside in zip(of, kept, strict=True) if inside]
    moments_s = np.clip(moments_of(felt), odometer.stamps_s[0], odometer.stamps_s[-1])
    names = np.full(len(moments_s), "", dtype=object)
    shares = np.full(len(moments_s), np.nan)
    if not of:
        return Beneath(names, shares)
    places = _places(of, odometer)
    labels = np.array([one.label for one in of], dtype=object)
    sure = np.array([one.confidence for one in of])
    for row, here in enumerate(odometer.at(moments_s).poses[:, :2]):
        near = np.hypot(*(places - here).T) <= radius_m
        if near.any():
            found, counts = np.unique(labels[near].astype(str), return_counts=True)
            names[row] = str(found[counts.argmax()])
            known = names[row] != UNKNOWN
            shares[row] = _mean(sure[near & (labels == names[row])]) if known else np.nan
    return Beneath(names, shares)


def _places(of: Sequence[ImageLabel], odometer: Trajectory) -> FloatArray:
    """The middles (N, 2) of regions in the odometer's frame."""
    poses = odometer.at(np.array([one.stamp_s for one in of])).poses
    middles = np.stack([one.region.place for one in of if one.region is not None])
    return np.asarray(se2.transform(poses, middles))


def _names_at(motion: NamedTerrain, moments_s: FloatArray) -> AnyArray:
    """What the motion named last (W,); "" before its first name."""
    rows = np.searchsorted(motion.stamps_s, moments_s, side="right") - 1
    names = np.append(motion.names.astype(object), "")
    return np.asarray(np.where(names[rows] == UNKNOWN, "", names[rows]))


def _spans(moments_s: FloatArray, rows: Sequence[Names]) -> Iterator[tuple[Names, int, int]]:
    """Where sources differ: what they name, first and last row; short breaks are bridged."""
    found: list[tuple[Names, int, int]] = []
    for by_source, group in groupby(range(len(rows)), key=lambda row: rows[row]):
        if not differ(*by_source):
            continue
        first, *others = group
        last = others[-1] if others else first
        if (
            found
            and found[-1][0] == by_source
            and moments_s[first] <= moments_s[found[-1][2]] + BREAK_S
        ):
            first = found.pop()[1]
        found.append((by_source, first, last))
    yield from (one for one in found if moments_s[one[2]] - moments_s[one[1]] >= LASTS_S)


def _mean(values: FloatArray) -> float:
    """Of the numbers; NaN without one."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else float("nan")
