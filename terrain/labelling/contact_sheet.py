"""One picture of the patches of a class, each with its name."""

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from odometry.arrays import ByteImage
from odometry.io.files import atomic_write
from terrain.images import read_image

TILE_PX, CAPTION_PX, GAP_PX = 128, 16, 4
COLUMNS = 10
MOST = 500  # patches of a picture, spread evenly


def write_contact_sheet(file: Path, folder: Path, paths: Sequence[str]) -> None:
    """Draw patches side by side, each above its file name without run and suffix.

    Parameters
    ----------
    file : Path
        PNG.
    folder : Path
    paths : sequence of str
        Of patches, relative to the folder, at least one; of more than MOST some are left out.
    """
    shown = paths
    if len(paths) > MOST:
        shown = [paths[row] for row in np.linspace(0, len(paths) - 1, MOST).astype(int)]
    tiles = [_tile(read_image(folder / path), _caption(path)) for path in shown]
    blank = np.full_like(tiles[0], 255)
    columns = min(COLUMNS, len(tiles))
    tiles += [blank] * (-len(tiles) % columns)
    rows = [np.hstack(tiles[row : row + columns]) for row in range(0, len(tiles), columns)]
    with atomic_write(file) as part:
        part.write_bytes(cv2.imencode(".png", np.vstack(rows)[..., ::-1])[1].tobytes())


def _tile(image: ByteImage, caption: str) -> ByteImage:
    """RGB patch of TILE_PX, with its caption below and a white gap around."""
    size = (TILE_PX, TILE_PX)
    patch = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    patch = cv2.cvtColor(patch, cv2.COLOR_GRAY2RGB) if patch.ndim == 2 else patch
    tile = np.full((TILE_PX + CAPTION_PX + GAP_PX, TILE_PX + GAP_PX, 3), 255, np.uint8)
    tile[:TILE_PX, :TILE_PX] = patch
    place = (0, TILE_PX + CAPTION_PX - 4)
    cv2.putText(tile, caption, place, cv2.FONT_HERSHEY_SIMPLEX, 0.36, (0, 0, 0), 1, cv2.LINE_AA)
    return tile


def _caption(path: str) -> str:
    """Image, and centimetres ahead and to the left: the end of the name."""
    return "_".join(Path(path).stem.rsplit("_", 3)[1:])
