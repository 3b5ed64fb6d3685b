"""What is as near as a name: by its equations, by evidence, or as the main part of it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.catalogue import EFFECTS
from odometry.effects.commands.late_treads import CommandDelay
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.map_fault import DriftingMap
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.terrain import NewIcrs
from odometry.effects.unknown.residual import Residual
from odometry.gap.answer import answer
from odometry.gap.answer.equivalent import equivalents
from odometry.gap.answer.result import Equivalent
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged
from odometry.gap.name import near_rivals
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.simulate import residuals
from odometry.models.inputs import Inputs

SHIFT = np.array([0.05, 0.05, -0.3, 0.0, 0.0])
PIECES = 30


class Alone:
    """A fitter whose windows are pieces of their own, all as noise makes them."""

    measured = SimpleNamespace(scenes=())

    def by_piece(self, of_windows):
        return of_windows

    def spread(self, fit):  # noqa: ARG002 - of the face
        return 1.0


def judged(effect, evidence, gain):
    """A candidate that gains as much in each piece, and pays the difference for its freedom."""
    fitted = SimpleNamespace(
        effects=(Added(effect, np.zeros(len(effect.parameters))),),
        held_out=np.full(PIECES, -gain / PIECES),
        freedom=(gain - evidence) / np.log(PIECES),
        base_moved=0.0,
    )
    return Judged(effect, fitted, gain, evidence, evidence, 0.1)


@pytest.fixture
def beside(monkeypatch):
    """Equivalents of the first of candidates, on speeds without noise."""
    silent = np.zeros(PIECES)
    monkeypatch.setattr(near_rivals, "noise_of_windows", lambda fits, _: [silent for _ in fits])

    return lambda *candidates: equivalents(explained_by(*candidates), (), Alone(), GapConfig())


@pytest.fixture
def names_beside_noise(monkeypatch):
    """Names as near as the first of candidates, of which noise makes so much in each piece."""

    def names(noises, *candidates):
        made = dict(zip((id(one.fitted) for one in candidates), noises, strict=True))
        monkeypatch.setattr(
            near_rivals,
            "noise_of_windows",
            lambda fits, _: [np.full(PIECES, made[id(fit)]) for fit in fits],
        )
        found = equivalents(explained_by(*candidates), (), Alone(), GapConfig())
        return [one.name for one in found]

    return names


@pytest.fixture
def names_beside(beside):
    """Their names."""
    return lambda *candidates: [one.name for one in beside(*candidates)]


def explained_by(*candidates):
    """By the first of candidates."""
    best = candidates[0]
    return Explanation(None, (best,), candidates, {best.effect.name: candidates})


def test_one_of_near_evidence_is_equivalent(names_beside):
    first = judged(TimeOffset(), 100.0, 104.0)
    assert names_beside(first, judged(HeadingOffset(), 95.0, 103.0)) == ["heading_offset"]
    assert names_beside(first, judged(HeadingOffset(), 93.0, 103.0)) == []


@pytest.mark.parametrize(("gain", "expected"), [(51.0, []), (53.0, ["heading_offset"])])
def test_one_of_near_evidence_that_gains_less_than_half_is_none(names_beside, gain, expected):
    """What it loses it saves in freedom: small, and not the same."""
    assert names_beside(judged(TimeOffset(), 50.0, 104.0), judged(HeadingOffset(), 48.0, gain)) == (
        expected
    )


@pytest.mark.parametrize(
    ("noises", "lost", "expected"),
    [
        ((0.0, 1.0), 53.0, ["heading_offset"]),
        ((0.0, 1.0), 55.0, []),
        ((0.0, 0.0), 15.0, []),
        ((1.0, 0.0), 7.0, []),
    ],
)
def test_what_noise_of_the_treads_makes_of_a_rival_is_not_held_against_it(
    names_beside_noise, noises, lost, expected
):
    """A chi-squared of 30, and 18 by which it scatters (1.645 times twice its root), beside 6."""
    candidates = judged(TimeOffset(), 150.0, 154.0), judged(HeadingOffset(), 150 - lost, 154 - lost)
    assert names_beside_noise(noises, *candidates) == expected


@pytest.mark.parametrize(
    ("gain", "expected"), [(620.0, ["lever_arm", "lateral_skid"]), (590.0, [])]
)
def test_what_new_icrs_include_is_as_near_where_it_closes_nearly_as_much(
    names_beside, gain, expected
):
    """Of 740 the arm closes 84 or 79 %; what it leaves the other values may have fitted.

    An arm ahead is a skid.
    """
    assert names_beside(judged(NewIcrs(), 672.0, 740.0), judged(LeverArm(), 570.0, gain)) == (
        expected
    )


def test_what_includes_a_name_and_needs_more_freedom_is_no_equivalent(names_beside):
    """Others that lose as little, of a gap that large, are: no equation is exact."""
    arm = judged(LeverArm(), 6996.0, 7000.0)
    assert names_beside(arm, judged(NewIcrs(), 6983.0, 7000.0)) == ["lateral_skid"]
    assert "time_offset" in names_beside(arm, judged(TimeOffset(), 6983.0, 7000.0))


def test_new_icrs_include_an_arm_and_a_skid(known, make_scene):
    """Both ICRs aside and forward are, of a measured pose, a sensor at the opposite place."""
    scene = make_scene(5, duration_s=40.0)
    moved = residuals(known.base, [Added(NewIcrs(), SHIFT)], scene)
    arm = residuals(known.base, [Added(LeverArm(), -SHIFT[[2, 0]])], scene)
    assert np.abs(moved - residuals(known.base, (), scene)).max() > 0.05
    np.testing.assert_allclose(moved, arm, atol=1e-4)


def test_what_is_included_is_in_the_catalogue():
    names = {effect.name for effect in EFFECTS}
    assert all(set(effect.includes) <= names for effect in EFFECTS)


def test_what_does_the_same_as_an_equivalent_is_one_too(names_beside):
    """Late stamps are as near as late commands, and those do what slip by force does."""
    names = names_beside(judged(TimeOffset(), 100.0, 104.0), judged(CommandDelay(), 99.0, 103.0))
    assert names == ["command_delay", "tread_slip"]


def test_a_short_delay_is_slip_in_proportion_to_force():
    """v(t - delay) is v - delay dv/dt up to the square of the delay."""
    time_s = 0.01 * np.arange(2001)
    speeds = np.column_stack([np.sin(time_s), np.cos(0.7 * time_s)])
    rates = np.column_stack([np.cos(time_s), -0.7 * np.sin(0.7 * time_s)])
    inputs = Inputs(speeds, time_s=time_s)

    def error(delay_s):
        late = CommandDelay().tread_speeds(np.array([delay_s]), inputs)
        return np.abs(late - (speeds - delay_s * rates))[200:-200].max()

    assert error(0.2) < 0.03
    assert error(0.2) / error(0.1) == pytest.approx(4.0, rel=0.2)


def test_no_drive_distinguishes_what_has_the_equations_of_the_name(beside, monkeypatch):
    """An arm ahead equals a skid, as far as data show; a drive distinguishes the other rivals."""
    candidates = judged(LeverArm(), 90.0, 104.0), judged(LateralSkid(), 89.0, 101.0)
    candidates = (*candidates, judged(TimeOffset(), 88.0, 103.0))
    found = beside(*candidates)
    by_equation = {one.name: one.by_equation for one in found}
    assert by_equation == {"lateral_skid": True, "time_offset": False}
    assert asked_about(candidates, found, monkeypatch).keys() == {"lever_arm", "time_offset"}


def test_a_drive_distinguishes_the_first_of_two_names(monkeypatch):
    """The one that the answer is called by; the second has been fitted beside it."""
    first, second, rival = (
        judged(one, 90.0, 104.0) for one in (LeverArm(), HeadingOffset(), TimeOffset())
    )
    found = (Equivalent("time_offset", "lever_arm", "a drive"),)
    asked = asked_about((first, rival), found, monkeypatch, steps=(first, second))
    assert asked == {"lever_arm": first.fitted, "time_offset": rival.fitted}


def test_a_rival_of_a_later_effect_is_no_rival_of_the_first(monkeypatch):
    first, second, rival = (
        judged(one, 90.0, 104.0) for one in (LeverArm(), HeadingOffset(), TimeOffset())
    )
    found = (Equivalent("time_offset", "heading_offset", "a drive"),)
    assert asked_about((first, rival), found, monkeypatch, steps=(first, second)) == {}


def test_a_drive_is_for_the_form_of_most_evidence(beside, monkeypatch):
    """On one heading a form that came as near may have been no candidate."""
    first, far, near = (judged(HeadingOffset(), 90.0, 104.0), *ICRS)
    found = beside(first, near)
    assert asked_about((first, far, near), found, monkeypatch)["terrain"] is near.fitted


ICRS = judged(NewIcrs(), 20.0, 50.0), judged(NewIcrs(), 89.0, 103.0)


def asked_about(candidates, found, monkeypatch, steps=()):
    """The fits that drives are proposed for, by name; the first candidate alone was added."""
    asked = {}
    monkeypatch.setattr(answer, "next_drives", lambda rivals, *_: asked.update(rivals))
    fitter = SimpleNamespace(measured=SimpleNamespace(scenes=()), calibration=None)
    explained = explained_by(*candidates)
    explained = replace(explained, steps=steps or explained.steps)
    answer.drives_apart(explained, candidates, found, fitter, GapConfig())
    return asked


@pytest.mark.parametrize(
    ("closed", "reason", "expected"),
    [
        (1200.0, "a map that drifts, or wind", ["reference_fault"]),
        (1300.0, "a map that drifts, or wind", []),
        (1200.0, "", []),
    ],
)
def test_a_fault_that_a_robot_may_do_as_well_stands_beside_unknown(closed, reason, expected):
    """It closes 1000 of 1200 or 1300 that a smooth function closes, or was not refused."""
    map_fault = judged(DriftingMap(runs=1), 900.0, 1000.0)
    smooth = judged(Residual("heading", (("world_x", 0),)), closed, closed)
    smooth.fitted.cost = 5000.0 - closed
    refusals = (Refusal("reference_fault", "drifting_map", reason),) if reason else ()
    found = Explanation(SimpleNamespace(cost=5000.0), (smooth,), (map_fault,), refusals=refusals)
    answered = equivalents(found, (), Alone(), GapConfig())
    assert [one.name for one in answered] == expected
    assert [one.instead_of for one in answered] == ["unknown"] * len(expected)
