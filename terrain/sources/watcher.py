"""The watcher: frame and estimate in, the name of the terrain in force out."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import Estimate
from odometry.estimation.transition import moved_pose
from odometry.geometry import se2
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Robot
from odometry.recording.run_terrains import Footing
from terrain.camera.camera import Camera
from terrain.classification.answer import Classifier
from terrain.image_labels.distance_track import DistanceTrack
from terrain.image_labels.image_label import ImageLabel
from terrain.image_labels.image_labeller import ImageLabeller
from terrain.region.region import Region, RegionConfig
from terrain.switch.feel_labels import FeltPlaces
from terrain.switch.place_labels import Footprint, PlaceLabel
from terrain.switch.switch import Switch, SwitchConfig, SwitchEvent


class TerrainWatcher:
    """Classifies the region ahead in every image and switches the terrain in force.

    Parameters
    ----------
    robot : Robot
    camera : Camera
    classifier : Classifier
        Fitted.
    initial : str
        The terrain in force until the first switch, as long as labels support it; `unknown` where
        nobody named one.
    region : RegionConfig
    switch : SwitchConfig
    folder : Path, optional
        What names of image files are relative to.
    keep : int, optional
        How many of the latest image labels and events are kept; by default all.
    felt : FeltPlaces, optional
        Terrain by feel, as one more source.

    Attributes
    ----------
    classifier : Classifier
    image_labels : list of ImageLabel
        One for each image.
    in_force : list of str
        The terrain in force after each image label.
    events : list of SwitchEvent
    footprint : Footprint
    seen : RunLikeness
        Whether the images are similar to the training photographs; if not, doubtful names are
        unknown.
    """

    def __init__(
        self,
        robot: Robot,
        camera: Camera,
        classifier: Classifier,
        initial: str,
        *,
        region: RegionConfig,
        switch: SwitchConfig,
        folder: Path | None = None,
        keep: int | None = None,
        felt: FeltPlaces | None = None,
    ) -> None:
        self.initial = initial
        self.image_labels: list[ImageLabel] = []
        self.in_force: list[str] = []
        self.events: list[SwitchEvent] = []
        self.classifier = classifier
        self._labeller = ImageLabeller(
            robot, camera, classifier, region, folder, first_must_fit=keep is None
        )
        self.seen = self._labeller.seen
        self._track = DistanceTrack(classifier)
        self._keep = keep
        self._felt = felt
        self._felt_upto_s = -math.inf
        self.footprint = Footprint.of(robot, region.footprint_scale)
        self._switch = Switch(initial, self.footprint, switch)
        self._pose = np.zeros(3)  # of the last estimate, in the odometry frame
        self._last: Estimate | None = None
        self._frame: Frame | None = None
        self._travel_m = 0.0

    def terrain(self, frame: Frame, estimate: Estimate) -> Footing:
        """Classify the frame's image, if it has one, and return the terrain under the robot."""
        self._travel_m += self._travelled_m(frame)
        travel_m = self._travel_m
        pose = self._pose_at(frame, estimate)
        if frame.in_gap:
            self._switch = self._switch.without_labels()
        if frame.image is not None:
            image_label = self._track.judged(self.look(frame, estimate, pose), travel_m)
            self.image_labels.append(image_label)
            if image_label.label and image_label.region is not None:
                given = self.seen.weighed(image_label.label, image_label.probabilities)
                place_label = _place_label(
                    image_label,
                    image_label.region,
                    given,
                    pose,
                    travel_m,
                    is_evidence=self._is_evidence(image_label),
                )
                self._switch = self._switch.add_label(self._beside(place_label))
        self._feel(frame, pose)
        self._switch = self._switch.at(frame.stamp_s, pose, travel_m)
        if self._switch.event is not None:
            self.events.append(self._switch.event)
        if frame.image is not None:
            self.in_force.append(self._switch.footing.terrain)
        if self._keep is not None:
            for one in (self.image_labels, self.in_force, self.events):
                del one[: -self._keep]
        return self._switch.footing

    def _is_evidence(self, image_label: ImageLabel) -> bool:
        """Whether a label says something of the terrain.

        Beside feel ``unknown`` does not: a terrain that feel alone knows resembles none that the
        camera knows. Where the images are far from training, doubtful names speak for no terrain.
        """
        if image_label.label == UNKNOWN and self._felt is not None:
            return False
        return image_label.is_evidence or (self.seen.is_far and not image_label.is_astride)

    def _beside(self, place_label: PlaceLabel) -> PlaceLabel:
        """A label that gives no evidence on terrains which only feel can name."""
        if self._felt is None:
            return place_label
        return replace(place_label, probabilities=self._felt.beside(place_label.probabilities))

    def _feel(self, frame: Frame, pose: FloatArray) -> None:
        """Add the labels by feel up to a frame."""
        if self._felt is None:
            return
        after_s, self._felt_upto_s = self._felt_upto_s, frame.stamp_s
        for place_label in self._felt.between(after_s, frame.stamp_s, pose, self._travel_m):
            self._switch = self._switch.add_label(place_label)

    @property
    def event(self) -> SwitchEvent | None:
        """The switch at the latest frame, if any."""
        return self._switch.event

    def _travelled_m(self, frame: Frame) -> float:
        """Wheel travel since the frame before at its speeds; none where they are not known."""
        before, self._frame = self._frame, frame
        if before is None:
            return 0.0
        left, right = before.tread_speeds_m_s.tolist()
        travel_m = (abs(left) + abs(right)) / 2 * (frame.stamp_s - before.stamp_s)
        return travel_m if math.isfinite(travel_m) else 0.0

    def _pose_at(self, frame: Frame, estimate: Estimate) -> FloatArray:
        """The robot at a frame in the odometry frame, by the filter's yaw rate at each step."""
        if self._last is not None:
            believed = estimate.believed_yaw_rate_rad_s
            self._pose = _carried(self._pose, self._last, estimate.stamp_s, believed)
        self._last = estimate
        return _carried(self._pose, estimate, frame.stamp_s, frame.yaw_rate_rad_s)

    def look(self, frame: Frame, estimate: Estimate, pose: FloatArray | None = None) -> ImageLabel:
        """Classify the region ahead in the image of a frame; see `ImageLabeller.label`."""
        return self._labeller.label(frame, estimate, pose)


def _carried(
    pose: FloatArray, estimate: Estimate, stamp_s: float, yaw_rate_rad_s: float
) -> FloatArray:
    """A pose (3,) of the odometry frame at an estimate, carried to a later stamp."""
    if not math.isfinite(sum(estimate.tread_speeds_m_s.tolist())):
        return pose
    return moved_pose(
        pose,
        estimate.mean,
        estimate.tread_speeds_m_s,
        stamp_s - estimate.stamp_s,
        yaw_rate_rad_s=yaw_rate_rad_s,
        added_speeds=estimate.added_speeds_m_s,
        added_twist=estimate.added_twist,
    )


def _place_label(
    image_label: ImageLabel,
    region: Region,
    given: Mapping[str, float],
    pose: FloatArray,
    travel_m: float,
    *,
    is_evidence: bool,
) -> PlaceLabel:
    return PlaceLabel(
        image_label.label,
        image_label.stamp_s,
        travel_m,
        se2.transform(pose, region.place),
        region.distance_ahead_m,
        given,
        is_evidence=is_evidence,
    )
