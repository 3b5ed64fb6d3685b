"""What `classify` prints of a folder of labelled images."""

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from terrain.classification.classifier import TerrainClassifier
    from terrain.classification.held_out import HeldOutScore, LabelledAnswer
    from terrain.classification.likeness.likeness import Likeness

SAME_SCALE = 0.02  # share by which two scales may differ


def print_held_out(
    classifier: "TerrainClassifier", model: Path, folder: Path, *, as_json: bool
) -> bool:
    """Print confusion and accuracy on the labelled images that are held out.

    Returns
    -------
    bool
        Whether every image could be used.

    Raises
    ------
    PatchError
        If the folder is not as the format says, or the model was trained on every image in it.
    """
    from terrain.classification.held_out import answer_photos, held_out_score
    from terrain.classification.photographs.patches import SUFFIXES, find_photos
    from terrain.classification.photographs.photo_faults import unread_note
    from terrain.errors import ImageError, PatchError
    from terrain.image_depth import check_depth

    photos = find_photos(folder)
    check_depth([photo.path for photo in photos], ImageError)
    if unread := unread_note([photo.path for photo in photos], SUFFIXES):
        click.echo(f"Note: {unread}", err=True)
    answers, unusable = answer_photos(classifier, photos)
    for path, reason in unusable.items():
        click.echo(f"left out: {path}: {reason}", err=True)
    held_out = [each for each in answers if not each.in_training]
    if not held_out:
        causes = [f"the model was trained on {len(answers)} of its images"] if answers else []
        causes += [f"{len(unusable)} could not be used"] if unusable else []
        raise PatchError(f"{folder}: nothing is held out: {', '.join(causes)}")
    for note in (*_notes(classifier, model, answers), *_of_scale(classifier, folder)):
        click.echo(f"Note: {note}", err=True)
    likeness = classifier.likeness(readable([each.photo.path for each in held_out]))
    share, named = classifier.noticed_share_, held_out
    answers = [
        each
        if each.in_training
        else replace(each, answer=each.answer.unless_doubtful(likeness, share))
        for each in answers
    ]
    held_out = [each for each in answers if not each.in_training]
    print_likeness(likeness, share)
    print_unnamed([each.answer.reason for each in held_out])
    score = held_out_score(classifier.classes_.tolist(), held_out)
    if doubted := _of_doubted(named, held_out):
        click.echo(f"Note: {doubted}", err=True)
    click.echo(
        json.dumps(_json(score, answers), indent=2) if as_json else _text(score, len(held_out))
    )
    return not unusable


def _notes(
    classifier: "TerrainClassifier", model: Path, answers: "list[LabelledAnswer]"
) -> list[str]:
    if classifier.trained_on_ is None:
        return [
            f"{model} does not say which images it was trained on; whether these are held out "
            "cannot be determined"
        ]
    notes = []
    trained = [each for each in answers if each.in_training]
    if trained:
        notes.append(
            f"{model} was trained on {len(trained)} of {len(answers)} images (the same pixels, "
            f"saved again, or frames of one scene), such as {trained[0].photo.path}: they do not "
            "count"
        )
    shared = [each for each in answers if each.shares_photo_id and not each.in_training]
    if shared:
        notes.append(
            f"{len(shared)} images have a photo_id that training images have, such as "
            f"{shared[0].photo.path} ({shared[0].photo.group}): if it is the same photograph or "
            "place, they are not held out, and the figures are too good"
        )
    return notes


def _of_scale(classifier: "TerrainClassifier", folder: Path) -> list[str]:
    from terrain.classification.photographs.patches import stated_metres_per_pixel

    own, stated = classifier.metres_per_pixel, stated_metres_per_pixel(folder)
    if own is None or stated is None or abs(stated - own) <= SAME_SCALE * own:
        return []
    return [
        f"manifest.csv states {stated:g} m per pixel, the model was trained at {own:g}: its "
        "answers are for that scale"
    ]


