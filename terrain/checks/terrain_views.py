"""Features of the terrain in images of a run, each image decoded once, and the same in two."""

from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.io.files import read_bytes
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.image_files import MOST_BYTES
from terrain.errors import ImageError
from terrain.image_labels.still_image import details_of
from terrain.image_size import stated_size

WIDTH_PX = 320  # larger images are reduced to it: their details say no more of the motion
REDUCED = {
    1: cv2.IMREAD_GRAYSCALE,
    2: cv2.IMREAD_REDUCED_GRAYSCALE_2,
    4: cv2.IMREAD_REDUCED_GRAYSCALE_4,
    8: cv2.IMREAD_REDUCED_GRAYSCALE_8,
}
FEATURES, CONTRAST = 400, 7  # of an image, and the grey levels of the weakest: sand is smooth
DISTINCT = 0.8  # distance of a feature to its like, over that to the next like it
FEWEST = 12  # features that move as one piece of terrain
FARTHEST = 6.0  # of the camera's height: how far terrain is looked at

Pixels = tuple[FloatArray, FloatArray]  # (N, 2) and (N, 2), the same terrain in two images
Features = tuple[FloatArray, AnyArray]  # pixels (N, 2), and what is there
# Standard deviation of the details of `details_of` [grey levels]: lenses that are covered, and
# nights, have 0.2 to 0.8, photographs of the smoothest asphalt 1.5, fog 2
TEXTURE = 1.0
# Of it over that of details below FINE_PX: terrain has 0.3 and more, noise alone 0.13
NOT_NOISE, FINE_PX = 0.2, 3.0


@dataclass(frozen=True, eq=False)
class TerrainViews:
    """Images of a run, by what is distinct in them.

    Attributes
    ----------
    run : Run
    size : (int, int)
        Of the camera's images; others are not looked at.
    turned : bool
        Whether images are taken as turned by half a turn.
    """

    run: Run
    size: tuple[int, int]
    turned: bool = False
    _kept: dict[str, "_Seen | None"] = field(default_factory=dict, repr=False)
    _near: dict[tuple[Camera, str], Features | None] = field(
        default_factory=dict, init=False, repr=False
    )

    def upside_down(self) -> "TerrainViews":
        """The same images, turned by half a turn."""
        return replace(self, turned=not self.turned)

    def features(self, name: str) -> Features | None:
        """Features of an image file; None where there are none, or it is of another size."""
        seen = self._seen(name)
        return None if seen is None else seen.features

    def details(self, name: str) -> FloatArray | None:
        """`details_of` of an image file; None where it is of another size."""
        seen = self._seen(name)
        return None if seen is None else seen.details

    def is_blank(self, name: str) -> bool:
        """Whether an image shows nothing, or noise alone."""
        seen = self._seen(name)
        return seen is not None and seen.is_blank

    def _seen(self, name: str) -> "_Seen | None":
        if name not in self._kept:
            image = self._decoded(name)
            self._kept[name] = None if image is None else self._looked_at(image)
        return self._kept[name]

    def same(self, camera: Camera, first: str, second: str) -> Pixels | None:
        """Pixels of features on near terrain that look alike in two images, if there are enough."""
        before, after = (self._near_features(camera, name) for name in (first, second))
        if before is None or after is None or min(len(before[0]), len(after[0])) < FEWEST:
            return None
        pairs = cv2.BFMatcher(cv2.NORM_HAMMING).knnMatch(before[1], after[1], k=2)
        alike = [one for one, other in pairs if one.distance < DISTINCT * other.distance]
        if len(alike) < FEWEST:
            return None
        here = before[0][[one.queryIdx for one in alike]]
        return here, after[0][[one.trainIdx for one in alike]]

    def _near_features(self, camera: Camera, name: str) -> Features | None:
        """Those of near terrain, looked for once by each camera."""
        if (camera, name) not in self._near:
            self._near[camera, name] = self._near_by(camera, self.features(name))
        return self._near[camera, name]

    def _near_by(self, camera: Camera, found: Features | None) -> Features | None:
        if found is None:
            return None
        pixels = np.array(self.size) - 1.0 - found[0] if self.turned else found[0]
        places = camera.pixels_to_ground(pixels)
        near = np.linalg.norm(places, axis=1) < FARTHEST * camera.height_m
        near &= camera.shows_terrain(pixels)
        return pixels[near], found[1][near]

    def _looked_at(self, image: AnyArray) -> "_Seen":
        orb = cv2.ORB.create(FEATURES, fastThreshold=CONTRAST)
        found, described = orb.detectAndCompute(image, None)
        details = details_of(image)
        texture = float(details.std())
        fine = image - cv2.GaussianBlur(image.astype(np.float32), (0, 0), FINE_PX)
        blank = texture < max(TEXTURE, NOT_NOISE * float(fine.std()))
        if not found:
            return _Seen(image, None, details, blank)
        pixels = np.array([one.pt for one in found], dtype=np.float64)
        pixels = (pixels + 0.5) * self.size[0] / image.shape[1] - 0.5
        return _Seen(image, (pixels, described), details, blank)

    def grey(self, name: str) -> AnyArray | None:
        """An image of the camera's size, reduced, in grey."""
        seen = self._kept.get(name)
        return self._decoded(name) if seen is None else seen.image

    def _decoded(self, name: str) -> AnyArray | None:
        try:
            file = self.run.folder / name
            encoded = read_bytes(file, ImageError, MOST_BYTES, "an image has less")
        except ImageError:
            return None
        if stated_size(encoded) != self.size:
            return None
        width = self.size[0]
        flag = REDUCED[max(by for by in REDUCED if by == 1 or width / by >= WIDTH_PX)]
        how = flag | cv2.IMREAD_IGNORE_ORIENTATION
        try:
            image = cv2.imdecode(np.frombuffer(encoded, np.uint8), how)
        except cv2.error:
            return None
        if image is None or image.shape[1] <= WIDTH_PX:
            return image
        height = round(image.shape[0] * WIDTH_PX / image.shape[1])
        return np.asarray(cv2.resize(image, (WIDTH_PX, height), interpolation=cv2.INTER_AREA))


@dataclass(frozen=True, eq=False)
class _Seen:
    """What is kept of an image."""

    image: AnyArray
    features: Features | None
    details: FloatArray
    is_blank: bool
