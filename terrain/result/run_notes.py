"""What to know of a result before its numbers are used: names, images, refused poses."""

import shlex
from collections import Counter
from collections.abc import Sequence

import numpy as np

from odometry.recording.run import UNKNOWN
from odometry.set_of_robot import set_notes
from terrain.classification.answer import (
    DOUBTFUL,
    IMPROBABLE,
    ONE_CHANNEL,
    TOO_UNLIKE,
    colourless_note,
)
from terrain.classification.likeness.noticed_alterations import unnoticed
from terrain.classification.no_ground import no_ground_note
from terrain.classification.training_light import BY_LIGHT
from terrain.image_labels.image_label import ASTRIDE, ImageLabel
from terrain.result.evaluation_notes import event_line
from terrain.result.lasting_note import lasting_note
from terrain.result.names_against_poses import names_note
from terrain.result.run_result import RunResult
from terrain.result.sets_against_gyroscope import sets_against_gyroscope
from terrain.result.sets_against_poses import sentences, sets_against_poses
from terrain.sources.watcher import TerrainWatcher
from terrain.terrain_names import name_notes

MANY_REFUSED = 0.1
FEW_EVENTS = 10
FEWEST_IMAGES, MOSTLY_UNKNOWN, MANY_WITHOUT = 20, 0.5, 0.2
REFUSED_POSES = "refused_poses"  # kind of an event that says the same


def run_notes(result: RunResult) -> list[str]:
    """Sentences on what makes a result less than it seems; none where there is nothing.

    They stand on the page and in result.json beside what the check finds in the recording.
    """
    classifier = None if result.watcher is None else result.watcher.classifier
    return [
        *set_notes(result.parameters, result.run.robot),
        *name_notes(result.initial_terrain, classifier, result.parameters),
        *_unnamed(result),
        *([] if result.watcher is None else _images(result.watcher)),
        *_refused(result),
        *lasting_note(result),
        *names_note(result),
        *sentences(sets_against_poses(result) or sets_against_gyroscope(result)),
    ]


def event_lines(result: RunResult) -> list[str]:
    """What the filter noticed, the first few in full, without what `run_notes` says."""
    many = bool(_refused(result))
    events = [e for e in result.replay.events if not (many and e.kind == REFUSED_POSES)]
    lines = [event_line(event, result.run.began_s) for event in events[:FEW_EVENTS]]
    if len(events) > FEW_EVENTS:
        lines.append(f"{len(events) - FEW_EVENTS} more events of the filter, see result.json")
    return lines


def _unnamed(result: RunResult) -> list[str]:
    """Say that nothing names the terrain of a set of several, or that the run names another."""
    own, initial, of_set = result.run.terrain, result.initial_terrain, result.parameters.terrains
    if result.source != "none":
        return []
    if own not in (None, UNKNOWN, initial) and list(of_set) == [initial]:
        return [
            f"run.toml names the terrain {own!r}, the parameter set has {initial!r} alone: this is "
            "in force, and what is learned is said of it. Where both are one terrain, give both "
            f"one name; else start without its parameters: --terrain {shlex.quote(own)}"
        ]
    if initial != UNKNOWN:
        return []
    return [
        "the terrain is unknown throughout: there is no source of terrain (no vision, no other), "
        f"and the parameter set has {', '.join(of_set)}. --terrain names one"
    ]


def _images(watcher: TerrainWatcher) -> list[str]:
    """Images that are unlike those of training, show no terrain, or have no name."""
    from terrain.classification.own_statistics import OwnStatisticsClassifier  # noqa: PLC0415 - slow to load

    found = []
    if isinstance(watcher.classifier, OwnStatisticsClassifier):
        found.append(watcher.classifier.described)
    likeness = watcher.seen.likeness
    if likeness is not None and likeness.note is not None:
        doubtful = {BY_LIGHT, DOUBTFUL, IMPROBABLE, TOO_UNLIKE}
        doubted = sum(label.reason in doubtful for label in watcher.image_labels)
        learned = getattr(watcher.classifier, "confidence_", None) is not None
        what = f"Names that are not surely enough right are unknown ({doubted} images)"
        counted = what if learned or doubted else "Here they count less"
        found.append(f"{likeness.note}. {counted}" if likeness.is_unlike else likeness.note)
    elif likeness is not None and likeness.images:
        share = getattr(watcher.classifier, "noticed_share_", None)
        found += filter(None, [unnoticed(share)])
    empty = no_ground_note([image_label.reason for image_label in watcher.image_labels])
    if empty is not None:
        found.append(empty)
    reasons = Counter(image_label.reason for image_label in watcher.image_labels)
    grey = colourless_note(reasons, len(watcher.image_labels))
    hardly_any = _blind(watcher.image_labels) or [
        *_without_label(watcher.image_labels),
        *_few_names(watcher.image_labels),
    ]
    return found + (hardly_any or ([] if grey is None else [grey]))


