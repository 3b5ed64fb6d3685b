"""Whether the calibration of a camera stays the same all along a bag."""

from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.bags.files.topic import Message
from odometry.bags.rows.camera_info import numbers_of
from odometry.bags.rows.streams import Consumer
from odometry.bags.topics.message_fields import body_frame

SAME = 1e-3  # of the focal length: a thousandth is a pixel at the edge of a large image


class LensWatch(Consumer):
    """Compares each CameraInfo of a topic with the first."""

    def __init__(self, topic: str) -> None:
        super().__init__(topic)
        self._first: tuple[int, Any] | None = None
        self._count = self._changed = 0
        self._said = ""

    def take(self, message: Message, content: Any) -> None:
        """Take in a CameraInfo."""
        self._count += 1
        if self._first is None:
            self._first = message.received_ns, content
            return
        began_ns, first = self._first
        change = _change(first, content)
        if change and not self._changed:
            after_s = (message.received_ns - began_ns) / 1e9
            self._said = f"{change}, first after {after_s:.3g} s"
        self._changed += bool(change)

    def notes(self) -> list[str]:
        """What is to be said; nothing where it stays."""
        if not self._changed:
            return []
        return [
            f"warning: {self.topic} changes on the way ({self._said}): {self._changed} of its "
            f"{self._count} messages differ from the first, which [camera] is made of. It is wrong "
            "for the images of the others: use a recording in which lens, size and camera stay, or "
            "leave the images out (--images none)"
        ]


def _change(first: Any, later: Any) -> str:
    """What differs between two messages; empty where nothing does."""
    frames = [body_frame(one) for one in (first, later)]
    sizes = [f"{one.width} x {one.height}" for one in (first, later)]
    before, after, lens, later_lens, rectified, later_rectified = (
        numbers_of(one, key) for key in "kdp" for one in (first, later)
    )
    models = [one.distortion_model for one in (first, later)]
    focal = before[0]
    changes = {
        f"another camera: frame {' to '.join(frames)}": frames[0] != frames[1],
        f"size {' to '.join(sizes)} pixels": sizes[0] != sizes[1],
        "region of interest or binning": _region(first) != _region(later),
        f"focal length {focal:.4g} to {after[0]:.4g} pixels": not _same(
            before[:1], after[:1], focal
        ),
        "camera matrix": not _same(before, after, focal),
        "matrix of rectified images": not _same(rectified, later_rectified, focal),
        "distortion": models[0] != models[1] or not _same(lens, later_lens, 1.0),
    }
    return next((text for text, changed in changes.items() if changed), "")


def _region(info: Any) -> tuple[int, ...]:
    roi = info.roi
    return (roi.x_offset, roi.y_offset, roi.width, roi.height, info.binning_x, info.binning_y)


def _same(before: FloatArray, after: FloatArray, scale: float) -> bool:
    if before.shape != after.shape:
        return False
    return bool(np.allclose(before, after, rtol=0, atol=SAME * abs(scale), equal_nan=True))
