"""What the faults of changing treads do, by plain figures."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.blind.changing_treads import FAULTS, LOOK_ALIKES
from tests.blind.faults.recordings import Recording
from tests.blind.part_faults import inside

AT_S = np.arange(0, 100, 0.1)
SPAN_S = (30.0, 60.0)


def recording():
    odometry = {
        "t": AT_S,
        "v_left": 1 + 0.5 * np.sin(AT_S),
        "v_right": 1 - 0.5 * np.sin(AT_S),
    }
    return Recording(SimpleNamespace(), "", {"odometry": odometry})


def changed(faults, key, seed=0):
    new = faults[key].change(recording(), np.random.default_rng(seed), SPAN_S)["odometry"]
    old = recording()["odometry"]
    return {name: (old[name], new[name]) for name in ("v_left", "v_right")}


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("key", ["side_wears_much", "side_wears_little"])
def test_one_scale_goes_from_one_to_another_and_never_back(key, seed):
    ratios = [new / old for old, new in changed(FAULTS, key, seed).values()]
    (wears,) = [of for of in ratios if not np.allclose(of, 1)]
    assert wears[0] == pytest.approx(1)
    steps = np.diff(wears)
    assert (steps > -1e-9).all() or (steps < 1e-9).all()
    size = abs(np.log(wears[-1]))
    assert 0.12 < size < 0.36 if key == "side_wears_little" else 0.43 < size < 1.05


@pytest.mark.parametrize("seed", range(6))
def test_smoothing_keeps_the_mean_and_takes_what_is_fast(seed):
    for old, new in changed(FAULTS, "smoothed_long", seed).values():
        inside = slice(60, -60)
        assert new[inside].mean() == pytest.approx(old[inside].mean(), abs=0.03)
        assert new[inside].std() < 0.9 * old[inside].std()


def test_both_columns_hold_one_tread_in_the_span_alone():
    (old_left, left), (old_right, right) = changed(FAULTS, "one_tread_twice").values()
    part = inside(recording(), "odometry", SPAN_S)
    assert (left == right)[part].all()
    assert (left == old_left)[~part].all()
    assert (right == old_right)[~part].all()


@pytest.mark.parametrize("seed", range(4))
def test_a_wider_robot_keeps_the_mean(seed):
    (old_left, left), (old_right, right) = changed(LOOK_ALIKES, "wider", seed).values()
    assert left + right == pytest.approx(old_left + old_right)
    assert not np.allclose(left, old_left)
