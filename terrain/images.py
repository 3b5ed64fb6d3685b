"""Reading images, and the grey image that the texture features are made from."""

from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import AnyArray, ByteImage
from odometry.io.files import read_bytes
from terrain.errors import ImageError
from terrain.image_size import PIXELS, is_whole, stated_size

IMAGE_BYTES = 256 * 1024**2
VIDEOS = (".mp4", ".avi", ".mov", ".mkv", ".webm", ".m4v")
FRAMES_FIRST = "; of a video give frames, as by: ffmpeg -i FILE -vf fps=2 frame_%04d.png"
# Weights of red, green and blue, and what rounds half up once digits are cut off: sums are whole
# hundredths, so that a tenth of one more outweighs rounding errors (1e-4) and rounds none up
ROUNDED_GREY = np.array([[0.30, 0.59, 0.11, 0.501]], dtype=np.float32)


def read_image(path: Path | str) -> ByteImage:
    """Read an image file as it is stored.

    Parameters
    ----------
    path : Path or str
        A JPEG, PNG, TIFF or BMP file.

    Returns
    -------
    ndarray of uint8, (H, W, 3) in RGB order, or (H, W) where the file is grey
        An alpha channel is dropped and 16 bits become 8 (see `to_bytes`). An EXIF rotation is
        not applied: cameras are calibrated in the pixels that they store.

    Raises
    ------
    ImageError
        The file cannot be opened, is no such image, or has more than PIXELS pixels.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> images = odometry.shipped_data() / "runs" / "demo" / "images"
    >>> terrain.read_image(images / "000000.jpg").shape
    (480, 640)
    """
    encoded = read_bytes(Path(path), ImageError, IMAGE_BYTES, "a photograph has a few million")
    return decode_image(encoded, str(path))


def decode_image(encoded: bytes, where: str = "image") -> ByteImage:
    """Pixels of an image file's bytes, such as the data of a compressed image message.

    Parameters
    ----------
    encoded : bytes
        Of a JPEG, PNG, TIFF or BMP file.
    where : str
        Named in errors.

    Returns
    -------
    ndarray of uint8
        As `read_image`.

    Raises
    ------
    ImageError
        As `read_image`.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> image = odometry.shipped_data() / "runs" / "demo" / "images" / "000000.jpg"
    >>> terrain.decode_image(image.read_bytes()).shape
    (480, 640)
    """
    size = stated_size(encoded)
    if size is None:
        hint = FRAMES_FIRST if where.lower().endswith(VIDEOS) else ""
        raise ImageError(
            f"{where}: {len(encoded)} bytes that do not decode as a JPEG, PNG, TIFF or BMP image"
            f"{hint}"
        )
    width, height = size
    if not 0 < width * height <= PIXELS:
        raise ImageError(f"{where}: {width} x {height} pixels, expected 1 to {PIXELS} in all")
    if not is_whole(encoded):
        raise ImageError(f"{where}: the image has no end; it was cut off at {len(encoded)} bytes")
    try:
        decoded: AnyArray | None = cv2.imdecode(
            np.frombuffer(encoded, np.uint8), cv2.IMREAD_UNCHANGED
        )
    except cv2.error:
        decoded = None
    if decoded is None:
        raise ImageError(f"{where}: {len(encoded)} bytes that do not decode as an image")
    try:
        image = to_bytes(decoded)
    except ImageError as error:
        raise ImageError(f"{where}: {error}") from error
    if image.ndim == 2:
        return image
    if image.shape[2] == 4:
        return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGRA2RGB), np.uint8)
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB, image), np.uint8)  # in its place


def to_grey(image: AnyArray) -> ByteImage:
    """Turn an image into 8-bit grey: 0.30 R + 0.59 G + 0.11 B, rounded half up.

    Parameters
    ----------
    image : ndarray, (H, W), (H, W, 1), (H, W, 3) or (H, W, 4)
        Grey, RGB in this order, or RGBA, whose alpha is ignored. Kinds other than uint8 are
        first brought to 8 bits as in `to_bytes`.

    Returns
    -------
    ndarray of uint8, (H, W)

    Raises
    ------
    ImageError
        The image is empty, or has another shape or kind of value.

    References
    ----------
    Chen et al. 2023, eq. 18.

    Examples
    --------
    >>> import numpy as np
    >>> import terrain
    >>> terrain.to_grey(np.array([[[255, 0, 0]]], dtype=np.uint8)).tolist()  # 0.30 of red
    [[77]]
    """
    image = to_bytes(image)
    if image.ndim == 2 or image.shape[2] == 1:
        return np.ascontiguousarray(image.reshape(image.shape[:2]))
    grey = cv2.transform(image[..., :3].astype(np.float32), ROUNDED_GREY)  # eq. 18, exactly
    return np.asarray(grey).astype(np.uint8)


def as_stored(image: AnyArray) -> ByteImage:
    """An image in memory as `read_image` gives those of files.

    Parameters
    ----------
    image : ndarray
        As `to_bytes` takes it. Of one channel it is grey; an alpha channel is dropped.

    Raises
    ------
    ImageError
        As `to_bytes`.
    """
    pixels = to_bytes(image)
    if pixels.ndim == 2:
        return pixels
    return pixels[..., 0] if pixels.shape[2] == 1 else pixels[..., :3]


def to_bytes(image: AnyArray) -> ByteImage:
    """Bring an image to 8 bits a channel.

    Parameters
    ----------
    image : ndarray, (H, W) or (H, W, 1, 3 or 4)
        uint8 is kept. bool becomes 0 and 255. uint16 is divided by 257, so that 65535 becomes
        255; a 12-bit camera must be stretched before. float must lie in 0 to 1 and is
        multiplied by 255. Both are rounded half up.

    Returns
    -------
    ndarray of uint8, of the same shape

    Raises
    ------
    ImageError
        The image is empty, has another shape or kind of value, or is a float image with values
        that are not finite or not in 0 to 1.
    """
    image = np.asarray(image)
    if image.ndim not in {2, 3} or (image.ndim == 3 and image.shape[2] not in {1, 3, 4}):
        raise ImageError(
            f"an image has the shape (H, W), (H, W, 3) or (H, W, 4), not {image.shape}"
        )
    if image.size == 0:
        raise ImageError(f"an image needs at least one pixel, this one has the shape {image.shape}")
    if image.dtype == np.uint8:
        return image
    if image.dtype == np.bool_:
        return image * np.uint8(255)
    if image.dtype == np.uint16:
        return ((image.astype(np.uint32) + 128) // 257).astype(np.uint8)
    if np.issubdtype(image.dtype, np.floating):
        lowest, highest = float(image.min()), float(image.max())
        if not np.isfinite(lowest + highest):
            raise ImageError("a float image has values in 0 to 1, this one holds NaN or inf")
        if lowest < 0.0 or highest > 1.0:
            raise ImageError(
                f"a float image has values in 0 to 1, this one in {lowest:g} to {highest:g}"
            )
        return np.floor(image * 255.0 + 0.5).astype(np.uint8)
    raise ImageError(f"an image holds uint8, uint16, bool or float values, not {image.dtype}")
