"""Where camera, feel and motion name different terrains for long, and unknown terrain."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.feel.labels.felt import SILENT, FeltWindows
from odometry.geometry import se2
from odometry.recording.run import UNKNOWN
from odometry.replays.terrain_sources import NamedTerrain
from odometry.trajectory import Trajectory
from terrain.image_labels.image_label import ImageLabel
from terrain.result.contradictions_so_far import Contradiction, ContradictionsSoFar

STRETCH_S = 4.0  # of feel, half before a moment and half after


@dataclass(frozen=True)
class Beneath:
    """Earlier labels of the place where the robot is, at N moments: names and shares."""

    names: AnyArray
    probabilities: FloatArray


def contradictions(
    felt: FeltWindows, beneath: Beneath | None = None, motion: NamedTerrain | None = None
) -> tuple[Contradiction, ...]:
    """Spans of LASTS_S or more.

    Parameters
    ----------
    felt : FeltWindows
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
    found, so_far = list[Contradiction](), ContradictionsSoFar()
    rows = zip(camera.tolist(), names.tolist(), by_motion.tolist(), strict=True)
    for moment_s, by_source, *sizes in zip(
        moments_s.tolist(), rows, share.tolist(), sure.tolist(), strict=True
    ):
        found += so_far.add(moment_s, by_source, (sizes[0], sizes[1]))
    return (*found, *so_far.lasting)


def moments_of(felt: FeltWindows) -> FloatArray:
    """The moments (W,) in the middle of what is put together."""
    return np.asarray(felt.windows.ends_s - STRETCH_S / 2)


def labels_beneath(
    felt: FeltWindows,
    image_labels: Sequence[ImageLabel],
    odometer: Trajectory,
    radius_m: float,
    *,
    causal: bool = False,
) -> Beneath:
    """The most frequent label of places within `radius_m` of the robot, and its mean probability.

    Parameters
    ----------
    felt : FeltWindows
    image_labels : sequence of ImageLabel
        Of the same run.
    odometer : Trajectory
        No measured pose moves it, so that places do not move under the robot.
    radius_m : float
    causal : bool
        Whether labels that are later than a window is known count for nothing.
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
    stamps_s, places = stamps_s[kept], _places(of, odometer)
    upto_s = felt.stamps_s if causal else np.full(len(moments_s), np.inf)
    for row, here in enumerate(odometer.at(moments_s).poses[:, :2]):
        near = (np.hypot(*(places - here).T) <= radius_m) & (stamps_s <= upto_s[row])
        names[row], shares[row] = most_frequent(
            [one for one, of_it in zip(of, near, strict=True) if of_it]
        )
    return Beneath(names, shares)


def most_frequent(labels: Sequence[ImageLabel]) -> tuple[str, float]:
    """The most frequent label and its mean probability; "" without a label."""
    if not labels:
        return "", float("nan")
    found, counts = np.unique([one.label for one in labels], return_counts=True)
    name = str(found[counts.argmax()])
    if name == UNKNOWN:
        return name, float("nan")
    return name, _mean(np.array([one.confidence for one in labels if one.label == name]))


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


def _mean(values: FloatArray) -> float:
    """Of the numbers; NaN without one."""
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else float("nan")
