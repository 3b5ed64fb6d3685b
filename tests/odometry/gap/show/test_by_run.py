"""Measured runs that show the gap beside runs that do not."""

from types import SimpleNamespace

import pytest

from odometry.gap.prepare.statistic import Gap
from odometry.gap.show import by_run

FLOOR = Gap(0.03, 0.027, 0.033)
LARGE, SMALL, BETWEEN = Gap(0.08, 0.07, 0.09), Gap(0.031, 0.028, 0.034), Gap(0.06, 0.031, 0.075)


@pytest.fixture
def said(monkeypatch):
    """The sentence of runs with these gaps, by name."""

    def of(**gaps):
        def gap_of(_base, _effects, scenes, _part_s, _measure):
            return gaps[scenes[0].run.name]

        monkeypatch.setattr(by_run, "gap_of", gap_of)
        return by_run.runs_differ(
            SimpleNamespace(
                closings=(SimpleNamespace(noise_floor=FLOOR), None),
                calibration=SimpleNamespace(base=None),
                measured_scenes=[Scene(name) for name in gaps],
            )
        )

    return of


class Scene:
    """One window of a run."""

    def __init__(self, name):
        self.run = SimpleNamespace(name=name)

    def __len__(self):
        return 1


def test_runs_with_a_gap_and_runs_without_are_named(said):
    assert said(tuesday=LARGE, monday=SMALL, friday=LARGE) == (
        "The runs differ: tuesday 0.08 m, friday 0.08 m, but monday 0.031 m, with a noise floor "
        "of 0.03 m. Run gap with tuesday and friday alone."
    )


@pytest.mark.parametrize(
    "gaps",
    [
        {"one": LARGE},
        {"one": LARGE, "two": LARGE},
        {"one": SMALL, "two": SMALL},
        {"one": LARGE, "two": BETWEEN},  # whose interval meets that of the other
    ],
)
def test_runs_that_may_be_alike_are_not_set_apart(said, gaps):
    assert said(**gaps) is None
