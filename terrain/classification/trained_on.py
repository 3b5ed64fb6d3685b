"""What a classifier was trained on, so that a test on the same photographs is recognised."""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from odometry.arrays import ByteImage

SUM_DIGITS = 16  # of SHA-256: chance matches among a million images are of the order of 1e-8


@dataclass(frozen=True)
class TrainedOn:
    """The photographs of a training set.

    Attributes
    ----------
    image_sums : frozenset of str
        Of their pixels, by `image_sum`.
    photo_ids : frozenset of str
        Those that a manifest gave.
    """

    image_sums: frozenset[str]
    photo_ids: frozenset[str] = frozenset()

    def to_table(self) -> dict[str, list[str]]:
        """Values that JSON can hold, in order."""
        return {"image_sums": sorted(self.image_sums), "photo_ids": sorted(self.photo_ids)}

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Read what `to_table` gave.

        Raises
        ------
        KeyError, TypeError
            If a list is missing or no list of texts.
        """
        lists = [table[name] for name in ("image_sums", "photo_ids")]
        for texts in lists:
            if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
                raise TypeError(f"trained_on holds {texts!r}")
        return cls(*map(frozenset, lists))


def image_sum(image: ByteImage) -> str:
    """Sum of the pixels of an image: the same for a copy under another name or lossless format."""
    content = f"{image.shape}".encode() + image.tobytes()
    return hashlib.sha256(content).hexdigest()[:SUM_DIGITS]
