"""Images with texture that show no terrain: photographs and drawings of things.

Split before anything was measured on them: DEVELOPMENT are those whose figures were known before
(cat, cup, person, coins, page, handwriting, chessboard, carpet) and two more made ones; TEST are
the other photographs of scikit-image, scikit-learn and matplotlib, and made ones drawn without
knowledge of any score. What is chosen is chosen on DEVELOPMENT alone.
"""

from collections.abc import Callable
from pathlib import Path

import cv2
import matplotlib as mpl
import numpy as np
from skimage import data as pictures
from sklearn.datasets import load_sample_image

from odometry.arrays import AnyArray, ByteImage, FloatArray
from terrain.classification.photographs.patches import cut_patches
from terrain.images import read_image

MADE = 30
Made = Callable[[np.random.Generator, int], ByteImage]
Things = dict[str, list[ByteImage]]


def _colour(image: ByteImage | FloatArray) -> ByteImage:
    """RGB bytes, whatever it was."""
    image = np.asarray(image)
    if image.dtype == bool:
        image = image * np.uint8(255)
    grey = image.ndim == 2
    return np.asarray(np.stack([image] * 3, axis=-1) if grey else image[..., :3], np.uint8)


def _finished(rng: np.random.Generator, grey: AnyArray, tint: FloatArray) -> ByteImage:
    """Tinted, a little blurred, with the noise of a sensor."""
    blurred = cv2.GaussianBlur(grey.astype(np.float32), (0, 0), rng.uniform(0.4, 1.0))
    shown = blurred[..., None] * tint
    return np.clip(shown + rng.normal(0, rng.uniform(1, 4), shown.shape), 0, 255).astype(np.uint8)


def _plain(size: int, level: float) -> ByteImage:
    return np.full((size, size), level, np.uint8)


def _tint(rng: np.random.Generator) -> FloatArray:
    return np.asarray(rng.uniform(0.6, 1.0, 3))


