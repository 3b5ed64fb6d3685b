"""Measured runs that show the gap, and those that do not."""

from collections.abc import Sequence

from odometry.gap.answer.result import GapResult
from odometry.gap.config import GapConfig
from odometry.gap.prepare.statistic import Gap, gap_of
from odometry.gap.show.quantities import of_two_figures


def runs_differ(result: GapResult) -> str | None:
    """A sentence where some measured runs show a gap and others do not; else None.

    An effect that is fitted to all of them is too weak for the ones and too strong for the others.
    """
    floor = result.closings[0].noise_floor
    gaps = {
        scene.run.name: gap_of(
            result.calibration.base, (), [scene], GapConfig().part_s, floor.measure
        )
        for scene in result.measured_scenes
        if len(scene)
    }
    with_gap = {name: of for name, of in gaps.items() if of.is_above(floor)}
    without = {name: of for name, of in gaps.items() if of.low <= floor.high}
    if not with_gap or not without:
        return None
    if max(of.high for of in without.values()) >= min(of.low for of in with_gap.values()):
        return None
    return (
        f"The runs differ: {_listed(with_gap)}, but {_listed(without)}, with a noise floor of "
        f"{of_two_figures(floor)}. Run gap with {_names(list(with_gap))} alone."
    )


def _listed(gaps: dict[str, Gap]) -> str:
    return ", ".join(f"{name} {of_two_figures(of)}" for name, of in gaps.items())


def _names(names: Sequence[str]) -> str:
    return " and ".join(filter(None, [", ".join(names[:-1]), names[-1]]))
