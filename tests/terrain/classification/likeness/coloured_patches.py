"""Coloured patches of two made terrains, and an answer to doubt."""

import numpy as np

from terrain.classification.answer import Classification
from terrain.classification.likeness.likeness import Likeness

SIZE_PX = 48
NAMED = Classification("mud", 0.8, 1.0, {"mud": 0.8, "sand": 0.2}, probability_right=0.8)
LIKE = Likeness(40, 0.5, 0.5, (), beyond=0.5)


def photographs(seed, grain, photos=8, each=3):
    """Patches of dust and soil, which varies more: a mean colour and `grain` of (rng, sigma)."""
    rng = np.random.default_rng(seed)
    images, labels, groups = [], [], []
    for label, sigma in (("dust", 12.0), ("soil", 25.0)):
        for photo in range(photos):
            mean = np.array([130, 115, 95]) * rng.uniform(0.8, 1.2)
            for _ in range(each):
                images.append(np.clip(mean + grain(rng, sigma), 0, 255).astype(np.uint8))
                labels.append(label)
                groups.append(f"{label} {photo}")
    return images, np.array(labels), np.array(groups)
