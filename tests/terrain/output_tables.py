"""Output files as tests read them."""

import csv
import json

import numpy as np

TERRAIN = ["t", "label", "confidence", "distance_ahead", "terrain_in_force"]


def columns(file):
    """Header, and columns as text by name."""
    with file.open(newline="") as stream:
        rows = list(csv.reader(stream))
    return rows[0], dict(zip(rows[0], zip(*rows[1:], strict=True), strict=True))


def numbers(file, names):
    """The named columns side by side."""
    _, found = columns(file)
    return np.column_stack([np.array(found[name], float) for name in names])


def refuse(word):
    raise ValueError(f"{word} is no JSON")


def strict(text):
    """JSON as the standard has it, without NaN and Infinity."""
    return json.loads(text, parse_constant=refuse)
