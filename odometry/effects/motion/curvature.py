"""An effective width that depends on how tight the turn is."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base, slip_factors
from odometry.models.inputs import Inputs


class Curvature(MotionEffect):
    """The distance between the tread ICRs narrows or widens from tight to wide turns.

    With lambda = |(v_right + v_left) / (v_right - v_left)| the law of Baril 2020 eq. 11 has the
    width track_width (1 + beta_1 / (1 + beta_2 sqrt(lambda))). Taken relative to the base, it
    turns the base's ICRs wider by width_factor / that of eq. 11; `width_factor` is the width on
    straights, in widths of the base.
    """

    name = "curvature"
    form = "radius_of_curvature"
    in_words = "an effective width that depends on how tight the turn is"
    equation = "width -> width w (1 + beta_1 / (1 + beta_2 sqrt(lambda)))"
    source = "Baril 2020 eq. 10-11"
    looks_like = "tight turns too far, wide turns not far enough, or the reverse"
    remedy = "keep it in the model, or drive turns of one radius"
    essential = ("beta_1",)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        return (
            EffectParameter("width_factor", "", 0.2, 5.0, 1.0, 0.01, 1.0),
            EffectParameter("beta_1", "", -0.8, 20.0, 0.05, 0.02, 0.0),
            EffectParameter("beta_2", "", 0.0, 50.0, 1.0, 0.1, None),
        )

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """Wider and narrower in tight turns, early and late."""
        return np.array([[1.0, b_1, b_2] for b_1 in (0.1, -0.1) for b_2 in (0.3, 3.0)])

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`; v_y and omega share the width."""
        width_factor, beta_1, beta_2 = values
        p = np.sqrt(np.abs(inputs.right - inputs.left))
        q = np.sqrt(np.abs(inputs.right + inputs.left))
        below = width_factor * ((1 + beta_1) * p + beta_2 * q)
        factor = np.divide(
            p + beta_2 * q, below, out=np.full_like(p, 1 / width_factor), where=below > 1e-12
        )
        return np.asarray(twist + (factor - 1)[:, None] * turning_part(twist, inputs, base))


def turning_part(twist: FloatArray, inputs: Inputs, base: Base) -> FloatArray:
    """The part (N, 3) of a twist that turning makes: all but the mean tread speed forward.

    At a wider width about the same centre omega and v_y shrink, and with them what an
    eccentricity of the ICRs adds to v_x.
    """
    forward = (slip_factors(base) * inputs.tread_speeds_m_s).mean(axis=-1)
    return np.stack([twist[:, 0] - forward, twist[:, 1], twist[:, 2]], axis=-1)
