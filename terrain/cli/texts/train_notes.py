"""What `train` says of the photographs before it writes the model."""

from collections.abc import Iterator
from pathlib import Path

from terrain.classification.likeness.noticed_alterations import unnoticed
from terrain.classification.photographs.finest_detail import set_apart_by_pixels
from terrain.classification.photographs.manifest import read_manifest
from terrain.classification.photographs.patches import SUFFIXES, LabelledPatches
from terrain.classification.photographs.photo_faults import unread_note
from terrain.classification.photographs.photo_origins import set_apart
from terrain.classification.training import LARGEST_PATCH_PX, Training


def notes(
    training: Training, folder: Path, *, colour: bool, chooses_size: bool = False
) -> Iterator[str]:
    """What was left out, what is no test of the model, and what is in it.

    Parameters
    ----------
    training : Training
    folder : Path
        Of the photographs.
    colour : bool
        Whether colour was asked for.
    chooses_size : bool
        Whether the size of patches follows from the photographs.
    """
    classifier, patches = training.classifier, training.patches
    size = classifier.patch_size_px
    if unread := unread_note(list(patches.sides_px), SUFFIXES):
        yield f"Note: {unread}"
    for path in patches.too_small:
        yield f"left out, smaller than {size} x {size} pixels, or transparent: {path}"
    if chooses_size:
        yield from _of_size(patches, size)
    yield from _of_groups(patches)
    yield from _of_origins(patches)
    yield from _of_sharpness(patches)
    if colour and not classifier.colour_:
        yield "Colour is left out: patches are grey, or most of a class are, or the preset is."
    if (what := unnoticed(classifier.noticed_share_)) is not None:
        yield f"Note: {what}"
    if (manifest := read_manifest(folder)) is not None and manifest.runs:
        yield (
            f"Note: the patches are of {', '.join(manifest.runs)}: what is held out are other "
            "places of the same recordings. The same terrain has another texture elsewhere: label "
            "recordings of several sites, and test the model on one that is held out (classify)"
        )


def _of_size(patches: LabelledPatches, size_px: int) -> Iterator[str]:
    """Which photographs make patches small, where most are large enough for large ones."""
    smaller = sorted((of, path) for path, of in patches.sides_px.items() if of < LARGEST_PATCH_PX)
    if size_px < LARGEST_PATCH_PX and 2 * len(smaller) < len(patches.sides_px):
        yield (
            f"Note: patches have {size_px} px in place of {LARGEST_PATCH_PX}, which do not fit "
            f"into {len(smaller)} of {len(patches.sides_px)} photographs, such as {smaller[0][1]} "
            f"(its shorter side: {smaller[0][0]} px). Small patches show less of a terrain: "
            f"--patch-size {LARGEST_PATCH_PX} leaves these photographs out"
        )


def _of_groups(patches: LabelledPatches) -> Iterator[str]:
    """Where photographs that are held out may be of one scene with others."""
    photos, grouped = set(patches.photos), _grouped(patches)
    if 0 < len(grouped) < len(photos):
        yield (
            f"Note: manifest.csv groups {len(grouped)} of {len(photos)} photographs; each of the "
            f"others is a group of its own, such as {min(photos - grouped)}"
        )
    alike = patches.alike
    label_of = dict(zip(patches.photos, patches.labels, strict=True))
    scene_of = dict(zip(patches.photos, patches.scenes, strict=True))
    if contrary := [pair for pair in alike if label_of[pair[0]] != label_of[pair[1]]]:
        one, other = contrary[0]
        yield (
            f"Note: {_count(contrary)} of {len(photos)} photographs look like one with another "
            f"label, such as {one} ({label_of[one]}) and {other} ({label_of[other]}): one scene "
            "cannot be both, and names of either mean little. Move or delete the wrong one"
        )
    if alike := [pair for pair in alike if label_of[pair[0]] == label_of[pair[1]]]:
        one, other = alike[0]
        apart = {label_of[one] for one, other in alike if scene_of[one] != scene_of[other]}
        yield (
            f"Note: {_count(alike)} of {len(photos)} photographs look like another one, such as "
            f"{one} and {other}: copies, pieces, or frames of one scene. They are held out "
            "together; what this check misses needs the same photo_id in manifest.csv"
            + (f". All of {', '.join(sorted(apart))} would be one scene: no test" if apart else "")
        )


def _count(pairs: list[tuple[Path, Path]]) -> int:
    """Of photographs that look like another one."""
    return len({one for one, _ in pairs})


def _of_origins(patches: LabelledPatches) -> Iterator[str]:
    """Where all photographs of a terrain are of an origin of their own."""
    apart = set_apart(dict(zip(patches.photos, patches.labels, strict=True)))
    if apart:
        yield (
            "Note: the files say that photographs of a terrain have an origin that those of no "
            f"other terrain have: {_listed(apart)}. What is held out has the same origin. A model "
            "that recognises the camera, and not the terrain, would seem to be right: test it on "
            "photographs of several terrains by one camera (classify)"
        )


def _of_sharpness(patches: LabelledPatches) -> Iterator[str]:
    """Where photographs of a terrain alone are blurred, enlarged or noisy."""
    photo_of = dict(zip(patches.scenes, patches.photos, strict=True))  # one of each scene
    label_of = dict(zip(patches.photos, patches.labels, strict=True))
    apart = set_apart_by_pixels({photo: label_of[photo] for photo in photo_of.values()})
    if apart:
        yield (
            "Note: by their pixels most photographs of a terrain are unlike most of any other: "
            f"{_listed(apart)}. Less sharp ones are blurred, enlarged or out of focus, or show a "
            "smooth surface alone. What is held out is alike, so that its score says little where "
            "that is the camera: test the model on photographs of several by one (classify)"
        )


def _listed(apart: dict[str, str]) -> str:
    return "; ".join(f"{terrain} ({how})" for terrain, how in apart.items())


def _grouped(patches: LabelledPatches) -> set[Path]:
    """The photographs that a manifest names: the others are named after themselves."""
    pairs = zip(patches.photos, patches.groups, strict=True)
    return {photo for photo, group in pairs if group != str(photo)}
