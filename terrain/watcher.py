"""The watcher: frame and estimate in, the name of the terrain in force out."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.estimation.estimate import Estimate
from odometry.estimation.transition import transition
from odometry.footing import Footing
from odometry.frames import Frame
from odometry.geometry import se2
from odometry.run import UNKNOWN, Run
from terrain.camera import Camera
from terrain.classification.classifier import Classification, Classifier
from terrain.errors import CameraError, ImageError
from terrain.images import read_image
from terrain.places import Footprint, Sight
from terrain.region import Rectangle, Region, RegionConfig, predict_region
from terrain.suited import coarsest_m, unsuited
from terrain.switch import Switch, SwitchConfig, SwitchEvent
from terrain.warp import ground_view, pixel_view


@dataclass(frozen=True)
class Sighting:
    """What one image said of the terrain ahead.

    Attributes
    ----------
    stamp_s : float
    image : str
        File of the image, as images.csv names it.
    label : str
        A terrain, `unknown`, or "" where there was nothing to classify.
    confidence : float
        Probability of the most probable terrain; NaN without a label.
    region : Region or None
        In the robot frame at this stamp.
    reason : str
        Why there is no label, or what `unknown` means here; else "".
    left, right : str
        Labels of the tread strips, where they were classified apart.
    probabilities : Mapping of str to float
        What the classifier gave to each terrain, where it was asked once.
    class_distance : float
        Distance to the nearest class, which the rejection threshold judges; of tread strips that
        were classified apart the larger one. NaN without a label.
    """

    stamp_s: float
    image: str
    label: str = ""
    confidence: float = float("nan")
    region: Region | None = None
    reason: str = ""
    left: str = ""
    right: str = ""
    probabilities: Mapping[str, float] = field(default_factory=dict)
    class_distance: float = float("nan")


class TerrainWatcher:
    """Classifies the region ahead in every image and switches the terrain in force.

    Parameters
    ----------
    run : Run
    camera : Camera
    classifier : Classifier
        Fitted.
    initial : str
        The terrain in force until the first switch.
    region : RegionConfig
    switch : SwitchConfig

    Attributes
    ----------
    classifier : Classifier
    sightings : list of Sighting
        One for each image that was seen.
    in_force : list of str
        The terrain in force after each sighting.
    events : list of SwitchEvent
    """

    def __init__(
        self,
        run: Run,
        camera: Camera,
        classifier: Classifier,
        initial: str,
        *,
        region: RegionConfig,
        switch: SwitchConfig,
    ) -> None:
        self.initial = initial
        self.sightings: list[Sighting] = []
        self.in_force: list[str] = []
        self.events: list[SwitchEvent] = []
        self._run = run
        self._camera = camera
        self.classifier = classifier
        self._region = region
        footprint = Footprint.of(run.robot, region.footprint_scale)
        self._switch = Switch(initial, footprint, switch)
        self._pose = np.zeros(3)  # of the last estimate, in the odometry frame
        self._last: Estimate | None = None
        self._travel_m = run.wheel_travel_m

    def terrain(self, frame: Frame, estimate: Estimate) -> Footing:
        """Look at the frame's image, if it has one, and tell what the robot stands on."""
        travel_m = float(np.interp(frame.stamp_s, self._run.odometry.stamps_s, self._travel_m))
        pose = self._pose_at(frame, estimate)
        if frame.in_gap:
            self._switch = self._switch.astray()
        if frame.image is not None:
            sighting = self.look(frame, estimate)
            self.sightings.append(sighting)
            if sighting.label and sighting.region is not None:
                sight = _sight(sighting, sighting.region, pose, travel_m)
                self._switch = self._switch.see(sight)
        self._switch = self._switch.at(frame.stamp_s, pose, travel_m)
        if self._switch.event is not None:
            self.events.append(self._switch.event)
        if frame.image is not None:
            self.in_force.append(self._switch.footing.terrain)
        return self._switch.footing

    def _pose_at(self, frame: Frame, estimate: Estimate) -> FloatArray:
        """The robot at a frame in the odometry frame, by what the filter believed of each step."""
        if self._last is not None:
            believed = estimate.believed_yaw_rate_rad_s
            self._pose = _carried(self._pose, self._last, estimate.stamp_s, believed)
        self._last = estimate
        return _carried(self._pose, estimate, frame.stamp_s, frame.yaw_rate_rad_s)

    def look(self, frame: Frame, estimate: Estimate) -> Sighting:
        """Classify the region ahead in the image of a frame.

        An image that cannot be read, a grey one where the classifier needs colour, or one of
        another size among good ones, is a sighting without a label, so that one bad file does
        not end a long run.

        Raises
        ------
        CameraError
            If the first image to be classified is not of the camera's size.
        """
        if frame.image is None:
            raise ValueError(f"the frame at {frame.stamp_s} s has no image")
        name = frame.image.relative_to(self._run.folder).as_posix()
        if not np.all(np.isfinite(frame.tread_speeds_m_s)):
            return Sighting(frame.stamp_s, name, reason="the tread speeds are not known")
        commanded = replace(estimate, tread_speeds_m_s=frame.tread_speeds_m_s)
        region = predict_region(
            self._run.robot,
            self._camera,
            commanded.twist,
            float(np.abs(frame.tread_speeds_m_s).mean()),
            self._region,
            coarsest_m=coarsest_m(self.classifier, self._region.coarsest),
            unsuited=self._unsuited,
        )
        if isinstance(region, str):
            return Sighting(frame.stamp_s, name, reason=region)
        try:
            image = read_image(frame.image)
        except ImageError:
            return Sighting(frame.stamp_s, name, region=region, reason="the image cannot be read")
        if not self._is_of_size(image, frame.image):
            reason = "the image is not of the camera's size"
            return Sighting(frame.stamp_s, name, region=region, reason=reason)
        if self.classifier.colour_ and image.ndim != 3:
            reason = "the image is grey, the model was trained with colour"
            return Sighting(frame.stamp_s, name, region=region, reason=reason)
        answers = self.classifier.classify([self._view(image, r) for r in region.rectangles])
        return _sighting(frame.stamp_s, name, region, answers)

    def _is_of_size(self, image: ByteImage, file: Path) -> bool:
        """Whether an image is of the camera's size; if the first is not, the camera is wrong."""
        try:
            self._camera.check_size(image)
        except CameraError as error:
            if any(sighting.label for sighting in self.sightings):
                return False
            raise CameraError(f"{file}: {error}; see [camera] image_size in run.toml") from error
        return True

    def _unsuited(self, rectangle: Rectangle) -> str:
        return unsuited(self.classifier, self._camera, rectangle, self._region.coarsest)

    def _view(self, image: ByteImage, rectangle: Rectangle) -> ByteImage:
        scale = self.classifier.metres_per_pixel
        if scale is None:
            return pixel_view(image, self._camera, rectangle)
        return ground_view(image, self._camera, rectangle, scale)


