"""How late a terrain came into force, against the truth of a simulated run."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.evaluation.stretches import Stretch, stretches
from terrain.result.run_result import RunResult, TerrainChange
from terrain.switch.switch import SwitchEvent

Change = SwitchEvent | TerrainChange


@dataclass(frozen=True)
class SwitchDelay:
    """A switch and the true change that it answers.

    Attributes
    ----------
    terrain : str
    in_force_s : float or None
        When the terrain came into force; None for a true change that no switch answers.
    true_s : float or None
        When the robot got onto the terrain; None for a switch that answers no true change, or
        where the truth is not known.
    late_s, late_m : float or None
        Time and wheel travel from the true change to the switch; negative where it came early.
    """

    terrain: str
    in_force_s: float | None
    true_s: float | None = None
    late_s: float | None = None
    late_m: float | None = None


def switch_delays(result: RunResult) -> list[SwitchDelay]:
    """Match the switches of a run with the true changes of terrain.

    A switch and a change to the same terrain belong together if each is the nearest to the other
    in time, so that no change is answered twice. If the initial terrain is wrong, the start of
    the run counts as a change.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of SwitchDelay
        One for each of `result.changes`, in that order; then the changes that were missed, in
        order of time. Empty without a source of terrain.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> terrain.switch_delays(result)  # there is no source of terrain
    []
    """
    if result.source == "none":
        return []
    events, changes = result.changes, true_changes(result)
    delays = [_delay(result, event, _answered(event, events, changes)) for event in events]
    answered = {(delay.terrain, delay.true_s) for delay in delays}
    missed = [
        SwitchDelay(change.terrain, None, change.start_s)
        for change in changes
        if (change.terrain, change.start_s) not in answered
    ]
    return delays + missed


def true_changes(result: RunResult) -> tuple[Stretch, ...]:
    """The stretches of true terrain that begin with a change; none where truth.csv names none."""
    found = true_stretches(result)
    return found[1:] if found and found[0].terrain == result.initial_terrain else found


def true_stretches(result: RunResult) -> tuple[Stretch, ...]:
    """The true terrain over the time of the replay; none where truth.csv names none.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> [stretch.terrain for stretch in terrain.true_stretches(result)]
    ['gravel', 'grass', 'gravel']
    """
    truth = result.run.truth
    if truth is None or "terrain" not in truth:
        return ()
    stamps_s = result.replay.stamps_s
    during = (truth.stamps_s >= stamps_s[0]) & (truth.stamps_s <= stamps_s[-1])
    return stretches(truth.stamps_s[during], [str(name) for name in truth["terrain"][during]])


def _answered(event: Change, events: Sequence[Change], changes: Sequence[Stretch]) -> float | None:
    """When the change was that a switch answers."""
    true_s = [change.start_s for change in changes if change.terrain == event.terrain]
    if not true_s:
        return None
    nearest_s = min(true_s, key=lambda stamp_s: abs(stamp_s - event.stamp_s))
    rivals_s = [other.stamp_s for other in events if other.terrain == event.terrain]
    return nearest_s if min(rivals_s, key=lambda s: abs(s - nearest_s)) == event.stamp_s else None


def _delay(result: RunResult, event: Change, true_s: float | None) -> SwitchDelay:
    if true_s is None:
        return SwitchDelay(event.terrain, event.stamp_s)
    travel_m = np.interp(
        [true_s, event.stamp_s], result.run.odometry.stamps_s, result.run.wheel_travel_m
    )
    return SwitchDelay(
        event.terrain,
        event.stamp_s,
        true_s,
        event.stamp_s - true_s,
        float(travel_m[1] - travel_m[0]),
    )
