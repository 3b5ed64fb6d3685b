"""Twists of a base under effects, kept from effect to effect."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import CommandEffect, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import (
    Added,
    corrected_twist,
    moved_twist,
    with_true_speeds,
)
from odometry.effects.motion.contact_change import ContactChange
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.effects.unknown.residual import Residual
from odometry.models.icr import Icr, IcrByTerrain
from odometry.models.inputs import Inputs


class Chain:
    """`corrected_twist` at values, and at others from the first effect that changes on.

    Attributes
    ----------
    base : Base
    effects : tuple of Added
    recorded, inputs : Inputs
        Of stack (N,), as recorded, and with true tread speeds.
    """

    def __init__(self, base: Base, effects: Sequence[Added], recorded: Inputs) -> None:
        self.base = base
        self.effects = tuple(effects)
        self.recorded = recorded
        self.inputs = with_true_speeds(effects, recorded)
        self._twists = [base.model.twist(base.values, self.inputs)]
        self._columns: dict[int, FloatArray] = {}
        self._inertia: dict[int, tuple[FloatArray, FloatArray]] = {}
        for added in effects:
            self._twists.append(self._with(added, self._twists[-1], base))

    @property
    def twist(self) -> FloatArray:
        """Under all effects (N, 3)."""
        return self._twists[-1]

    def is_moved_by(self, base: Base, effects: Sequence[Added]) -> bool:
        """Whether the twist may be another at other values, which are those of no sensor alone."""
        same_base = np.array_equal(base.values, self.base.values)
        return not same_base or self._first_changed(effects) < len(self.effects)

    def at_all(self, others: Sequence[tuple[Base, Sequence[Added]]]) -> FloatArray:
        """The twists (C, N, 3) at other values of the base and the same effects."""
        made = np.moveaxis(np.empty((3, len(others), len(self.twist))), 0, -1)
        bases = [
            place
            for place, (_, effects) in enumerate(others)
            if self._first_changed(effects) == len(self.effects)
        ]
        if bases:
            twists = self._of_bases([others[place][0] for place in bases])
            for place, twist in zip(bases, twists, strict=True):
                made[place] = self._from_base(others[place][0], twist)
        for place, (base, effects) in enumerate(others):
            if place not in bases:
                made[place] = self._at(base, effects)
        return made

    def _at(self, base: Base, effects: Sequence[Added]) -> FloatArray:
        first = self._first_changed(effects)
        on_commands = isinstance(effects[first].effect, CommandEffect)
        if on_commands or not np.array_equal(base.values, self.base.values):
            return corrected_twist(base, effects, self.recorded)
        twist = self._twists[first]
        for place, added in enumerate(effects[first:], first):
            columns = self._columns_of(added, place, first)
            if columns is None and place > first and self._adds_the_same(added, place):
                twist = twist + self._added(place)
            elif columns is None:
                twist = self._with(added, twist, self.base)
            else:
                moved = np.tensordot(added.values - self.effects[place].values, columns, axes=1)
                twist = twist + self._added(place) + moved
        return twist

    def _first_changed(self, effects: Sequence[Added]) -> int:
        """Place of the first effect whose values are others; one on commands before all."""
        changed = [
            place
            for place, (one, own) in enumerate(zip(effects, self.effects, strict=True))
            if isinstance(one.effect, CommandEffect | MotionEffect)
            and not np.array_equal(one.values, own.values)
        ]
        on_commands = [p for p in changed if isinstance(effects[p].effect, CommandEffect)]
        return min(on_commands or changed, default=len(self.effects))

    def _of_bases(self, bases: Sequence[Base]) -> Sequence[FloatArray]:
        """Twists (N, 3) of each base, and the same true speeds."""
        if isinstance(self.base.model, IcrByTerrain):
            return [base.model.twist(base.values, self.inputs) for base in bases]
        values = np.stack([base.values for base in bases])
        return list(self.base.model.twist(values[:, None], self.inputs))

    def _from_base(self, base: Base, twist: FloatArray) -> FloatArray:
        """The twist (N, 3) under all effects of that of another base (N, 3)."""
        for place, added in enumerate(self.effects):
            columns = self._columns_of_base(place)
            if columns is not None:
                moved = np.tensordot(base.values - self.base.values, columns, axes=1)
                twist = twist + self._added(place) + moved
            elif isinstance(added.effect, MotionEffect) and not added.effect.answers_to:
                twist = twist + self._added(place)
            else:
                twist = self._with(added, twist, base)
        return twist

    def _adds_the_same(self, added: Added, place: int) -> bool:
        """Whether an effect adds what it did, at the same base, to another twist."""
        effect = added.effect
        same = np.array_equal(added.values, self.effects[place].values)
        return same and isinstance(effect, MotionEffect) and effect.answers_to != "twist"

    def _added(self, place: int) -> FloatArray:
        """What an effect adds to the twist (N, 3)."""
        return self._twists[place + 1] - self._twists[place]

    def _with(self, added: Added, twist: FloatArray, base: Base) -> FloatArray:
        if not isinstance(added.effect, MotionEffect):
            return twist
        return moved_twist(added.effect, added.values, twist, self.inputs, base)

    def _columns_of(self, added: Added, place: int, first: int) -> FloatArray | None:
        """Derivative (P, N, 3) of what an effect adds, where it is known.

        That is smooth functions on the first twist that changes, inertia, and contact forces.
        """
        effect = added.effect
        if isinstance(self.base.model, IcrByTerrain) or np.array_equal(
            added.values, self.effects[place].values
        ):
            return None
        if isinstance(effect, InertiaByIndices):
            return self._of_inertia(place)[0]
        if place not in self._columns and isinstance(effect, ContactChange):
            values = self.effects[place].values
            self._columns[place] = effect.added_by_values(values, self.inputs, self.base)
        elif place not in self._columns and isinstance(effect, Residual) and place == first:
            self._columns[place] = effect.columns(self._twists[place], self.inputs, self.base)
        return self._columns.get(place)

    def _columns_of_base(self, place: int) -> FloatArray | None:
        """Derivative (5, N, 3) of what an effect adds by the values of the base, where known."""
        of_icrs = type(self.base.model) is Icr
        is_known = isinstance(self.effects[place].effect, InertiaByIndices) and of_icrs
        return self._of_inertia(place)[1] if is_known else None

    def _of_inertia(self, place: int) -> tuple[FloatArray, FloatArray]:
        effect, values = self.effects[place].effect, self.effects[place].values
        if place not in self._inertia and isinstance(effect, InertiaByIndices):
            self._inertia[place] = effect.added_by_values(values, self.inputs, self.base)
        return self._inertia[place]
