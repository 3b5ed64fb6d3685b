"""A stand-in for a classifier, and a drive of a watcher over the frames of its run."""

import numpy as np

from odometry.estimation.estimate import Estimate
from terrain.classification.answer import Classification

BRIGHT, DARK = np.full((120, 160), 200, np.uint8), np.full((120, 160), 50, np.uint8)


class ByBrightness:
    """Stands in for a trained classifier: bright ground is "snow"; keeps what it was shown."""

    def __init__(self, metres_per_pixel=0.006, patch_size_px=32, colour=False):
        self.metres_per_pixel, self.patch_size_px = metres_per_pixel, patch_size_px
        self.colour_ = colour
        self.shown = []

    def middle_used(self, shape):
        return shape

    def classify(self, images):
        self.shown += images
        bright = [float(image.mean()) > 128 for image in images]
        return [
            Classification("snow" if is_so else "mud", 0.9 if is_so else 0.7, 0.1, {})
            for is_so in bright
        ]


def estimate_at(frame, icrs=(0.15, -0.15, 0.0), speeds=(0.5, 0.5), pose=(0.0, 0.0, 0.0)):
    """Belief at a frame of a robot that drives straight on at 0.5 m/s."""
    return Estimate(
        frame.stamp_s,
        np.array([*pose, *icrs, 0.0, 1.0, 1.0]),
        1e-6 * np.eye(9),
        np.array(speeds),
        "mud",
    )


def drive(watched, corrected=lambda stamp_s: (0.5 * stamp_s, 0.0, 0.0)):
    """Terrain in force at each frame; the estimate that goes in is that of the frame before."""
    frames = list(watched.run.frames())
    estimates = [estimate_at(frame, pose=corrected(frame.stamp_s)) for frame in frames]
    return [
        watched.watcher.terrain(frame, estimate).terrain
        for frame, estimate in zip(frames, estimates[:1] + estimates, strict=False)
    ]
