"""From brightness to the bytes of a camera: lens blur, illumination, noise, JPEG."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from terrain.errors import SynthesisError

BLUR_PX = 0.5
NOISE_GREY_LEVELS = 2.0


@dataclass(frozen=True)
class Illumination:
    """Light on one frame.

    Attributes
    ----------
    gain : float
        Factor on the brightness.
    slope : float
        Relative change of the gain from the middle to the right edge of the image.
    """

    gain: float
    slope: float

    @classmethod
    def at(cls, time_s: float, phases_rad: tuple[float, float]) -> Self:
        """Light that changes slowly along a run, as under passing clouds."""
        gain = 1.0 + 0.08 * np.sin(2 * np.pi * time_s / 31.0 + phases_rad[0])
        return cls(float(gain), float(0.05 * np.sin(2 * np.pi * time_s / 17.0 + phases_rad[1])))


def expose(brightness: AnyArray, light: Illumination, rng: np.random.Generator) -> ByteImage:
    """Image (H, W) or (H, W, 3) of a scene of `brightness` (0 to 255) in this light."""
    width = brightness.shape[1]
    gain = light.gain * (1 + light.slope * np.linspace(-1, 1, width, dtype=np.float32))
    gain = gain if brightness.ndim == 2 else gain[:, None]
    blurred = cv2.GaussianBlur(brightness, (0, 0), BLUR_PX)
    noise = rng.standard_normal(brightness.shape, dtype=np.float32)
    exposed = np.rint(blurred * gain + NOISE_GREY_LEVELS * noise)
    return np.asarray(np.clip(exposed, 0, 255), dtype=np.uint8)


def encode_jpeg(image: ByteImage, quality: int) -> bytes:
    """JPEG file of a grey (H, W) or RGB (H, W, 3) image."""
    stored = image if image.ndim == 2 else np.ascontiguousarray(image[..., ::-1])
    done, encoded = cv2.imencode(".jpg", stored, [cv2.IMWRITE_JPEG_QUALITY, quality])
    if not done:
        raise SynthesisError(f"an image of shape {image.shape} could not be encoded as JPEG")
    return bytes(encoded)


def jpeg_image(encoded: bytes) -> ByteImage:
    """Image (H, W) or RGB (H, W, 3) of a JPEG file."""
    image = np.asarray(cv2.imdecode(np.frombuffer(encoded, np.uint8), cv2.IMREAD_UNCHANGED))
    return image if image.ndim == 2 else np.ascontiguousarray(image[..., ::-1])
