"""Images that a replay does not come to: before its start and after its end."""

from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from odometry.tables.table import Table
from terrain.image_labels.image_label import ImageLabel
from terrain.sources.watcher import TerrainWatcher

BEFORE_ODOMETRY = "before the first row of odometry.csv"
BEFORE_POSE = "before the first pose"
AFTER_ODOMETRY = "after the end of odometry.csv"


def add_images_outside(watcher: TerrainWatcher, run: Run, images: Table, replay: Replay) -> None:
    """Add an image label without a label for each image of the run that the replay did not come to.

    The terrain in force is the initial one before the replay, and the last one after it.

    Parameters
    ----------
    watcher : TerrainWatcher
        Gets the terrain of the replay; its `image_labels` and `in_force` are completed.
    run : Run
    images : Table
        Of the run.
    replay : Replay
    """
    begin_s, end_s = replay.stamps_s[[0, -1]]
    image_labels = [
        ImageLabel(float(stamp_s), str(file), reason=_reason(run, float(stamp_s), begin_s))
        for stamp_s, file in zip(images.stamps_s, images["file"], strict=True)
        if not begin_s <= stamp_s <= end_s
    ]
    before = [image_label for image_label in image_labels if image_label.stamp_s < begin_s]
    after = image_labels[len(before) :]
    watcher.image_labels[:] = [*before, *watcher.image_labels, *after]
    watcher.in_force[:] = [
        *[watcher.initial] * len(before),
        *watcher.in_force,
        *[replay.terrains[-1]] * len(after),
    ]


def _reason(run: Run, stamp_s: float, begin_s: float) -> str:
    if stamp_s >= begin_s:
        return AFTER_ODOMETRY
    return BEFORE_ODOMETRY if stamp_s < run.odometry.stamps_s[0] else BEFORE_POSE
