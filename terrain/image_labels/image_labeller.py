"""The label of the region ahead in one image: region, view from above, classifier."""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.estimation.estimate import Estimate
from odometry.recording.frames import Frame
from odometry.recording.run import UNKNOWN, Robot
from terrain.camera.camera import Camera
from terrain.classification.answer import ONE_CHANNEL, Classifier
from terrain.classification.likeness.likeness import Likeness
from terrain.classification.likeness.look import look_of, middle_of
from terrain.classification.photographs.trained_on import as_images
from terrain.classification.training_light import unless_by_light
from terrain.errors import CameraError, ImageError
from terrain.image_labels.details_watch import DetailsWatch
from terrain.image_labels.image_label import ImageLabel, answered
from terrain.image_labels.still_image import StillWatch
from terrain.image_labels.terrain_details import reduced
from terrain.images import as_stored, read_image
from terrain.region.region import NoRegion, Rectangle, RegionConfig, predict_region
from terrain.region.warp import coarsest_m, ground_view, pixel_view, scale_mismatch, view_shape

if TYPE_CHECKING:
    from terrain.classification.likeness.colour_range import ColourRange
    from terrain.classification.likeness.training_look import TrainingLook

KEPT, LATEST = 200, 10  # statistics of the latest images, and of those in one light
# ground/ to pavements/, standardised: 0.47 right of four terrains is 0.3 of the way from chance
WORTH_OF_UNLIKE = 0.3
# `Likeness.beyond` of drives over held-out photographs of the own camera is 1.5 at most
FAR = 1.5
OTHER_SIZE = "the image is not of the camera's size"
LOST_DETAILS = "the image lost details of the terrain: fog, a wet lens, another focus"


class RunLikeness:
    """Statistics of the regions that were classified in a run.

    Parameters
    ----------
    classifier : Classifier
        Without statistics of its training photographs there is no comparison.
    """

    def __init__(self, classifier: Classifier) -> None:
        self._training: TrainingLook | None = getattr(classifier, "training_look_", None)
        self._classifier = classifier
        self._range: ColourRange | None = getattr(classifier, "colour_range_", None)
        self._of_colours: deque[FloatArray] = deque(maxlen=KEPT)
        self._looks: deque[FloatArray] = deque(maxlen=KEPT)
        self._differences: deque[FloatArray] = deque(maxlen=KEPT)

    def add(self, views: Sequence[ByteImage]) -> None:
        """Add the regions of one image."""
        if self._training is not None:
            middles = [middle_of(view, self._classifier.patch_size_px) for view in views]
            look = np.mean([look_of(middle) for middle in middles], axis=0)
            if self._range is not None:
                self._of_colours.append(self._range.measures(middles))
            self._looks.append(look)
            self._differences.append(self._training.differences(look[None])[0])

    @property
    def likeness(self) -> Likeness | None:
        """Of the images so far; None where there is no comparison."""
        if self._training is None:
            return None
        likeness = self._training.summary(np.array(self._looks), np.array(self._differences))
        if self._range is None:
            return likeness
        return self._range.compared(likeness, np.array(self._of_colours))

    @property
    def latest(self) -> Likeness | None:
        """Of the last ten images, where the light changes along the way."""
        if self._training is None:
            return None
        looks, differences = list(self._looks)[-LATEST:], list(self._differences)[-LATEST:]
        return self._training.summary(np.array(looks), np.array(differences))

    @property
    def is_far(self) -> bool:
        """Whether the images are so unlike the photographs that any without a name counts."""
        likeness = self.likeness
        return likeness is not None and likeness.beyond is not None and likeness.beyond > FAR

    def weighed(self, label: str, probabilities: Mapping[str, float]) -> Mapping[str, float]:
        """Probabilities of each terrain by a label; closer to chance where images are unlike.

        Those of a classifier that learned what they are worth there stay as they are.
        """
        if getattr(self._classifier, "confidence_", None) is not None:
            return probabilities
        given = probabilities or ({} if label == UNKNOWN else {label: 1.0})
        likeness = self.likeness
        if likeness is None or not likeness.is_unlike or not given:
            return probabilities
        names = list(map(str, self._classifier.classes_))
        chance = (1 - WORTH_OF_UNLIKE) / len(names)
        return {name: WORTH_OF_UNLIKE * given.get(name, 0.0) + chance for name in names}


