"""Terrain by feel in the live main job: source, labels beneath the robot, contradictions."""

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from odometry.feel.labels.felt import SILENT, FeltWindows
from odometry.feel.labels.live import LATE_S, LiveFeel
from odometry.feel.recorded.windows import LONGEST_S, STEPS
from odometry.geometry import se2
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN
from odometry.trajectory import Trajectory
from terrain.image_labels.image_label import ImageLabel
from terrain.result.contradictions import STRETCH_S, most_frequent
from terrain.result.contradictions_so_far import BREAK_S, Contradiction, ContradictionsSoFar
from terrain.switch.feel_labels import evident, given_by, place_label, widened
from terrain.switch.place_labels import PlaceLabel

KEPT_S = STRETCH_S + LATE_S + LONGEST_S  # of poses: moments of windows lie no farther back
MOST_LABELS = 1000  # of images, whose places are remembered


@dataclass(frozen=True)
class FeltAnswer:
    """What the robot feels, over the last stretch.

    Attributes
    ----------
    stamp_s : float
        From when on it is known.
    label : str
        A terrain, "unknown", "undetermined", "stationary" or "not measured".
    probabilities : Mapping of str to float
        Of the terrains of the model; with `unknown` they add up to 1.
    unknown : float
    """

    stamp_s: float
    label: str
    probabilities: Mapping[str, float]
    unknown: float

    @classmethod
    def of(cls, felt: FeltWindows) -> "FeltAnswer":
        """That of the last window."""
        given = felt.lasting_probabilities[-1].tolist()
        return cls(
            float(felt.stamps_s[-1]),
            str(felt.lasting_answers[-1]),
            dict(zip(felt.model.names, given, strict=True)),
            float(felt.lasting_unknown[-1]),
        )


class LiveFeelTerrain:
    """What is felt as the source of terrain: the last name holds, as in `run --source feel`.

    Parameters
    ----------
    initial : str
        In force until something is named.
    """

    def __init__(self, initial: str) -> None:
        self.initial = self._named = initial

    def add(self, felt: FeltWindows) -> None:
        """Take in a window, the last of its stretch."""
        answer = str(felt.lasting_answers[-1])
        if answer not in (*SILENT, UNKNOWN):
            self._named = answer

    def terrain(self, frame: Frame, estimate: Estimate) -> str:  # noqa: ARG002 - the protocol's
        """The terrain that was named last."""
        return self._named


class LiveFeelLabels:
    """As `FeelLabels`, of windows as they become known.

    Parameters
    ----------
    names, image_names : tuple of str
        Of the terrains of the model of feel, and of those that the camera can name.
    """

    def __init__(self, names: tuple[str, ...], image_names: tuple[str, ...]) -> None:
        self._names = names, image_names
        self._windows = 0
        self._waiting: list[tuple[float, FloatArray]] = []

    def add(self, felt: FeltWindows) -> None:
        """Take in a window; those between two that do not overlap are left out."""
        last = np.array([len(felt.windows) - 1])
        if self._windows % STEPS == 0 and len(evident(felt, last)):
            self._waiting.append((float(felt.stamps_s[-1]), given_by(felt, last)[0]))
        self._windows += 1

    def between(
        self,
        after_s: float,  # noqa: ARG002 - the protocol's
        upto_s: float,  # noqa: ARG002 - the protocol's
        pose: FloatArray,
        travel_m: float,
    ) -> Iterator[PlaceLabel]:
        """Labels of the windows that became known since the last call."""
        waiting, self._waiting = self._waiting, []
        for of in waiting:
            yield place_label(self._names, of, pose, travel_m)

    def beside(self, seen: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of one image with those terrains added that only feel can name."""
        return widened(seen, self._names[0]) if seen else seen


class LiveContradictions:
    """Where camera and feel differ for long, as `contradictions` finds it with `causal`.

    Parameters
    ----------
    radius_m : float
        Of the robot's footprint.
    """

    def __init__(self, radius_m: float) -> None:
        self._radius_m = radius_m
        self._so_far = ContradictionsSoFar()
        self._poses: deque[tuple[float, FloatArray]] = deque()
        self._seen: deque[tuple[ImageLabel, FloatArray]] = deque(maxlen=MOST_LABELS)
        self._moment_s = -np.inf
        self.ended: tuple[Contradiction, ...] = ()

    def moved(self, stamp_s: float, pose: FloatArray, seen: ImageLabel | None) -> None:
        """Take in the pose (3,) of the odometer at a frame, and the label of its image."""
        self._poses.append((stamp_s, pose))
        while self._poses[0][0] < stamp_s - KEPT_S:
            self._poses.popleft()
        if seen is not None and seen.label and seen.region is not None:
            self._seen.append((seen, se2.transform(pose, seen.region.place)))

    def add(self, felt: FeltWindows) -> None:
        """Take in a window, the last of its stretch, after the frame at which it was known."""
        around = replace(felt, config=replace(felt.config, stretch_s=STRETCH_S))
        answer, sure = str(around.lasting_answers[-1]), float(np.nan)
        if answer not in SILENT and answer != UNKNOWN:
            sure = float(around.lasting_probabilities[-1].max())
        answer = "" if answer in SILENT else answer
        self._moment_s = float(felt.windows.ends_s[-1]) - STRETCH_S / 2
        camera, share = self._beneath(self._moment_s, float(felt.stamps_s[-1]))
        self.ended = self._so_far.add(self._moment_s, (camera, answer, ""), (share, sure))

    @property
    def lasting(self) -> Contradiction | None:
        """The contradiction that lasts now."""
        lasting = self._so_far.lasting
        goes_on = bool(lasting) and lasting[0].end_s >= self._moment_s - BREAK_S
        return lasting[0] if goes_on else None

    def _beneath(self, moment_s: float, upto_s: float) -> tuple[str, float]:
        """The most frequent label of the places where the robot was, and its mean probability."""
        if not self._poses:
            return "", float("nan")
        stamps_s = np.array([stamp_s for stamp_s, _ in self._poses])
        poses = np.stack([pose for _, pose in self._poses])
        at_s = np.clip([moment_s], stamps_s[0], stamps_s[-1])
        here = Trajectory(stamps_s, poses).at(at_s).poses[0, :2]
        near = [
            label
            for label, place in self._seen
            if np.hypot(*(place - here)) <= self._radius_m and label.stamp_s <= upto_s
        ]
        return most_frequent(near)


class LiveFelt:
    """Feel beside a source of terrain: takes frames in, and gives what is felt.

    Parameters
    ----------
    live : LiveFeel
    source : LiveFeelTerrain or LiveFeelLabels
        Which windows go to.
    radius_m : float
        Of the robot's footprint.
    """

    def __init__(
        self, live: LiveFeel, source: LiveFeelTerrain | LiveFeelLabels, radius_m: float
    ) -> None:
        self.live = live
        self._source = source
        self._contradictions = LiveContradictions(radius_m)
        self._new: Sequence[FeltWindows] = ()

    def before(self, frame: Frame) -> None:
        """Take in a frame before the filter steps to it."""
        self._new = list(self.live.step(frame))
        for felt in self._new:
            self._source.add(felt)

    def after(
        self, stamp_s: float, pose: FloatArray, seen: ImageLabel | None
    ) -> tuple[FeltAnswer | None, Contradiction | None]:
        """After the step: what became known of feel, and the contradiction that lasts."""
        self._contradictions.moved(stamp_s, pose, seen)
        for felt in self._new:
            self._contradictions.add(felt)
        answer = FeltAnswer.of(self._new[-1]) if self._new else None
        return answer, self._contradictions.lasting
