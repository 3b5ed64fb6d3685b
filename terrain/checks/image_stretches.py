"""Stretches of a run on which the image stays while the treads move, or has no texture."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.geometry import se2
from odometry.recording.run import Run
from terrain.camera.camera import Camera
from terrain.checks.ground_steps import pairs_to_compare
from terrain.checks.image_agreement import robot_motion
from terrain.checks.terrain_views import TerrainViews
from terrain.image_labels.still_image import StillImage

FEWEST = 3  # pairs of images, one after the other: one that looks so may be chance
SHOWN = 3  # stretches that are listed
SHOWS, STAYS, BLANK = range(3)


@dataclass(frozen=True, eq=False)
class ImageStretches:
    """What pairs of images are like that follow each other on the way of the robot.

    Attributes
    ----------
    run : Run
    pairs : (P, 2)
        Rows of images.csv.
    kinds : (P,)
        SHOWS, STAYS or BLANK.
    """

    run: Run
    pairs: IntArray
    kinds: IntArray

    def findings(self) -> Iterator[Finding]:
        """One finding for each kind."""
        for kind, name, seen, cause, remedy in (
            (
                STAYS,
                "images_frozen",
                "the image stays the same while the treads move",
                "The camera is frozen and repeats one image (noise, light or a clock in it may "
                "change), or it shows nothing but the robot, or treads spin and the robot stands",
                "Leave these images out of images.csv; check the camera and its driver",
            ),
            (
                BLANK,
                "images_blank",
                "images show no texture, or noise alone,",
                "Cannot be determined: the lens is covered, it is dark, the exposure is wrong, or "
                "the terrain has no texture",
                "Look at these images, and leave those out that show nothing",
            ),
        ):
            spans = self._spans_s(kind)
            if not spans:
                continue
            words = [f"from about {begin:.1f} to {end:.1f} s" for begin, end in spans[:SHOWN]]
            more = f", and on {counted(len(spans) - SHOWN, 'other span')}"
            yield Finding(
                name,
                Level.WARNING,
                f"{seen} {', '.join(words)}{more if len(spans) > SHOWN else ''} of run time, by "
                f"{np.count_nonzero(self.kinds == kind)} of {len(self.kinds)} pairs of images",
                cause,
                remedy,
                spans,
            )

    def others(self) -> Run:
        """The run with the images that are on none of these stretches."""
        images = self.run.images
        if images is None or not (self.kinds != SHOWS).any():
            return self.run
        kept = np.ones(len(images), dtype=np.bool_)
        for first, last in self._groups(self.kinds != SHOWS):
            after = self.pairs[first - 1, 1] + 1 if first else 0
            before = self.pairs[last + 1, 0] if last + 1 < len(self.pairs) else len(images)
            kept[after:before] = False
        return replace(self.run, images=images.rows(np.flatnonzero(kept)))

    def _spans_s(self, kind: int) -> tuple[tuple[float, float], ...]:
        stamps_s = self.run.images.stamps_s if self.run.images is not None else np.empty(0)
        begin_s = float(self.run.odometry.stamps_s[0])
        return tuple(
            (
                float(stamps_s[self.pairs[first, 0]]) - begin_s,
                float(stamps_s[self.pairs[last, 1]]) - begin_s,
            )
            for first, last in self._groups(self.kinds == kind)
        )

    @staticmethod
    def _groups(chosen: BoolArray) -> list[tuple[int, int]]:
        """First and last of the places that follow each other."""
        places = np.flatnonzero(chosen)
        parts = np.split(places, np.flatnonzero(np.diff(places) > 1) + 1)
        return [(int(part[0]), int(part[-1])) for part in parts if len(part)]


def image_stretches(run: Run, camera: Camera, views: TerrainViews) -> ImageStretches:
    """Look at pairs of images that are spread over the motion of a run."""
    pairs = pairs_to_compare(run, camera)
    kinds = np.full(len(pairs), SHOWS)
    if run.images is None or not len(pairs):
        return ImageStretches(run, pairs, kinds)
    travel_m, turn_rad = (of[0] for of in robot_motion(run, run.images.stamps_s[pairs][None]))
    steps = se2.exp(np.column_stack([travel_m, 0 * travel_m, turn_rad]))
    files, still = run.images["file"], StillImage(camera)
    for place, (rows, step) in enumerate(zip(pairs, steps, strict=True)):
        first, second = (str(files[row]) for row in rows)
        before, after = views.details(first), views.details(second)
        if before is None or after is None:
            continue
        if views.is_blank(first) and views.is_blank(second):
            kinds[place] = BLANK
        elif still.stays(before, after, step):
            kinds[place] = STAYS
    return ImageStretches(run, pairs, _lasting(kinds))


def _lasting(kinds: IntArray) -> IntArray:
    """The same without kinds of fewer than FEWEST pairs that follow each other."""
    parts = np.split(kinds, np.flatnonzero(np.diff(kinds)) + 1)
    kept = [part if len(part) >= FEWEST else np.full_like(part, SHOWS) for part in parts]
    return np.concatenate(kept) if len(kinds) else kinds
