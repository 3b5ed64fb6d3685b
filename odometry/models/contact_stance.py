"""A robot on its contacts: parameters and inputs of the force balance.

Samples (N) come last, contacts (C) before them.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.models.contact_loads import Layout, even_layout
from odometry.models.inputs import Inputs

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

    def rows(self, chosen: BoolArray) -> "Stance":
        """Some of the samples."""
        fields = {name: field for name, field in vars(self).items() if name != "layout"}
        return Stance(
            self.layout.rows(chosen), **{name: field[..., chosen] for name, field in fields.items()}
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
