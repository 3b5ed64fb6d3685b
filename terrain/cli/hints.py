"""Advice after a run: missed options, and whether to keep what the filter learned."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from odometry.estimation.filter_event import FilterEvent
from odometry.run import UNKNOWN
from terrain.classification.answer import DOUBTFUL, IMPROBABLE
from terrain.classification.no_ground import no_ground_note
from terrain.classification.own_statistics import OwnStatisticsClassifier
from terrain.evaluation_notes import event_line
from terrain.image_label import ASTRIDE, ImageLabel
from terrain.run_result import RunResult

MANY_REFUSED = 0.1
FEW_EVENTS = 10
FEWEST_IMAGES, MOSTLY_UNKNOWN = 20, 0.5
REFUSED_POSES = "refused_poses"  # kind of an event that says the same


def hints(result: RunResult, *, vision: bool, named: str | None = None) -> list[str]:
    """Sentences about a result that may come from a typing error or a missing option.

    Parameters
    ----------
    result : RunResult
    vision : bool
        Whether images should be used.
    named : str, optional
        The terrain that was named for the start of the run.
    """
    known, found = result.parameters.terrains, []
    if known and result.initial_terrain not in known:
        found.append(
            f"{result.initial_terrain!r} has no table in the parameter set, which has "
            f"{', '.join(known)}: it starts from a broad prior"
        )
    if vision and result.watcher is None and result.run.images is not None:
        found.append("the run has images, but there is no vision without --model")
    if result.watcher is not None and known:
        found += [
            f"the model knows {name!r}, the parameter set does not: it starts from a broad prior "
            "round the mean of the terrains that it knows"
            for name in sorted(set(map(str, result.watcher.classifier.classes_)) - set(known))
        ]
    if result.watcher is not None:
        if isinstance(result.watcher.classifier, OwnStatisticsClassifier):
            found.append(result.watcher.classifier.described)
        likeness = result.watcher.seen.likeness
        if likeness is not None and likeness.note is not None:
            doubted = sum(
                label.reason in {DOUBTFUL, IMPROBABLE} for label in result.watcher.image_labels
            )
            learned = getattr(result.watcher.classifier, "confidence_", None) is not None
            what = f"Names that are not surely enough right are unknown ({doubted} images)"
            found.append(f"{likeness.note}. {what if learned else 'Here they count less'}")
        empty = no_ground_note([image_label.reason for image_label in result.watcher.image_labels])
        if empty is not None:
            found.append(empty)
        found += _blind(result.watcher.image_labels) or _few_names(result.watcher.image_labels)
        if named is None and len(known) > 1:
            found += _start(result.initial_terrain, result.run.terrain, result.watcher.image_labels)
    poses = int((~np.isnan(result.replay.innovations_squared)).sum())
    refused = poses - int(result.replay.accepted.sum())
    many = refused > MANY_REFUSED * poses
    events = [e for e in result.replay.events if not (many and e.kind == REFUSED_POSES)]
    found += _events(events, result.run.began_s)
    if many:
        found.append(
            f"the filter refused {refused} of {poses} poses, because they lie far from "
            "where it expected them. The units of pose.csv or odometry.csv may be wrong, the poses "
            "may jump, or the noise settings ([filter] of --config) may be too small"
        )
    return found


def _start(assumed: str, of_run: str | None, image_labels: Sequence[ImageLabel]) -> list[str]:
    """Say that the run began on a terrain that was not named and differs from the first label."""
    labels = (str(image_label.label) for image_label in image_labels)
    seen = next((label for label in labels if label not in ("", UNKNOWN)), assumed)
    if assumed in (seen, of_run):
        return []
    return [
        f"no terrain was named for the start, so {assumed!r}, the first of the parameter set, was "
        f"in force, but the first label is {seen!r}; a wrong start misleads the gyroscope's bias. "
        f"Try --terrain {seen}"
    ]


def _events(events: Sequence[FilterEvent], began_s: float) -> list[str]:
    """What the filter noticed, the first few in full."""
    lines = [event_line(event, began_s) for event in events[:FEW_EVENTS]]
    if len(events) > FEW_EVENTS:
        lines.append(f"{len(events) - FEW_EVENTS} more events of the filter, see result.json")
    return lines


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
    nothing = "no terrain came into force but that of the start"
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
        "Try terrain-odometry camera RUN --model MODEL --out DIR: it shows what the camera sees "
        "and suggests a pitch"
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


def learned_advice(
    result: "RunResult", run_folder: Path, out: Path, *, has_warnings: bool, preset: str | None
) -> str | None:
    """One line on learned.toml; None where the run has learned nothing, or a preset refuses it.

    Parameters
    ----------
    result : RunResult
    run_folder, out : Path
        Of the run, and of its results.
    has_warnings : bool
        Whether the check of the recording found what would mislead.
    preset : str, optional
        A published system knows no parameter sets.
    """
    from terrain.evaluation_notes import misleading

    if preset is not None or not result.has_learned:
        return None
    if has_warnings:
        return (
            "learned.toml is not recommended: the recording has warnings (terrain-odometry check "
            f"{run_folder})"
        )
    events = misleading(result.replay)
    if events:
        kinds = ", ".join(dict.fromkeys(event.kind.replace("_", " ") for event in events))
        return (
            f"learned.toml is not recommended: the filter noticed {kinds} (see {out}/report.html)"
        )
    return f"Next time: --parameters {out / 'learned.toml'} starts from what was learned"
