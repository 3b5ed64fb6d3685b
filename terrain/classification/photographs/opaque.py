"""Where a photograph is opaque: what lies under transparent parts is no terrain."""

import warnings
from pathlib import Path

import numpy as np
from PIL import Image

from odometry.arrays import BoolArray

OPAQUE = 128  # of 255


def opaque(photo: Path) -> BoolArray | None:
    """Which pixels (rows, columns) of a file are opaque; None where it has no transparent ones."""
    try:
        with warnings.catch_warnings(action="ignore"), Image.open(photo) as image:
            if not image.has_transparency_data:
                return None
            alpha = np.asarray(image.convert("RGBA").getchannel("A"))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        return None
    shows = alpha >= OPAQUE
    return None if shows.all() else shows
