"""Labelled patches as files: images by class, their manifest, a contact sheet of each class."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path

import cv2
import numpy as np
from tqdm import tqdm

from odometry.arrays import ByteImage
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from terrain.camera.camera import Camera
from terrain.errors import CameraError, ImageError
from terrain.images import read_image
from terrain.labelling.corrections import Corrections
from terrain.labelling.label_runs import ChosenSquare, LabelledTerrain
from terrain.region.warp import ground_view

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


def write_labelled_patches(
    folder: Path,
    labelled: LabelledTerrain,
    corrections: Corrections | None = None,
    *,
    show_progress: bool = False,
) -> dict[str, str]:
    """Write `folder/<class>/*.png`, manifest.csv and contact_sheet_<class>.png.

    Parameters
    ----------
    folder : Path
        Readable by `train` afterwards.
    labelled : LabelledTerrain
    corrections : Corrections, optional
        Names that were removed are kept in the manifest, so that they stay removed.
    show_progress : bool

    Returns
    -------
    dict of str to str
        Why images could not be used, by their file; their patches are left out.

    Raises
    ------
    ImageError
        If no image can be used.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> import odometry
    >>> import terrain
    >>> whole = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> run = odometry.cut_run(whole, odometry.Span(0.0, 6.0))
    >>> labelled = terrain.label_runs([run], [terrain.given_terrain(run)])
    >>> with TemporaryDirectory() as folder:
    ...     refused = terrain.write_labelled_patches(Path(folder), labelled)
    ...     print(refused, len(list(Path(folder).rglob("*.png"))) > 1)
    {} True
    """
    unusable: dict[str, str] = {}
    written: list[ChosenSquare] = []
    bar = tqdm(total=len(labelled.chosen), desc="patches", disable=None if show_progress else True)
    for squares, patches in _patches(labelled, unusable):
        for each, patch in zip(squares, patches, strict=True):
            with atomic_write(folder / _path(each)) as part:
                part.write_bytes(_png(patch))
        written += squares
        bar.update(len(squares))
    bar.close()
    if not written:
        file, reason = next(iter(unusable.items()))
        raise ImageError(f"none of {len(unusable)} images can be used: {file}: {reason}")
    removed = sorted(corrections.removed) if corrections else []
    _write_manifest(folder / "manifest.csv", written, removed, labelled.scale.metres_per_pixel)
    for label in sorted({each.label for each in written}):
        paths = [_path(each) for each in written if each.label == label]
        write_contact_sheet(folder / f"contact_sheet_{label}.png", folder, paths)
    return unusable


def _patches(
    labelled: LabelledTerrain, unusable: dict[str, str]
) -> Iterator[tuple[list[ChosenSquare], list[ByteImage]]]:
    """The squares of each image and their patches; each image is read once."""
    by_image = sorted(labelled.chosen, key=_image)
    scale = labelled.scale.metres_per_pixel
    for file, group in groupby(by_image, key=_image):
        squares = list(group)
        run = squares[0].of.run
        camera = Camera.from_table(run.settings["camera"], str(run.folder / "run.toml"))
        try:
            image = read_image(Path(file))
            camera.check_size(image)
        except (ImageError, CameraError) as error:
            unusable[file] = str(error)
            continue
        rectangles = [each.of.square.rectangle for each in squares]
        yield squares, [ground_view(image, camera, one, scale) for one in rectangles]


def _image(each: ChosenSquare) -> str:
    return str(each.of.run.folder / each.of.square.image)


def _path(each: ChosenSquare) -> str:
    return f"{each.label}/{each.of.name}"


def _png(image: ByteImage) -> bytes:
    stored = image if image.ndim == 2 else image[..., ::-1]
    return cv2.imencode(".png", stored)[1].tobytes()


def _write_manifest(
    file: Path, written: Sequence[ChosenSquare], removed: Sequence[str], scale: float
) -> None:
    """A row a patch: its group, and where it comes from; then the names that were removed."""
    chosen = sorted(written, key=_path)
    squares = [each.of.square for each in chosen]
    middles = np.array([square.rectangle.middle for square in squares])
    gone, nothing = len(removed), np.full(len(removed), np.nan)
    numbers = {
        "t": [square.stamp_s for square in squares],
        "ahead": middles[:, 0],
        "left": middles[:, 1],
        "x": [square.place_m[0] for square in squares],
        "y": [square.place_m[1] for square in squares],
        "over_from": [square.passing.begin_s for square in squares],
        "over_to": [square.passing.end_s for square in squares],
        "confidence": [each.of.confidence for each in chosen],
    }
    texts = {
        "path": [*map(_path, chosen), *(f"removed/{name}" for name in removed)],
        "class": [*(each.label for each in chosen), *[""] * gone],
        "photo_id": [*(each.photo_id for each in chosen), *["removed"] * gone],
        "metres_per_pixel": [f"{scale:g}"] * (len(chosen) + gone),
        "told": [*(each.of.label for each in chosen), *["removed"] * gone],
        "run": [*(each.of.run.name for each in chosen), *[""] * gone],
        "image": [*(each.of.square.image for each in chosen), *[""] * gone],
    }
    columns = {name: np.array(cells) for name, cells in texts.items()}
    columns |= {name: np.concatenate([cells, nothing]) for name, cells in numbers.items()}
    write_csv_table(file, columns)
