"""Images of a bag as files: compressed ones byte by byte, others as PNG."""

from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.bags.files.topic import Buffer
from odometry.bags.rows.ordered_rows import seconds
from odometry.bags.topics.message_fields import COMPRESSED_IMAGE
from odometry.errors import BagError

JPEG, PNG = b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n"
CHANNELS = {"mono8": 1, "8UC1": 1, "bgr8": 3, "rgb8": 3, "8UC3": 3, "bgra8": 4, "rgba8": 4}
TO_BGR = {"rgb8": "RGB2BGR", "rgba8": "RGBA2BGR", "bgra8": "BGRA2BGR"}
BAYER = {"bayer_rggb8": "BG", "bayer_bggr8": "RG", "bayer_gbrg8": "GR", "bayer_grbg8": "GB"}
YUV = {"yuv422": "UYVY", "uyvy": "UYVY", "yuv422_yuy2": "YUY2", "yuyv": "YUY2"}


class ImageFiles:
    """Writes images and images.csv; an image whose stamp does not increase is dropped.

    Attributes
    ----------
    written, repeated, back : int
        Images written, and dropped: with a stamp that was there before, or that goes back.
    """

    def __init__(self, folder: Path) -> None:
        self.written = self.repeated = self.back = 0
        self._folder = folder
        self._rows: list[str] = []
        self._last_ns = -(2**63)

    def add(self, stamp_ns: int, message: Any) -> None:
        """Take in an Image or a CompressedImage.

        Raises
        ------
        BagError
            If it is of an encoding that is not read.
        """
        if stamp_ns <= self._last_ns:
            self.repeated += stamp_ns == self._last_ns
            self.back += stamp_ns != self._last_ns
            return
        content, suffix = encoded(message)
        name = f"images/{self.written:06d}{suffix}"
        if not self.written:
            (self._folder / "images").mkdir(parents=True, exist_ok=True)
        with (self._folder / name).open("wb", buffering=0) as stream:
            stream.write(content)
        self._rows.append(f"{seconds(stamp_ns)},{name}\n")
        self._last_ns = stamp_ns
        self.written += 1
        if len(self._rows) >= 1000:
            self._append()

    def close(self) -> None:
        """Write the rest of images.csv."""
        self._append()

    def _append(self) -> None:
        if not self.written:
            return
        table = self._folder / "images.csv"
        new = not table.exists()
        with table.open("a", encoding="utf-8", newline="") as stream:
            stream.write("t,file\n" if new else "")
            stream.writelines(self._rows)
        self._rows = []


def encoded(message: Any) -> tuple[Buffer, str]:
    """Bytes of an image file, and its suffix.

    Raises
    ------
    BagError
        If it is of an encoding that is not read.
    """
    if message.__msgtype__ == COMPRESSED_IMAGE:
        content = memoryview(message.data)
        begin = bytes(content[: len(PNG)])
        for start, suffix in ((JPEG, ".jpg"), (PNG, ".png")):
            if begin.startswith(start):
                return content, suffix
        raise BagError(f"an image of the format {message.format!r}, expected JPEG or PNG")
    import cv2  # noqa: PLC0415 - only bags with raw images need it

    done, buffer = cv2.imencode(".png", pixels_of(message), [cv2.IMWRITE_PNG_COMPRESSION, 1])
    if not done:
        raise BagError("an image that cannot be written as PNG")
    return buffer.tobytes(), ".png"


def pixels_of(message: Any) -> AnyArray:
    """Pixels (H, W) of greys or (H, W, 3) of blue, green and red of an Image.

    Raises
    ------
    BagError
        If it is of an encoding that is not read, or shorter than it says.
    """
    import cv2  # noqa: PLC0415

    coding = message.encoding.lower() if message.encoding not in CHANNELS else message.encoding
    channels = CHANNELS.get(coding, 2 if coding in YUV else 1 if coding in BAYER else 0)
    height, width, step = message.height, message.width, message.step
    if not channels:
        raise BagError(
            f"an image of the encoding {message.encoding!r}, which is not read. Convert the images "
            "to mono8 or bgr8 (cv_bridge) and record these, or name another topic: --images"
        )
    data = np.asarray(message.data, dtype=np.uint8)
    if not height * width or step < width * channels or len(data) < height * step:
        raise BagError(f"an image of {len(data)} bytes, expected {height} rows of {step}")
    rows = data[: height * step].reshape(height, step)[:, : width * channels]
    pixels = np.ascontiguousarray(rows).reshape(
        (height, width) if channels == 1 else (height, width, channels)
    )
    if coding in TO_BGR:
        return np.asarray(cv2.cvtColor(pixels, getattr(cv2, f"COLOR_{TO_BGR[coding]}")))
    if coding in BAYER:
        return np.asarray(cv2.cvtColor(pixels, getattr(cv2, f"COLOR_Bayer{BAYER[coding]}2BGR")))
    if coding in YUV:
        return np.asarray(cv2.cvtColor(pixels, getattr(cv2, f"COLOR_YUV2BGR_{YUV[coding]}")))
    return pixels
