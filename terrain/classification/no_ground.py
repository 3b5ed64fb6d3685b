"""Images that show no terrain: sky, white, black, noise, and what is smoother than the terrain."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage, FloatArray, IntArray
from terrain.images import to_bytes, to_grey
from terrain.texture.box_counting import byte_histogram

OCTAVES = 4  # of texture, finest first
FLOOR = 0.05  # grey levels squared; below it lies rounding
WHITE, BLACK = 250, 5  # grey levels from and to which nothing is shown
LEAST_SHARE = 0.25  # of an image that may be white or black whatever the terrain
BLOCK_PX = 16
# of an octave: white noise has a ratio of 4.2 to 4.6 and an unevenness of 0.05 to 0.13
NOISE_RATIO, NOISE_UNEVENNESS = 3.9, 0.15
NOISE_SHARE = 0.05  # of a terrain's patches that look like noise: it is the terrain's own
# chosen on ground/ and pavements/, so that their figures are no independent test
MARGIN = 0.5  # deviations of a terrain beyond its smoothest patch
LEAST_MARGIN = 0.35  # in logarithms of variance: a fifth in texture
SMOOTH_SHARE, BLUE_SHARE = 0.1, 0.95
BLUER = 0.02

NO_GROUND = "no terrain: "  # begins every reason
OVEREXPOSED, DARK, NOISE, SKY, SMOOTH = (
    NO_GROUND + reason
    for reason in (
        "overexposed",
        "black",
        "noise alone",
        "smooth and blue as a sky",
        "less texture than the terrain it resembles",
    )
)


@dataclass(frozen=True)
class Showing:
    """What an image shows, whatever it is of.

    Attributes
    ----------
    texture : FloatArray, shape (4,)
        Logarithm of the variance of grey in each octave of a Laplacian pyramid, finest first.
    unevenness : float
        Deviation of the logarithm of the finest octave's variance between blocks of 16 px.
    white, black : float
        Shares of the pixels.
    blueness : float
        Mean of blue less red over the sum of the channels; 0 of a grey image.

    References
    ----------
    Burt and Adelson 1983, "The Laplacian pyramid as a compact image code".
    """

    texture: FloatArray
    unevenness: float
    white: float
    black: float
    blueness: float

    @property
    def is_noise(self) -> bool:
        """Whether it may be noise alone."""
        ratio = self.texture[0] - self.texture[2]
        return bool(ratio > NOISE_RATIO and self.unevenness < NOISE_UNEVENNESS)

    @classmethod
    def of(cls, image: ByteImage) -> Self:
        """Of an image, grey or RGB."""
        grey = to_grey(image)
        shares = byte_histogram(grey) / grey.size
        level: AnyArray = grey.astype(np.float32)
        octaves = []
        for _ in range(OCTAVES):
            coarser = np.asarray(cv2.pyrDown(level), np.float32)
            octaves.append((level - cv2.pyrUp(coarser, dstsize=level.shape[::-1])) ** 2)
            level = coarser
        texture = np.log([cv2.mean(octave)[0] + FLOOR for octave in octaves])
        white, black = float(shares[WHITE:].sum()), float(shares[: BLACK + 1].sum())
        return cls(texture, _unevenness(octaves[0]), white, black, _blueness(image))


def _unevenness(energy: AnyArray) -> float:
    rows, columns = (max(1, length // BLOCK_PX) for length in energy.shape)
    blocks = cv2.resize(energy, (columns, rows), interpolation=cv2.INTER_AREA)
    return float(np.log(blocks + FLOOR).std())


def _blueness(image: ByteImage) -> float:
    if image.ndim != 3 or image.shape[2] == 1:
        return 0.0
    red, green, blue = to_bytes(image)[..., :3].reshape(-1, 3).mean(axis=0).tolist()
    return float((blue - red) / (red + green + blue + 1))


@dataclass(frozen=True)
class ShownGround:
    """What the training patches of each terrain show: what an image of it may lack or exceed.

    Attributes
    ----------
    least_texture : FloatArray, shape (classes, 4)
    most_white, most_black : FloatArray, shape (classes,)
    noise : FloatArray, shape (classes,)
        Share of the patches that may be noise alone.
    smooth : FloatArray, shape (classes,)
        Mean of the three coarser octaves below which a patch is smooth for its terrain.
    most_blue : FloatArray, shape (classes,)
        Of smooth images; 1, which none exceeds, where training images had no colour.
    """

    least_texture: FloatArray
    most_white: FloatArray
    most_black: FloatArray
    noise: FloatArray
    smooth: FloatArray
    most_blue: FloatArray

    @classmethod
    def of(cls, patches: Sequence[ByteImage], codes: IntArray) -> Self:
        """Of patches with terrains (n,)."""
        shown = [Showing.of(patch) for patch in patches]
        texture = np.array([of.texture for of in shown])
        others = np.array([(of.white, of.black, of.is_noise, of.blueness) for of in shown])
        rows = [_limits(texture[codes == c], others[codes == c]) for c in np.unique(codes)]
        return cls(*(np.array(column) for column in zip(*rows, strict=True)))

    def lacks(self, patches: Sequence[ByteImage], code: int) -> str:
        """Why most patches of an image with a name show no terrain; "" where it may be of it."""
        reasons = [self.lacks_in(Showing.of(patch), code) for patch in patches]
        if 2 * reasons.count("") >= len(reasons):
            return ""
        return Counter(reason for reason in reasons if reason).most_common(1)[0][0]

    def lacks_in(self, shown: Showing, code: int) -> str:
        """Why a patch with a name shows no terrain; "" where it may be of it."""
        octaves = shown.texture
        if shown.white > self.most_white[code]:
            return OVEREXPOSED
        if shown.black > self.most_black[code]:
            return DARK
        if shown.is_noise and self.noise[code] < NOISE_SHARE:
            return NOISE
        if octaves[1:].mean() < self.smooth[code] and shown.blueness > self.most_blue[code]:
            return SKY
        return SMOOTH if np.any(octaves < self.least_texture[code]) else ""

    def arrays(self) -> dict[str, AnyArray]:
        """Everything learned, by name."""
        return {f"shown_{field.name}": getattr(self, field.name) for field in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, AnyArray], classes: int) -> Self | None:
        """Rebuild from what `arrays` gave; None of files before version 0.14, which have none.

        Raises
        ------
        KeyError, ValueError
            If the arrays do not fit.
        """
        if "shown_least_texture" not in arrays:
            return None
        limits = [arrays[f"shown_{field.name}"] for field in fields(cls)]
        shapes = [limit.shape for limit in limits]
        if shapes != [(classes, OCTAVES)] + [(classes,)] * (len(limits) - 1):
            raise ValueError(f"what {classes} terrains show has shapes {shapes}")
        return cls(*limits)


def _limits(texture: FloatArray, others: FloatArray) -> tuple[AnyArray | float, ...]:
    """The limits of a terrain by its patches (n, 4) twice."""
    margin = np.maximum(MARGIN * texture.std(axis=0), LEAST_MARGIN)
    white, black, noise, blueness = others.T
    return (
        texture.min(axis=0) - margin,
        max(float(white.max()), LEAST_SHARE),
        max(float(black.max()), LEAST_SHARE),
        float(noise.mean()),
        float(np.quantile(texture[:, 1:].mean(axis=1), SMOOTH_SHARE)),
        max(float(np.quantile(blueness, BLUE_SHARE)), 0.0) + BLUER if blueness.any() else 1.0,
    )


def no_ground_note(reasons: Sequence[str]) -> str | None:
    """How many of the images show no terrain, and why; None where all may.

    `reasons` are those of each image for its label, "" where there is none.
    """
    of = [reason for reason in dict.fromkeys(reasons) if reason.startswith(NO_GROUND)]
    counts = {reason.removeprefix(NO_GROUND): reasons.count(reason) for reason in of}
    if not counts:
        return None
    words = ", ".join(f"{reason} ({count})" for reason, count in counts.items())
    return (
        f"{sum(counts.values())} of {len(reasons)} images show no terrain and are unknown: {words}"
    )
