"""Names that stand on held-out data where a smooth function costs less on the measured runs."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.late_treads import CommandDelay
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.history import BOTH, LAGS_S, History
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name import form
from odometry.gap.name.form import is_part_of
from odometry.gap.name.held_out_beside import closes_less, surely_closes_more
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import Gap

CONFIG = GapConfig()


@pytest.fixture
def in_place(monkeypatch):
    """Whether a name of one cost stands, where a smooth function costs 60, and none 200."""

    def of(cost, spread, **said):
        function = "of anything"
        scale = SimpleNamespace(absent=0.0)
        effect = SimpleNamespace(slow=False, name="anything", parameters=(scale,))

        def fit(effects, *_, **__):
            kept = tuple(SimpleNamespace(effect=one) for one in effects)
            return SimpleNamespace(cost=60.0 if function in effects else 200.0, effects=kept)

        fitter = SimpleNamespace(
            fit=fit, linear_losses=lambda *_: np.array([60.0]), spread=lambda _: spread
        )
        fitter.measured = None
        monkeypatch.setattr(form, "cost_of", lambda fit: fit.cost)
        monkeypatch.setattr(form, "surely_dearer", lambda *_: np.inf)
        for name, answer in said.items():
            monkeypatch.setattr(form, name, lambda *_, answer=answer: answer)
        search = SimpleNamespace(fitter=fitter, config=CONFIG, held_out=())
        names = SimpleNamespace(effects=[SimpleNamespace(effect=effect)], cost=cost)
        return form.smooth_in_place(search, names, 0, [function]) is None

    return of


@pytest.mark.parametrize(
    ("spread", "surely_more", "stands"), [(1.2, False, True), (1.2, True, False), (1.4, False, 0)]
)
def test_a_name_that_leaves_noise_gives_way_to_what_surely_closes_more(
    spread, surely_more, stands, in_place
):
    """No equation is exact of a body: the runs that a function was fitted to follow it better."""
    assert in_place(100.0, spread, surely_closes_more=surely_more) == bool(stands)


@pytest.mark.parametrize(("cost", "stands"), [(72.0, True), (100.0, False)])
def test_the_main_part_gives_way_to_what_closes_more_elsewhere(cost, stands, in_place):
    """It closes 91 % of what the function does, or 71 %, and leaves more than noise."""
    assert in_place(cost, 1.5, closes_less=True) == stands
    assert not in_place(cost, 1.5, closes_less=False)


@pytest.mark.parametrize(("factor", "more"), [(0.8, True), (1.0, False), (1.2, False)])
def test_what_closes_more_does_so_on_held_out_data(make_scene, known, factor, more):
    """Wheels slip by a fifth: the right scale, none, and one of the other sign, beside none."""
    held, floor = [make_scene(4, lambda _, t: 0.8 * t)], Gap(0.01, 0.009, 0.011)
    fitter = Fitter(known, measured_of([make_scene(9)], known, CONFIG))
    search = SimpleNamespace(
        fitter=fitter, held_out=held, floor=floor, held_floor=floor, config=CONFIG
    )
    added = (Added(WheelScale(), np.array([factor, factor])),)
    one, other = (SimpleNamespace(base=known.base, effects=of) for of in (added, ()))
    assert surely_closes_more(search, one, other) == more
    assert closes_less(search, other, one) == more


def late(_, twist):
    """By 0.3 s."""
    return np.concatenate([np.repeat(twist[:1], 6, axis=0), twist[:-6]])


@pytest.mark.parametrize(("by", "is_part"), [(History, True), (Residual, False)])
def test_a_delay_is_part_of_a_filter_of_earlier_speeds(make_scene, known, by, is_part):
    fitter = Fitter(known, measured_of([make_scene(9, late)], known, CONFIG))
    knots = (0.0, 0.5, 1.0)
    functions = {
        History: History(terms=tuple((BOTH, number) for number in range(len(LAGS_S)))),
        Residual: Residual("speed", tuple(("v_x", number) for number in range(3)), "", knots),
    }
    function = fitter.fit([functions[by]])
    assert is_part_of(fitter, fitter.fit([CommandDelay()]), 0, function) == is_part
