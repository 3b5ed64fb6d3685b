"""A robot on its contacts: parameters, inputs and loads of the force balance.

Places are in base units: half lengths forward, half widths to the left. Samples come last.

Samples (N) come last, contacts (C) before them.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.models.inputs import Inputs
from odometry.models.three_equations import solve_3x3

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

    def rows(self, chosen: IntArray) -> "Layout":
        """Some of the samples, by their numbers."""
        return Layout(self.places.take(chosen, axis=-1), self.weights.take(chosen, axis=-1))


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
        moments = ((places * pressed)[:, None] * places).sum(axis=2)
        weights = solve_3x3(moments, places)
        plane = (weights * load[:, None]).sum(axis=0)
        presses = plane > 0
        if np.array_equal(presses, pressed):
            break
        pressed = presses
    return np.where(presses, plane, 0.0), weights[1:] * presses


INSIDE = 0.9  # of the base: where a centre of mass further out is held
GRIP = 0.95  # of what friction bears: where a stronger gravity is held
LEAST_NORMAL = 0.05  # of g, at 87 degrees


@dataclass(frozen=True)
class Stance:
    """Samples of a robot that is driven at given tread speeds.

    Attributes
    ----------
    layout : Layout
        Of its contacts.
    places_m : (2, C, N)
        Forward and to the left.
    base_m : (2, N)
        Half length and half width.
    centre : (2, N)
        Of mass, over the ground plane, in base units.
    height_m, mu, slip_scale_m_s : (N,)
    tread_speeds_m_s : (2, N)
        Left and right.
    gravity : (2, N)
        Its part along the ground, of g; no more than `GRIP` of what friction bears.
    normal : (N,)
        Its part into the ground, of g.
    held : (N,) of bool
        Where `gravity` is less than the slope would have it.
    """

    layout: Layout
    places_m: FloatArray
    base_m: FloatArray
    centre: FloatArray
    height_m: FloatArray
    mu: FloatArray
    slip_scale_m_s: FloatArray
    tread_speeds_m_s: FloatArray
    gravity: FloatArray
    normal: FloatArray
    held: BoolArray

    @property
    def centre_m(self) -> FloatArray:
        """Place (2, N) of the centre of mass: x_cm and y_cm, where they are inside."""
        return np.asarray(self.centre * self.base_m)

    @property
    def centre_is_inside(self) -> BoolArray:
        """Where each coordinate (2, N) of the centre of mass is as given."""
        return np.asarray(np.abs(self.centre) < INSIDE)

    def rows(self, chosen: IntArray) -> "Stance":
        """Some of the samples, by their numbers."""
        fields = {name: field for name, field in vars(self).items() if name != "layout"}
        return Stance(
            self.layout.rows(chosen),
            **{name: field.take(chosen, axis=-1) for name, field in fields.items()},
        )


def stance_of(values: FloatArray, inputs: Inputs) -> Stance:
    """Stance of parameters (N, 9), in the order of `Contact`, and inputs of stack (N,)."""
    mu, _, x_cm, y_cm, height, half_length, half_width, contacts, slip_scale = values.T
    roll, pitch = inputs.roll_rad, inputs.pitch_rad
    base = np.stack([half_length, half_width])
    slope = np.stack([np.sin(pitch), -np.cos(pitch) * np.sin(roll)])  # REP-103
    normal = np.maximum(np.cos(pitch) * np.cos(roll), LEAST_NORMAL)
    steepness, limit = np.hypot(*slope), GRIP * mu * normal
    layout = even_layout(contacts)
    return Stance(
        layout=layout,
        places_m=layout.places[1:] * base[:, None],
        base_m=base,
        centre=np.clip(np.stack([x_cm, y_cm]) / base, -INSIDE, INSIDE),
        height_m=height,
        mu=mu,
        slip_scale_m_s=slip_scale,
        tread_speeds_m_s=inputs.tread_speeds_m_s.T,
        gravity=slope * np.minimum(1.0, limit / np.maximum(steepness, limit)),
        normal=normal,
        held=steepness > limit,
    )
