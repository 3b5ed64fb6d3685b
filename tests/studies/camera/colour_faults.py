"""Photographs as a camera gives them that is set or read wrong, and in other lights."""

from collections.abc import Callable

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage

Change = Callable[[ByteImage], ByteImage]


def as_bytes(values: AnyArray) -> ByteImage:
    """Rounded, from black to white."""
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def gains(red: float, green: float, blue: float) -> Change:
    """Each channel times a factor."""
    return lambda image: as_bytes(image * np.array([red, green, blue]))


def power(exponent: float) -> Change:
    """Grey to a power."""
    return lambda image: as_bytes(255 * (image / 255.0) ** exponent)


def order(*channels: int) -> Change:
    """Channels in another order."""
    return lambda image: np.ascontiguousarray(image[..., list(channels)])


def hue(degrees: int) -> Change:
    """All colours turned round the axis of grey, by their hue."""

    def turned(image: ByteImage) -> ByteImage:
        hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV_FULL)
        hsv[..., 0] += np.uint8(round(degrees % 360 / 360 * 256) % 256)
        return np.asarray(cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB_FULL), np.uint8)

    return turned


def planes(change: Callable[[AnyArray], AnyArray]) -> Change:
    """Y, Cr and Cb as another program would read them."""

    def read(image: ByteImage) -> ByteImage:
        decoded = change(cv2.cvtColor(image, cv2.COLOR_RGB2YCrCb))
        return np.asarray(cv2.cvtColor(decoded, cv2.COLOR_YCrCb2RGB), np.uint8)

    return read


def _no_chroma(of: AnyArray) -> AnyArray:
    """Planes of zeros in place of 128."""
    return np.dstack([of[..., 0], np.zeros_like(of[..., 1:])])


def _shifted_chroma(of: AnyArray) -> AnyArray:
    """Chroma of the rows half an image away: a wrong offset of the planes."""
    return np.dstack([of[..., 0], np.roll(of[..., 1:], len(of) // 2, axis=0)])


def _bytes_exchanged(of: AnyArray) -> AnyArray:
    """UYVY read as YUYV: of two pixels grey comes from Cb and Cr, and chroma from their greys."""
    even = of[:, : of.shape[1] // 2 * 2]
    grey, red, blue = (even[..., i] for i in range(3))
    wrong = even.copy()
    wrong[:, ::2, 0], wrong[:, 1::2, 0] = blue[:, ::2], red[:, ::2]
    wrong[..., 2] = np.repeat(grey[:, ::2], 2, axis=1)
    wrong[..., 1] = np.repeat(grey[:, 1::2], 2, axis=1)
    out = of.copy()
    out[:, : even.shape[1]] = wrong
    return out


def mosaic(code: int) -> Change:
    """A sensor of red, green; green, blue, read as another pattern by a code of OpenCV."""

    def read(image: ByteImage) -> ByteImage:
        raw = image[..., 1].copy()
        raw[::2, ::2], raw[1::2, 1::2] = image[::2, ::2, 0], image[1::2, 1::2, 2]
        return np.asarray(cv2.cvtColor(raw, code), np.uint8)

    return read


def without_infrared_filter(image: ByteImage) -> ByteImage:
    """Near infrared in every channel, bright where green exceeds red and blue."""
    red, green, blue = np.moveaxis(image / 255.0, 2, 0)
    leaf = np.clip(4 * (green - np.maximum(red, blue)), 0, 1)
    infrared = 0.3 * (red + green + blue) / 3 + 0.6 * leaf + 0.1
    mixed = np.dstack([red + 0.9 * infrared, green + 0.45 * infrared, blue + 0.55 * infrared])
    return as_bytes(255 * mixed / 1.25)


def jpeg(quality: int) -> Change:
    """Compressed."""

    def compressed(image: ByteImage) -> ByteImage:
        data = cv2.imencode(".jpg", image[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
        return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), np.uint8)[..., ::-1]

    return compressed


def _grey(image: ByteImage) -> ByteImage:
    grey = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    return jpeg(90)(np.repeat(grey[..., None], 3, axis=2))


def _as_it_is(image: ByteImage) -> ByteImage:
    return image


LIGHTS: dict[str, Change] = {
    "as it is": _as_it_is,
    "warm": gains(1.2, 1.0, 0.8),
    "low sun": gains(1.25, 1.0, 0.7),
    "cool": gains(0.85, 1.0, 1.2),
    "greenish": gains(0.9, 1.1, 0.9),
    "red times, blue by 1.6": gains(1.6, 1.0, 1 / 1.6),
    "red by, blue times 1.6": gains(1 / 1.6, 1.0, 1.6),
    "saturation 1.3": lambda image: as_bytes(
        image.mean(axis=2, keepdims=True) + 1.3 * (image - image.mean(axis=2, keepdims=True))
    ),
    "JPEG 50": jpeg(50),
    "gamma 0.8": power(0.8),
}
FAULTS: dict[str, Change] = {
    "B, G, R": order(2, 1, 0),
    "G, B, R": order(1, 2, 0),
    "B, R, G": order(2, 0, 1),
    "G, R, B": order(1, 0, 2),
    "R, B, G": order(0, 2, 1),
    "hue + 60": hue(60),
    "hue + 120": hue(120),
    "hue + 180": hue(180),
    "hue - 60": hue(-60),
    "Cr and Cb exchanged": planes(lambda of: of[..., [0, 2, 1]]),
    "Cr and Cb zero": planes(_no_chroma),
    "chroma half an image away": planes(_shifted_chroma),
    "UYVY read as YUYV": planes(_bytes_exchanged),
    "Bayer, other green": mosaic(cv2.COLOR_BayerGB2RGB),
    "Bayer, blue for red": mosaic(cv2.COLOR_BayerRG2RGB),
    "no infrared filter": without_infrared_filter,
    "white balance 2.2, 0.45": gains(2.2, 1.0, 0.45),
    "white balance 0.45, 2.2": gains(0.45, 1.0, 2.2),
    "green 0.6 (magenta)": gains(1.0, 0.6, 1.0),
    "green 1.6": gains(0.75, 1.2, 0.75),
    "lens orange": gains(1.0, 0.6, 0.3),
    "lens blue": gains(0.4, 0.7, 1.0),
    "lens green": gains(0.5, 1.0, 0.5),
    "linear (gamma 2.2)": power(2.2),
    "curve twice (0.45)": power(0.45),
    "12 bits in 8": gains(1 / 16, 1 / 16, 1 / 16),
    "exposed to white": gains(2.5, 2.5, 2.5),
    "grey, JPEG": _grey,
    "JPEG 10": jpeg(10),
    "negative": lambda image: 255 - image,
}
