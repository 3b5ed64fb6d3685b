"""A switch on a robot that drives along x and sees labels ahead, under both rules."""

from itertools import pairwise

import numpy as np
import pytest

from terrain.switch.place_labels import Footprint, PlaceLabel
from terrain.switch.switch import Switch, SwitchConfig

FOOTPRINT = Footprint(0.5, 0.5)  # regions are of 0.6 m by 0.6 m
AHEAD_M = 1.0
RULES = {"evidence": {}, "rows": {"labels_in_row": 2}}
BOTH_RULES = pytest.mark.parametrize("rule", RULES.values(), ids=RULES)


def start(in_force="grass", **settings_):
    return Switch(in_force, FOOTPRINT, SwitchConfig(**settings_))


def seen_at(x, label, ahead_m=AHEAD_M, probabilities=None):
    """A label of an image taken by a robot at (x, 0), heading along x."""
    place = np.array([x + ahead_m, 0.0])
    return PlaceLabel(label, 2 * x, x, place, ahead_m, probabilities or {})


def drive(switch, labels, spacing_m=0.25, step_m=0.05, to_m=None):
    """Drive along x at 0.5 m/s; labels[k] is of the image at k * spacing_m, "" is no label.

    Returns what was in force at every step as (x, terrain), and all events.
    """
    to_m = len(labels) * spacing_m + AHEAD_M if to_m is None else to_m
    seen, history, events = 0, [], []
    for x in np.arange(0.0, to_m + 1e-9, step_m):
        if seen < len(labels) and x >= seen * spacing_m - 1e-9:
            if labels[seen]:
                switch = switch.add_label(seen_at(x, labels[seen]))
            seen += 1
        switch = switch.at(2 * x, np.array([x, 0.0, 0.0]), x)
        history.append((float(x), switch.in_force))
        events += [switch.event] if switch.event else []
    return history, events


def changes(history):
    """Where and to what the terrain in force changed."""
    pairs = pairwise(history)
    return [(round(x, 6), now) for (_, before), (x, now) in pairs if now != before]
