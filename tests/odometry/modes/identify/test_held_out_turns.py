"""Errors of gains on turns that are held out, of records that are made here."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from odometry.modes.identify.held_out_turns import TURNED_S, turn_errors
from odometry.modes.identify.identify_velocity import OMEGA, identify_velocity_modes
from odometry.modes.models.response import Record, Response, fitted_response, simulated
from tests.odometry.modes.mode_examples import run_of

STEP_S, SIZE, RATE_HZ = 0.02, 6000, 8.0
ANSWER = Response(RATE_HZ, RATE_HZ * np.array([0.0, -1.0, 1.0]))


def record_of(rng, gain=1.0, spread=0.0):
    """Two minutes of turns of 4 s to both sides, of another gain in each."""
    number = (STEP_S * np.arange(SIZE) / 4).astype(int)
    half = np.where(number % 2, 0.3, -0.3) * rng.uniform(0.7, 1.3, number[-1] + 1)[number]
    gains = gain * (1 + spread * rng.normal(size=number[-1] + 1)[number])
    speeds = np.column_stack([0.5 - half, 0.5 + half])
    treads = Record(STEP_S, np.column_stack([np.full(SIZE, 0.5), np.zeros(SIZE), speeds]))
    inputs, _ = simulated(treads, OMEGA, RATE_HZ)
    rates = gains * (inputs @ ANSWER.gains) + 1e-3 * rng.normal(size=SIZE)
    return Record(STEP_S, np.column_stack([np.full(SIZE, 0.5), rates, speeds]))


def deviations(records):
    """Of the gains over each time of turning, at 0.6 rad/s."""
    responses = {name: fitted_response(of, OMEGA) for name, of in records.items()}
    spread, power = turn_errors(records, OMEGA, responses)
    return np.sqrt(spread**2 + power / (np.array(TURNED_S) * 0.36))


@pytest.mark.parametrize("count", [1, 3])
def test_what_differs_from_turn_to_turn_is_measured(count):
    rng = np.random.default_rng(2)
    found = deviations({"ice": [record_of(rng, spread=0.05) for _ in range(count)]})
    np.testing.assert_allclose(found, 0.05, rtol=0.4)


def test_a_record_of_another_gain_is_off_by_it_where_it_is_held_out():
    rng = np.random.default_rng(3)
    alike, apart = (
        deviations({"ice": [record_of(rng), record_of(rng, gain)]}) for gain in (1.0, 1.1)
    )
    assert (alike < 0.01).all()
    np.testing.assert_allclose(apart, 0.088, atol=0.01)  # 0.1 held out, 0.05 where it is not


def test_a_record_beside_short_ones_alone_is_held_out_in_quarters():
    """Gains of 0.4 s predict nothing."""
    rng = np.random.default_rng(5)
    long, short = record_of(rng), record_of(rng)
    few = Record(STEP_S, short.table[1000:1020])
    assert (deviations({"ice": [long, few]}) < 0.02).all()


def test_a_record_that_does_not_turn_determines_nothing():
    rng = np.random.default_rng(4)
    straight = record_of(rng)
    straight.table[:, 1], straight.table[:, 3] = 0.0, straight.table[:, 2]
    assert turn_errors({"ice": [straight] * 2}, OMEGA, {"ice": ANSWER}) is None


def test_identified_modes_state_it_unless_they_share_a_model():
    runs = [
        run_of(turn, size=3000, labels=[name] * 3000, rng=np.random.default_rng(seed))
        for seed, (name, turn) in enumerate([("ice", 0.5), ("tar", 1.0)] * 2)
    ]
    runs = [replace(run, folder=Path(f"drive_{place}")) for place, run in enumerate(runs)]
    found = identify_velocity_modes(runs)
    assert found.turn_spread.shape == found.turn_power.shape == (2, len(TURNED_S))
    assert (found.turn_spread < 0.05).all()
    assert identify_velocity_modes(runs, shared=True).turn_spread is None
