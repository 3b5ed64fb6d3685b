"""Photographs that look alike are held out together, so that none is the test of its copy."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from terrain.classification.photographs.patches import LabelledPatches, LabelledPhoto
from terrain.classification.photographs.photo_faults import look_alikes


def with_scenes(patches: LabelledPatches) -> LabelledPatches:
    """The patches, with what `look_alikes` finds among their photographs.

    Photographs with two labels stay apart: one of them has the wrong one.
    """
    named = zip(patches.photos, patches.labels, patches.groups, strict=True)
    photos = {path: LabelledPhoto(path, label, group) for path, label, group in named}
    alike = look_alikes({path: photo.group for path, photo in photos.items()})
    pairs = [(photos[one], photos[other]) for one, other in alike]
    same = [(one.group, other.group) for one, other in pairs if one.label == other.label]
    return replace(patches, alike=alike, scene_of=scene_of_groups(list(photos.values()), same))


def scene_of_groups(
    photos: Sequence[LabelledPhoto], alike: Iterable[tuple[str, str]]
) -> dict[str, str]:
    """The scene of each group that is alike another: the first of their names.

    Groups of a terrain that would be one scene alone stay as they are, since one must be held out.

    Parameters
    ----------
    photos : sequence of LabelledPhoto
    alike : pairs of groups
    """
    scenes = {photo.group: photo.group for photo in photos}
    for one, other in alike:
        first, second = sorted((_first(scenes, one), _first(scenes, other)))
        scenes[second] = first
    found = {group: _first(scenes, group) for group in scenes}
    of_terrain: dict[str, set[str]] = defaultdict(set)
    for photo in photos:
        of_terrain[photo.label].add(found[photo.group])
    alone = {photo.group for photo in photos if len(of_terrain[photo.label]) < 2}
    return {group: scene for group, scene in found.items() if group != scene and group not in alone}


def _first(scenes: Mapping[str, str], group: str) -> str:
    while scenes[group] != group:
        group = scenes[group]
    return group