class ImageLabeller:
    """Classifies the region ahead in images of one camera.

    Parameters
    ----------
    robot : Robot
    camera : Camera
    classifier : Classifier
        Fitted.
    region : RegionConfig
    folder : Path, optional
        What names of image files are relative to.
    first_must_fit : bool
        Whether a first image of another size is an error: then the camera is wrong. A robot that
        drives goes on without a label.

    Attributes
    ----------
    seen : RunLikeness
        Whether the images are similar to the training photographs; if not, doubtful names are
        unknown.
    """

    def __init__(
        self,
        robot: Robot,
        camera: Camera,
        classifier: Classifier,
        region: RegionConfig,
        folder: Path | None = None,
        *,
        first_must_fit: bool = True,
    ) -> None:
        self.camera = camera
        self.classifier = classifier
        self.seen = RunLikeness(classifier)
        self._robot = robot
        self._region = region
        self._folder = folder
        self._may_differ = not first_must_fit
        self._before: ByteImage | None = None
        self._still, self._details = StillWatch(camera), DetailsWatch(camera)

    def label(self, frame: Frame, estimate: Estimate, pose: FloatArray | None = None) -> ImageLabel:
        """Classify the region ahead in the image of a frame.

        An image that cannot be read, a grey one where the classifier needs colour, one of another
        size among good ones, or one that equals the one before, is an image label without a name,
        so that one bad file does not end a long run. So is one that stays the same although the
        robot moves, or that lost details of the terrain, by its pose (3,), if that is given.

        Raises
        ------
        CameraError
            If the first image to be classified is not of the camera's size, and must be.
        """
        if frame.image is None:
            raise ValueError(f"the frame at {frame.stamp_s} s has no image")
        name = self._name(frame.image)
        if not np.all(np.isfinite(frame.tread_speeds_m_s)):
            return ImageLabel(frame.stamp_s, name, reason="the tread speeds are not known")
        commanded = replace(estimate, tread_speeds_m_s=frame.tread_speeds_m_s)
        region = predict_region(
            self._robot,
            self.camera,
            commanded.twist,
            float(np.abs(frame.tread_speeds_m_s).mean()),
            self._region,
            coarsest_m=coarsest_m(self.classifier, self._region.coarsest),
            scale_mismatch=self._scale_mismatch,
        )
        if isinstance(region, NoRegion):
            return ImageLabel(frame.stamp_s, name, reason=region.reason)
        image = self._read(frame.image, name or f"the image of {frame.stamp_s} s")
        if not isinstance(image, str) and pose is not None:
            image = self._fault(image, pose) or image
        if isinstance(image, str):
            return ImageLabel(frame.stamp_s, name, region=region, reason=image)
        views = [self._view(image, r) for r in region.rectangles]
        answers = self.classifier.classify(views)
        self.seen.add(views)
        self._may_differ = True
        likeness = self.seen.likeness
        share = getattr(self.classifier, "noticed_share_", None)
        answers = [answer.unless_doubtful(likeness, share) for answer in answers]
        for of in (likeness, self.seen.latest):
            answers = unless_by_light(self.classifier, views, answers, of)
        return answered(frame.stamp_s, name, region, answers)

    def _name(self, image: Path | ByteImage) -> str:
        if not isinstance(image, Path):
            return ""
        return image.relative_to(self._folder).as_posix() if self._folder else image.as_posix()

    def _read(self, image: Path | ByteImage, name: str) -> ByteImage | str:
        """The image, or why it is not classified."""
        try:
            image = read_image(image) if isinstance(image, Path) else as_stored(*as_images([image]))
        except ImageError:
            return "the image cannot be read"
        if self._repeats(image):
            return "the image is the one before"
        if not self._is_of_size(image, name):
            return OTHER_SIZE
        if self.classifier.colour_ and image.ndim != 3:
            return ONE_CHANNEL
        return image

    def _fault(self, image: ByteImage, pose: FloatArray) -> str:
        """Why an image shows no terrain ahead that may be named, by those before it; or ""."""
        small = reduced(image)
        has_lost = self._details.has_lost(small, pose)
        if self._still.stays(small, pose):
            return "the image stays the same while the treads move"
        return LOST_DETAILS if has_lost else ""

    def _repeats(self, image: ByteImage) -> bool:
        """Whether an image equals the one before: a camera that is frozen shows nothing new."""
        before, self._before = self._before, image
        return before is not None and np.array_equal(before, image)

    def _is_of_size(self, image: ByteImage, name: str) -> bool:
        """Whether an image is of the camera's size; if the first is not, the camera is wrong."""
        try:
            self.camera.check_size(image)
        except CameraError as error:
            if self._may_differ:
                return False
            raise CameraError(f"{name}: {error}; see [camera] image_size in run.toml") from error
        return True

    def _scale_mismatch(self, rectangle: Rectangle) -> str:
        return scale_mismatch(self.classifier, self.camera, rectangle, self._region.coarsest)

    def _view(self, image: ByteImage, rectangle: Rectangle) -> ByteImage:
        scale = self.classifier.metres_per_pixel
        if scale is None:
            return pixel_view(image, self.camera, rectangle)
        middle = self.classifier.middle_used(view_shape(rectangle, scale))
        return ground_view(image, self.camera, rectangle, scale, middle)
