"""Loads of a rigid body on equal springs, none of which pulls.

Places are in base units: half lengths forward, half widths to the left. Samples come last.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray

MOST_CHANGES = 50  # of which contacts press; six were enough for ten contacts a side


@dataclass(frozen=True)
class Layout:
    """Where the contacts of each sample are.

    Attributes
    ----------
    places : (3, C, N)
        1, place forward (-1 to 1), side (1 left, -1 right); zeros where a sample has fewer than
        C contacts.
    weights : (3, C, N)
        Each contact's share of the load is the product of these with (1, centre of pressure),
        when all press.
    """

    places: FloatArray
    weights: FloatArray

    def rows(self, chosen: BoolArray) -> "Layout":
        """Some of the samples."""
        return Layout(self.places[..., chosen], self.weights[..., chosen])


def even_layout(contacts: FloatArray) -> Layout:
    """Layout of contacts (N,) a side, evenly spaced from the rear to the front of both sides."""
    count = np.maximum(np.rint(contacts), 2)
    number = np.arange(int(count.max(initial=2)))[:, None]
    present = (number < count).astype(float)
    forward = (2 * number / (count - 1) - 1) * present
    left, right = np.stack([present, forward, present]), np.stack([present, forward, -present])
    places = np.concatenate([left, right], axis=1)
    return Layout(places, places / np.sum(places**2, axis=1, keepdims=True))


def load_shares(centre: FloatArray, layout: Layout) -> tuple[FloatArray, FloatArray]:
    """Share (C, N) of the load on each contact, and its derivative (2, C, N) by the centre.

    The shares of the contacts that press are linear in their place, add up to one, and have
    their centre at the centre of pressure; the others bear nothing. The derivative jumps where
    a contact lifts off.

    Parameters
    ----------
    centre : (2, N)
        Centre of pressure, within the base: between -1 and 1, ends excluded.
    layout : Layout
    """
    weights = layout.weights
    shares = weights[0] + weights[1] * centre[0] + weights[2] * centre[1]
    slopes = weights[1:]
    lifted = np.flatnonzero(np.any(shares < 0, axis=0))
    if len(lifted):
        slopes = slopes.copy()
        shares[:, lifted], slopes[..., lifted] = _shares_with_lift(
            centre[:, lifted], layout.places[..., lifted], shares[:, lifted] > 0
        )
    return shares, slopes


def _shares_with_lift(
    centre: FloatArray, places: FloatArray, pressed: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Lift what pulls, lower what has been lifted onto the plane's wrong side, until it stays."""
    load = np.stack([np.ones_like(centre[0]), *centre])
    for _ in range(MOST_CHANGES):
        bearing = places * pressed
        moments = np.einsum("icn,jcn->nij", bearing, bearing)
        weights = np.einsum("nij,jcn->icn", np.linalg.inv(moments), places)
        plane = np.einsum("icn,in->cn", weights, load)
        presses = plane > 0
        if np.array_equal(presses, pressed):
            break
        pressed = presses
    return np.where(presses, plane, 0.0), weights[1:] * presses