def carpet(rng: np.random.Generator, size: int) -> ByteImage:
    """Short green threads in every direction."""
    grey = _plain(size, 90)
    for _ in range(size * size // 12):
        x, y = rng.uniform(0, size, 2)
        turn, length = rng.uniform(0, 2 * np.pi), rng.uniform(3, 6)
        end = (int(x + length * np.cos(turn)), int(y + length * np.sin(turn)))
        cv2.line(grey, (int(x), int(y)), end, float(rng.uniform(50, 200)), 1)
    return _finished(rng, grey, np.array([0.5, 1.0, 0.5]))


def print_(rng: np.random.Generator, size: int) -> ByteImage:
    """Lines of print."""
    grey = _plain(size, rng.uniform(180, 250))
    scale = rng.uniform(0.3, 0.8)
    step = int(30 * scale) + 3
    for y in range(step, size + step, step):
        words = "".join(rng.choice(list("abcdefghiklmnoprstuvw  "), 40))
        at = (int(rng.integers(-10, 3)), y)
        cv2.putText(grey, words, at, cv2.FONT_HERSHEY_SIMPLEX, scale, 40.0, 1, cv2.LINE_AA)
    return _finished(rng, grey, np.ones(3))


def plaid(rng: np.random.Generator, size: int) -> ByteImage:
    """Cloth with stripes in both directions."""
    rows, columns = (np.repeat(rng.uniform(0, 1, size), rng.integers(4, 14))[:size]
                     for _ in range(2))  # fmt: skip
    weave = 12 * np.sin(np.add.outer(np.arange(size), np.arange(size)) * rng.uniform(1.0, 2.5))
    grey = 60 + 80 * (rows[:, None] + columns) + weave
    return _finished(rng, grey, _tint(rng))


def curtain(rng: np.random.Generator, size: int) -> ByteImage:
    """Folds of cloth, nearly upright."""
    rows, columns = np.mgrid[:size, :size].astype(np.float32)
    place = columns + rng.uniform(-0.3, 0.3) * rows
    folds = sum(
        np.sin(2 * np.pi * place / rng.uniform(8, 60) + rng.uniform(0, 6)) for _ in range(4)
    )
    return _finished(rng, 130 + 25 * np.asarray(folds), _tint(rng))


def keyboard(rng: np.random.Generator, size: int) -> ByteImage:
    """Keys with letters, in rows."""
    grey = _plain(size, rng.uniform(10, 60))
    step = int(rng.integers(18, 34))
    for row, y in enumerate(range(-4, size, step)):
        for x in range(-step + row * 5 % step, size, step):
            corners = (x + 2, y + 2), (x + step - 3, y + step - 3)
            cv2.rectangle(grey, *corners, float(rng.uniform(150, 190)), -1)
            letter = chr(int(rng.integers(65, 91)))
            cv2.putText(grey, letter, (x + 6, y + step - 9), 0, step / 60, 20.0, 1, cv2.LINE_AA)
    return _finished(rng, grey, np.ones(3))


def wood(rng: np.random.Generator, size: int) -> ByteImage:
    """The grain of a board."""
    rows, columns = np.mgrid[:size, :size].astype(np.float32)
    bent = cv2.GaussianBlur(rng.normal(0, 1, (size, size)).astype(np.float32), (0, 0), 24) * 120
    rings = np.sin((rows + bent) * rng.uniform(0.3, 1.2))
    fibres = cv2.GaussianBlur(rng.normal(0, 1, (size, size)), (0, 0), sigmaX=12, sigmaY=0.6)
    grey = 140 + 25 * rings + 90 * fibres + 0.1 * columns
    return _finished(rng, grey, np.array([1.0, 0.8, 0.55]))


def leaves(rng: np.random.Generator, size: int) -> ByteImage:
    """Leaves of a hedge, one over another."""
    grey = _plain(size, 20)
    for _ in range(size * size // 60):
        centre = tuple(rng.integers(0, size, 2).tolist())
        axes = (int(rng.integers(5, 13)), int(rng.integers(2, 6)))
        turn, shade = float(rng.uniform(0, 180)), float(rng.uniform(60, 210))
        cv2.ellipse(grey, centre, axes, turn, 0, 360, shade, -1)
        cv2.ellipse(grey, centre, axes, turn, 0, 360, shade * 0.7, 1)
    return _finished(rng, grey, np.array([0.6, 1.0, 0.4]))


def knitting(rng: np.random.Generator, size: int) -> ByteImage:
    """Stitches of wool in columns."""
    rows, columns = np.mgrid[:size, :size].astype(np.float32)
    wide, high = rng.uniform(7, 16), rng.uniform(5, 12)
    across = (columns % wide) / wide - 0.5
    stitch = np.sin(2 * np.pi * (rows / high + np.abs(across) * 1.5))
    grey = 110 + 50 * stitch * np.cos(np.pi * across) + rng.normal(0, 8, (size, size))
    return _finished(rng, grey, _tint(rng))


def shelves(rng: np.random.Generator, size: int) -> ByteImage:
    """Boxes of all sizes, one before another."""
    grey = _plain(size, 50)
    for _ in range(25):
        x, y = rng.integers(-20, size, 2).tolist()
        w, h = rng.integers(10, 60, 2).tolist()
        cv2.rectangle(grey, (x, y), (x + w, y + h), float(rng.uniform(30, 230)), -1)
        cv2.rectangle(grey, (x, y), (x + w, y + h), 20.0, 1)
    return _finished(rng, grey, _tint(rng))


def _drawn(make: Made, seed: int, size: int) -> list[ByteImage]:
    rng = np.random.default_rng(seed)
    return [make(rng, size) for _ in range(MADE)]


def _enlarged(image: ByteImage, times: int) -> ByteImage:
    large = cv2.resize(_colour(image), None, fx=times, fy=times, interpolation=cv2.INTER_CUBIC)
    return np.asarray(large, np.uint8)


def development(size: int) -> Things:
    """Square patches of things that choices may be made on."""
    photographs = {
        "cat": pictures.cat(),
        "cup on a table": pictures.coffee(),
        "person": pictures.astronaut(),
        "coins": pictures.coins(),
        "page": pictures.page(),
        "handwriting": pictures.text(),
        "handwriting, twice as large": _enlarged(pictures.text(), 2),
        "chessboard": _enlarged(pictures.checkerboard(), 2),
    }
    made = {"carpet, made": carpet, "print, made": print_, "plaid, made": plaid}
    return _cut(photographs, size) | _all_drawn(made, 11, size)


def reserved(size: int) -> Things:
    """Square patches of things that are looked at once, at the end."""
    samples = Path(mpl.get_data_path()) / "sample_data"
    motorcycle, _, _ = pictures.stereo_motorcycle()
    photographs = {
        "motorcycle in a garage": motorcycle,
        "cameraman, below the sky": pictures.camera()[128:256],
        "moving clock": pictures.clock(),
        "moon": pictures.moon(),
        "retina": pictures.retina()[300:1100, 300:1100],
        "tissue": pictures.immunohistochemistry(),
        "stars": pictures.hubble_deep_field()[:512, :512],
        "cell": pictures.cell(),
        "rocket, below the sky": pictures.rocket()[128:],
        "logo": pictures.logo(),
        "temple": load_sample_image("china.jpg"),
        "flower": load_sample_image("flower.jpg"),
        "second person": read_image(samples / "grace_hopper.jpg"),
    }
    made = {
        "curtain, made": curtain,
        "keyboard, made": keyboard,
        "wood, made": wood,
        "leaves, made": leaves,
        "knitting, made": knitting,
        "shelves, made": shelves,
    }
    return _cut(photographs, size) | _all_drawn(made, 12, size)


def _cut(photographs: dict[str, ByteImage], size: int) -> Things:
    return {name: cut_patches(_colour(image), size) for name, image in photographs.items()}


def _all_drawn(made: dict[str, Made], seed: int, size: int) -> Things:
    return {name: _drawn(make, seed, size) for name, make in made.items()}