def _refused(result: RunResult) -> list[str]:
    """Say that the filter refused many poses."""
    poses = int((~np.isnan(result.replay.innovations_squared)).sum())
    refused = poses - int(result.replay.accepted.sum())
    if refused <= MANY_REFUSED * poses:
        return []
    return [
        f"the filter refused {refused} of {poses} poses, because they lie far from "
        "where it expected them. The units of pose.csv or odometry.csv may be wrong, the poses "
        "may jump, or the noise settings ([filter] of --config) may be too small"
    ]


def _blind(image_labels: Sequence[ImageLabel]) -> list[str]:
    """Say why where no image was given the name of a terrain."""
    if not image_labels or any(
        image_label.label not in ("", UNKNOWN) for image_label in image_labels
    ):
        return []
    reasons = Counter(
        image_label.reason or "unlike any training patch" for image_label in image_labels
    )
    words = ", ".join(f"{reason} ({count})" for reason, count in reasons.most_common(3))
    nothing = "the terrain is that of the start, and unknown where no image supports it for long"
    astride = sum(count for reason, count in reasons.items() if reason.startswith(ASTRIDE))
    others = (count for reason, count in reasons.items() if not reason.startswith(ASTRIDE))
    if astride > max(others, default=0):
        return [
            f"vision named one terrain for both treads in none of {len(image_labels)} images: "
            f"{words}; {nothing}. With --per-tread an image counts where both treads have the same "
            "label (columns left and right of terrain.csv); without it the terrain ahead is "
            "classified as one"
        ]
    return [
        f"vision named no terrain in any of {len(image_labels)} images: {words}; {nothing}. "
        "Look at them with terrain-odometry camera RUN --model MODEL --out DIR: where they do not "
        "show the terrain ahead it suggests a pitch; where they do, the model needs patches of "
        "this terrain and camera (label, train)"
    ]


def _without_label(image_labels: Sequence[ImageLabel]) -> list[str]:
    """Say that many images which show the region ahead were not classified, and why."""
    visible = [each for each in image_labels if each.region is not None]
    missing = [each for each in visible if each.label == "" and each.reason != ONE_CHANNEL]
    if len(missing) < max(FEWEST_IMAGES, MANY_WITHOUT * len(visible)):
        return []
    (reason, count) = Counter(each.reason for each in missing).most_common(1)[0]
    first = next(each for each in missing if each.reason == reason)
    return [
        f"{len(missing)} of {len(visible)} images that show the terrain ahead have no label (most "
        f"often: {reason}, {count}, the first is {first.image or f'that of {first.stamp_s} s'}); "
        "where no image supports the terrain for long, it is unknown. Look at them: where they "
        "are clear all the same, run the rest apart (--from SECONDS)"
    ]


def _few_names(image_labels: Sequence[ImageLabel]) -> list[str]:
    """Say that the terrain in force rests on few images where most of them are unknown."""
    reasons = [one.reason or "far from all" for one in image_labels if one.label == UNKNOWN]
    classified = sum(one.label != "" for one in image_labels)
    if classified < FEWEST_IMAGES or len(reasons) < MOSTLY_UNKNOWN * classified:
        return []
    (reason, count) = Counter(reasons).most_common(1)[0]
    return [
        f"{len(reasons)} of {classified} classified images are unknown (most often: {reason}, "
        f"{count}), so that the terrain in force rests on the others, some of them far behind. "
        "Compare the path with that of --no-vision"
    ]