def _sighting(stamp_s: float, name: str, region: Region, answers: list[Classification]) -> Sighting:
    if len(answers) == 1:
        answer = answers[0]
        return Sighting(
            stamp_s,
            name,
            answer.label,
            answer.confidence,
            region,
            probabilities=answer.probabilities,
            class_distance=answer.distance,
        )
    distance = max(answer.distance for answer in answers)
    left, right = (answer.label for answer in answers)
    confidence = min(answer.confidence for answer in answers)
    if left == right:
        return Sighting(
            stamp_s, name, left, confidence, region, "", left, right, class_distance=distance
        )
    reason = f"astride: {left} on the left, {right} on the right"
    return Sighting(
        stamp_s, name, UNKNOWN, confidence, region, reason, left, right, class_distance=distance
    )


def _carried(
    pose: FloatArray, estimate: Estimate, stamp_s: float, yaw_rate_rad_s: float
) -> FloatArray:
    """A pose (3,) of the odometry frame at an estimate, carried to a later stamp."""
    if not np.all(np.isfinite(estimate.tread_speeds_m_s)):
        return pose
    state, _ = transition(
        np.concatenate([pose, estimate.mean[3:]]),
        estimate.tread_speeds_m_s,
        stamp_s - estimate.stamp_s,
        yaw_rate_rad_s=yaw_rate_rad_s,
        added_speeds=estimate.added_speeds_m_s,
        added_twist=estimate.added_twist,
    )
    return state[:3]


def _sight(sighting: Sighting, region: Region, pose: FloatArray, travel_m: float) -> Sight:
    return Sight(
        sighting.label,
        sighting.stamp_s,
        travel_m,
        se2.transform(pose, region.place),
        region.distance_ahead_m,
        sighting.probabilities,
    )
