"""Stretches on which images show less of the same terrain than before: fog, mist, a lost focus."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.checks.findings.finding import Finding, Level
from odometry.geometry import se2
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.ground_steps import APART_S, pairs_to_compare
from terrain.checks.image_agreement import robot_motion
from terrain.checks.terrain_views import TerrainViews
from terrain.image_labels.terrain_details import LOSS, TileDetails, change_of_details

WORTH_A_LOOK = -LOSS / 2  # of images that are looked at first, whatever terrain they show
FEWEST_LOOKS = 3  # of these on a stretch: one blurred image is none


def lost_details(run: Run, camera: Camera, views: TerrainViews) -> Iterator[Finding]:
    """Find where images begin to lack details of the same terrain, and where they end.

    Terrain of other details is no finding, nor is light: each tile of an image is compared with
    the place in the next image to which the treads moved its terrain. What comes slowly, in parts
    of the image alone (drops, dirt), or before the first image is not found.
    """
    if run.images is None:
        return
    details = _DetailsOfRun(run, camera, views, run.images["file"], run.images.stamps_s)
    looks = np.unique(pairs_to_compare(run, camera)[:, 0]).tolist()
    levels = np.array([details.level(row) for row in looks])
    changes = [
        change
        for place in np.flatnonzero(np.abs(np.diff(levels)) > WORTH_A_LOOK).tolist()
        if (change := details.change(looks[place], looks[place + 1])) is not None
    ]
    times_s = details.stamps_s - run.odometry.stamps_s[0]
    for first, last, loss in _stretches(changes, len(times_s)):
        if sum(first <= row <= last for row in looks) < FEWEST_LOOKS:
            continue
        span_s = (float(times_s[first]), float(times_s[last]))
        yield Finding(
            "images_lost_details",
            Level.WARNING,
            f"images from {span_s[0]:.1f} to {span_s[1]:.1f} s of run time show "
            f"{np.exp(loss):.2f} of the details, or of the finest of them, that the image before "
            "them shows of the same terrain, light apart",
            "Cannot be determined: fog, a wet or misted lens, another focus, or an exposure that "
            "bleaches the terrain",
            "Look at these images, and leave them out of images.csv: names of terrain by them "
            "mean little",
            (span_s,),
        )


def _stretches(changes: list[tuple[int, float]], count: int) -> Iterator[tuple[int, int, float]]:
    """First and last row of images, and the loss [log]; by the rows after each change."""
    lost: tuple[int, float] | None = None
    for row, change in changes:
        if lost is None and change < 0:
            lost = row, change
        elif lost is not None and change > 0:
            yield lost[0], row - 1, lost[1]
            lost = None
    if lost is not None:
        yield lost[0], count - 1, lost[1]


@dataclass(frozen=True, eq=False)
class _DetailsOfRun:
    """Details in the images of a run: files (N,) at stamps (N,)."""

    run: Run
    camera: Camera
    views: TerrainViews
    files: AnyArray
    stamps_s: FloatArray

    def level(self, row: int) -> float:
        """Mean logarithm of details over light of an image, whatever it shows."""
        image = self.views.grey(str(self.files[row]))
        return float("nan") if image is None else TileDetails.of(image).level

    def change(self, first: int, last: int) -> tuple[int, float] | None:
        """The row after a change on the same terrain by as much as LOSS, and its logarithm."""
        low, high = self.level(first), self.level(last)
        while last - first > 1:
            middle = (first + last) // 2
            level = self.level(middle)
            if abs(level - low) < abs(level - high):
                first = middle
            else:
                last = middle
        stamps_s = self.stamps_s[[first, last]]
        before, after = (self.views.grey(str(self.files[row])) for row in (first, last))
        if before is None or after is None or stamps_s[1] - stamps_s[0] > APART_S:
            return None
        travel_m, turn_rad = (of[0] for of in robot_motion(self.run, stamps_s[None, None]))
        step = se2.exp(np.column_stack([travel_m, 0 * travel_m, turn_rad]))[0]
        changes = change_of_details(self.camera, TileDetails.of(before), after, step)
        change = 0.0 if changes is None else float(changes[np.abs(changes).argmax()])
        return None if abs(change) < -LOSS else (last, change)
