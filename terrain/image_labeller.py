"""The label of the region ahead in one image: region, view from above, classifier."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage
from odometry.estimation.estimate import Estimate
from odometry.frames import Frame
from odometry.run import Robot
from terrain.camera import Camera
from terrain.classification.classifier import Classifier
from terrain.errors import CameraError, ImageError
from terrain.image_label import ImageLabel, answered
from terrain.images import read_image
from terrain.region import NoRegion, Rectangle, RegionConfig, predict_region
from terrain.region_scale import coarsest_m, scale_mismatch
from terrain.run_likeness import RunLikeness
from terrain.warp import ground_view, pixel_view, view_shape


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

    Attributes
    ----------
    seen : RunLikeness
        Whether the images are similar to the training photographs; if not, labels count less.
    """

    def __init__(
        self,
        robot: Robot,
        camera: Camera,
        classifier: Classifier,
        region: RegionConfig,
        folder: Path | None = None,
    ) -> None:
        self.camera = camera
        self.classifier = classifier
        self.seen = RunLikeness(classifier)
        self._robot = robot
        self._region = region
        self._folder = folder
        self._has_answered = False

    def label(self, frame: Frame, estimate: Estimate) -> ImageLabel:
        """Classify the region ahead in the image of a frame.

        An image that cannot be read, a grey one where the classifier needs colour, or one of
        another size among good ones, is an image label without a name, so that one bad file does
        not end a long run.

        Raises
        ------
        CameraError
            If the first image to be classified is not of the camera's size.
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
        try:
            image = read_image(frame.image) if isinstance(frame.image, Path) else frame.image
        except ImageError:
            return ImageLabel(frame.stamp_s, name, region=region, reason="the image cannot be read")
        if not self._is_of_size(image, name or f"the image of {frame.stamp_s} s"):
            reason = "the image is not of the camera's size"
            return ImageLabel(frame.stamp_s, name, region=region, reason=reason)
        if self.classifier.colour_ and image.ndim != 3:
            reason = "the image is grey, the model was trained with colour"
            return ImageLabel(frame.stamp_s, name, region=region, reason=reason)
        views = [self._view(image, r) for r in region.rectangles]
        answers = self.classifier.classify(views)
        self.seen.add(views)
        self._has_answered = True
        return answered(frame.stamp_s, name, region, answers)

    def _name(self, image: Path | ByteImage) -> str:
        if not isinstance(image, Path):
            return ""
        return image.relative_to(self._folder).as_posix() if self._folder else image.as_posix()

    def _is_of_size(self, image: ByteImage, name: str) -> bool:
        """Whether an image is of the camera's size; if the first is not, the camera is wrong."""
        try:
            self.camera.check_size(image)
        except CameraError as error:
            if self._has_answered:
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