def _of_doubted(named: "list[LabelledAnswer]", answers: "list[LabelledAnswer]") -> str | None:
    """What `--same-camera` would bring, by answers before and after names were doubted."""
    from terrain.classification.answer import UNNOTICED

    pairs = zip(named, answers, strict=True)
    doubted = [before for before, after in pairs if after.answer.reason == UNNOTICED]
    if not doubted:
        return None
    right = sum(each.answer.label == each.photo.label for each in doubted)
    return (
        f"{len(doubted)} names are unknown, as the model would not notice another camera; {right} "
        "of them were right. If these images are of the camera of training, keep them with "
        "--same-camera"
    )


def _text(score: "HeldOutScore", images: int) -> str:
    width = max(9, *(len(name) + 2 for name in (*score.labels, *score.true)))
    header = "".join(name.rjust(width) for name in (*score.labels, "images"))
    lines = [f"{images} images (true terrain down, answer across, %):\n", " " * width + header]
    for name, row in zip(score.true, score.counts, strict=True):
        shares = "".join(f"{100 * n / row.sum():{width}.1f}" for n in row)
        lines.append(name.ljust(width) + shares + f"{row.sum():{width}d}")
    return "\n".join([*lines, "", *_sentences(score)])


def _sentences(score: "HeldOutScore") -> list[str]:
    unknown = score.counts[:, -1]
    is_known = [name in score.labels for name in score.true]
    lines = []
    if score.balanced_accuracy is not None and score.interval is not None:
        low, high = score.interval
        lines.append(
            f"balanced accuracy {score.balanced_accuracy:.3f}, 95 % interval {low:.3f} to "
            f"{high:.3f} (whole photographs drawn); unknown is not right here"
        )
        if score.of_named is not None:
            lines.append(f"of those with a name {score.of_named:.3f}")
    for kind, chosen in (("known", True), ("foreign", False)):
        rows = [of is chosen for of in is_known]
        if any(rows):
            lines.append(
                f"unknown: {unknown[rows].sum()} of {score.counts[rows].sum()} images of {kind} "
                "terrains"
            )
    return lines


def _json(score: "HeldOutScore", answers: "list[LabelledAnswer]") -> dict[str, Any]:
    images = [
        {
            "image": str(each.photo.path),
            "true": each.photo.label,
            "photo_id": each.photo.group,
            "in_training": each.in_training,
        }
        | asdict(each.answer)
        for each in answers
    ]
    counts = {
        name: dict(zip(score.labels, row, strict=True))
        for name, row in zip(score.true, score.counts.tolist(), strict=True)
    }
    return {
        "images": images,
        "confusion": counts,
        "balanced_accuracy": score.balanced_accuracy,
        "balanced_accuracy_interval": score.interval,
        "balanced_accuracy_of_named": score.of_named,
    }


if TYPE_CHECKING:
    from odometry.arrays import ByteImage
    from terrain.classification.classifier import TerrainClassifier


def print_likeness(likeness: "Likeness | None", noticed_share: float | None = None) -> None:
    """Say so where images are unlike, as a whole, or where that would not be noticed."""
    from terrain.classification.likeness.noticed_alterations import unnoticed

    if likeness is not None and (note := likeness.note or unnoticed(noticed_share)) is not None:
        click.echo(f"Note: {note}", err=True)


def print_unnamed(reasons: Sequence[str]) -> None:
    """Say how many images show no terrain, or no colours, by the reasons of all, if any does."""
    from terrain.classification.answer import colourless_note
    from terrain.classification.no_ground import no_ground_note

    for note in (no_ground_note(reasons), colourless_note(Counter(reasons), len(reasons))):
        if note is not None:
            click.echo(f"Note: {note}", err=True)


def readable(paths: Sequence[Path]) -> Iterator["ByteImage"]:
    """The images of those files that can be read, one after another."""
    from contextlib import suppress

    from terrain.errors import ImageError
    from terrain.images import read_image

    for path in paths:
        with suppress(ImageError):
            yield read_image(path)
