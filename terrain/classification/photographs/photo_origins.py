"""Photographs of one terrain that are of another origin than all others, by what files say.

What is held out is of the same origin then, so that a model which recognises a camera or a
compression seems to recognise terrain.
"""

import warnings
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path

from PIL import ExifTags, Image

FEWEST = 5  # photographs of a terrain
OFTEN = 3  # photographs that share a size or a table: crops of any size say nothing
MOST_OF = 0.8


def set_apart(label_of: Mapping[Path, str]) -> dict[str, str]:
    """Terrains whose photographs are set apart, and by what in words.

    Most photographs of such a terrain have a camera, a focal length, a file format, tables of JPEG
    compression, or a number of pixels that no photograph of another terrain has. Files that cannot
    be read are left out.

    Parameters
    ----------
    label_of : mapping of Path to str
        The terrain of each photograph.
    """
    signs = {path: _signs(path) for path in label_of}
    apart: dict[str, str] = {}
    for terrain in sorted(set(label_of.values())):
        own = [signs[path] for path, label in label_of.items() if label == terrain]
        others = [signs[path] for path, label in label_of.items() if label != terrain]
        for name in SIGNS:
            used = Counter(of[name] for of in own if of.get(name))
            unique = set(used) - {of.get(name) for of in others}
            count = sum(used[value] for value in unique if used[value] >= OFTEN)
            if others and len(own) >= FEWEST and count >= MOST_OF * len(own):
                apart[terrain] = f"{name}: {count} of {len(own)}"
                break
    return apart


def _camera(image: Image.Image) -> str:
    tags = image.getexif()
    found = (tags.get(tag) for tag in (ExifTags.Base.Make, ExifTags.Base.Model))
    return " ".join(str(of).strip() for of in found if of)


def _focal_length(image: Image.Image) -> str:
    """With the digital zoom: phones have several lenses, and enlarge what the longest shows."""
    tags = image.getexif().get_ifd(ExifTags.IFD.Exif)
    found = (tags.get(tag) for tag in (ExifTags.Base.FocalLength, ExifTags.Base.DigitalZoomRatio))
    return " ".join(str(of) for of in found if of)


def _format(image: Image.Image) -> str:
    return image.format or ""


def _compression(image: Image.Image) -> str:
    tables = getattr(image, "quantization", None)
    return repr(tables) if tables else ""


def _size(image: Image.Image) -> str:
    """Whichever side is up."""
    return repr(sorted(image.size))


SIGNS: dict[str, Callable[[Image.Image], str]] = {
    "camera": _camera,
    "focal length": _focal_length,
    "file format": _format,
    "JPEG compression": _compression,
    "number of pixels": _size,
}


def _signs(path: Path) -> dict[str, str]:
    """What a file says of its origin; nothing of one that cannot be read."""
    try:
        with warnings.catch_warnings(action="ignore"), Image.open(path) as image:  # damaged tags
            return {name: of(image) for name, of in SIGNS.items()}
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return {}
