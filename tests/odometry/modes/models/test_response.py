import numpy as np
import pytest
from scipy.signal import lfilter

from odometry.modes.identify.gain_spread import gain_spread
from odometry.modes.models.response import (
    BLOCK_S,
    Record,
    Response,
    block_powers,
    errors_of,
    fitted_response,
    without_biases,
)
from tests.odometry.modes.mode_drives import integrated, wandering

STEP_S = 0.02
OTHERS = {0: [1, 2, 3], 1: [0, 2, 3]}
KNOWN = {0: Response(4.0, np.array([0.3, 2.1, 1.9])), 1: Response(2.5, np.array([0.4, -3.0, 2.6]))}


def simulated(response, inputs, start):
    """dq/dt = -rate q + gains inputs (N, 3), each in force to the next sample."""
    values = [start]
    for held in inputs[:-1]:
        pushed = response.gains @ held
        rates = lambda q, pushed=pushed: pushed - response.rate_hz * q  # noqa: E731
        values.append(integrated(rates, values[-1], STEP_S, 3))
    return np.array(values)


def record(rng, row, sigma, *, size=3000, start=0.5):
    """One whose quantity `row` answers to the other, held as the treads are, and to treads."""
    inputs = np.column_stack(
        [wandering(rng, size, STEP_S, hold_s=0.4)[:, 0], wandering(rng, size, STEP_S)]
    )
    table = np.empty((size, 4))
    table[:, OTHERS[row]] = inputs
    table[:, row] = simulated(KNOWN[row], inputs, start) + sigma * rng.normal(size=size)
    return Record(STEP_S, table)


def uncertainty(records, row, sigma):
    """Standard deviations of rate and gains: Gauss-Newton, by differences of own simulations.

    Where each record started is not known either.
    """
    known, h = KNOWN[row], 1e-4
    values = np.append(known.rate_hz, known.gains)
    blocks = []
    for place, one in enumerate(records):
        inputs = one.table[:, OTHERS[row]]

        def columns(moved, inputs=inputs):
            ahead, behind = (Response(v[0], v[1:]) for v in (values + moved, values - moved))
            return (simulated(ahead, inputs, 0.5) - simulated(behind, inputs, 0.5)) / (2 * h)

        starts = np.zeros((len(inputs), len(records)))
        starts[:, place] = np.exp(-known.rate_hz * STEP_S * np.arange(len(inputs)))
        blocks.append(np.column_stack([*map(columns, h * np.eye(4)), starts]))
    jacobian = np.concatenate(blocks)
    return sigma * np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))[:4]


@pytest.mark.parametrize("row", [0, 1])
def test_rate_and_gains_are_found_within_what_the_noise_leaves_open(row, rng):
    """Several records. Beside noise, the ridge leaves a hundredth: see below."""
    sigma = 0.05
    records = [record(rng, row, sigma, size=size) for size in (2000, 700, 1300)]
    found = fitted_response(records, row)
    sigmas = uncertainty(records, row, sigma)
    known = np.append(KNOWN[row].rate_hz, KNOWN[row].gains)
    apart = np.append(found.rate_hz, found.gains) - known
    assert np.all(np.abs(apart) < 4 * sigmas + 0.01 * np.abs(known))
    assert np.all(sigmas < 0.1 * np.abs(known))  # else the test would say little


def test_without_noise_only_the_ridge_is_left(rng):
    """A thousandth of the mean square of speeds from 0.2 to 1, 0.41, is 8 of their variance."""
    found = fitted_response([record(rng, 1, 0.0)], 1)
    np.testing.assert_allclose(found.gains, KNOWN[1].gains, rtol=0.01)
    np.testing.assert_allclose(found.gains[1:], KNOWN[1].gains[1:], rtol=1e-3)
    assert found.rate_hz == pytest.approx(KNOWN[1].rate_hz, rel=1e-3)


def test_records_count_by_their_length(rng):
    """A record that says half as much moves the gains the more, the longer it is."""
    honest, other = (record(rng, 1, 0.01) for _ in range(2))
    halved = other.table * [1.0, 0.5, 1.0, 1.0]
    for size, expected in ((300, 2.6 * (1 - 0.5 / 11)), (3000, 2.6 * 0.75)):
        found = fitted_response([honest, Record(STEP_S, halved[:size])], 1)
        assert found.gains[2] == pytest.approx(expected, rel=0.05)


def test_where_it_started_does_not_matter(rng):
    """A start at 5 instead of 0.5 leaves e^(-rate t) behind, which nothing else explains."""
    one = record(rng, 1, 0.0, size=500)
    other = one.table.copy()
    other[:, 1] += 4.5 * np.exp(-KNOWN[1].rate_hz * STEP_S * np.arange(500))
    found, expected = (fitted_response([Record(STEP_S, t)], 1) for t in (other, one.table))
    np.testing.assert_allclose(found.gains, expected.gains, rtol=2e-3)
    assert errors_of([Record(STEP_S, other)], 1, KNOWN[1]).variance < 1e-9


def test_its_row_in_a_and_b():
    response = Response(3.0, np.array([0.1, 0.2, 0.3]))
    np.testing.assert_array_equal(response.row_of(0), [-3.0, 0.1, 0.2, 0.3])
    np.testing.assert_array_equal(response.row_of(1), [0.1, -3.0, 0.2, 0.3])


def noisy(errors, row=1):
    """A record that KNOWN explains but for these errors."""
    inputs = np.tile([0.7, 0.4, 0.9], (len(errors), 1))
    table = np.empty((len(errors), 4))
    table[:, OTHERS[row]] = inputs
    table[:, row] = simulated(KNOWN[row], inputs, 0.5) + errors
    return Record(STEP_S, table)


def test_errors_that_are_white(rng):
    """Variance s^2; a mean over seconds T has s^2 step / T, so that the power is s^2 step."""
    sigma, size, count = 0.3, 20_000, 5
    records = [noisy(sigma * rng.normal(size=size)) for _ in range(count)]
    errors = errors_of(records, 1, KNOWN[1])
    blocks = size * count * STEP_S / BLOCK_S
    assert errors.variance == pytest.approx(sigma**2, rel=4 * np.sqrt(2 / (size * count)))
    assert errors.power == pytest.approx(sigma**2 * STEP_S, rel=4 * np.sqrt(2 / blocks))


def test_errors_that_last(rng):
    """Of correlation exp(-t / T) the power is 2 s^2 T, less what a block of finite length cuts."""
    sigma, lasts_s, size = 0.3, 0.1, 100_000
    decay = np.exp(-STEP_S / lasts_s)
    pushes = sigma * np.sqrt(1 - decay**2) * rng.normal(size=size)
    errors = errors_of([noisy(lfilter([1.0], [1.0, -decay], pushes))], 1, KNOWN[1])
    ratio = lasts_s / BLOCK_S
    expected = 2 * sigma**2 * lasts_s * (1 - ratio * (1 - np.exp(-1 / ratio)))
    blocks = size * STEP_S / BLOCK_S
    assert errors.power == pytest.approx(expected, rel=4 * np.sqrt(2 / blocks))
    of_samples = 4 * np.sqrt(2 * 2 * lasts_s / (size * STEP_S))  # independent every 2 T or so
    assert errors.variance == pytest.approx(sigma**2, rel=of_samples)


def test_blocks_by_hand():
    """Blocks of 4 samples of 0.5 s, means 1 and -2; the rest is no block."""
    errors = np.array([1.0, 1.0, 1.0, 1.0, 0.0, -4.0, -4.0, 0.0, 9.0])
    np.testing.assert_allclose(block_powers(errors, 0.5), [2.0 * 1.0, 2.0 * 4.0])


def test_errors_too_short_for_a_block_have_no_power(rng):
    errors = errors_of([noisy(0.1 * rng.normal(size=30))], 1, KNOWN[1])
    assert errors.power == 0.0
    assert errors.variance > 0.0


def turning(rng, spread, sigma, *, turns=60, turn_s=4.0):
    """Turns to either side, each with a gain of its own; yaw rates that follow at once."""
    size = round(turn_s / STEP_S)
    rates = np.repeat(rng.uniform(0.3, 1.0, turns) * np.resize([1, -1], turns), size)
    gains = np.repeat(1 + spread * rng.normal(size=turns), size)
    measured = gains * rates + sigma * rng.normal(size=len(rates))
    return Record(STEP_S, np.column_stack([0.5 + 0 * rates, measured, -rates / 2, rates / 2]))


@pytest.mark.parametrize("spread", [0.0, 0.01, 0.05])
def test_the_spread_of_gains_from_turn_to_turn_comes_back(spread):
    """Within two standard deviations of a sample of sixty, noise of single samples left out."""
    rng, at_once = np.random.default_rng(3), Response(200.0, np.array([0.0, -200.0, 200.0]))
    found = gain_spread([turning(rng, spread, 0.02)], 1, at_once)
    assert found == pytest.approx(spread, abs=0.003 + 0.2 * spread)


def test_a_gain_that_depends_on_the_run_is_a_spread():
    rng, at_once = np.random.default_rng(4), Response(200.0, np.array([0.0, -200.0, 200.0]))
    runs = [turning(rng, 0.0, 0.02, turns=20) for _ in range(2)]
    faster = Record(STEP_S, runs[1].table * [1.0, 1.06, 1.0, 1.0])
    assert gain_spread(runs, 1, at_once) < 0.005
    assert gain_spread([runs[0], faster], 1, at_once) == pytest.approx(0.03, rel=0.2)


def test_few_turns_say_nothing_of_a_spread():
    rng, at_once = np.random.default_rng(5), Response(200.0, np.array([0.0, -200.0, 200.0]))
    assert gain_spread([turning(rng, 0.1, 0.02, turns=4)], 1, at_once) == 0.0


SLOW_BIASES_RAD_S = (0.006, -0.005)


def biased(rng, *, sigma=0.001):
    """Two records of a robot at a few centimetres a second, each with a bias of its own."""
    response = Response(2.5, np.array([0.0, -3.0, 3.0]))
    records = []
    for bias in SLOW_BIASES_RAD_S:
        inputs = np.column_stack([np.zeros(3000), 0.02 + 0.004 * wandering(rng, 3000, STEP_S)])
        table = np.zeros((3000, 4))
        table[:, OTHERS[1]] = inputs
        table[:, 1] = simulated(response, inputs, 0.0) + bias + sigma * rng.normal(size=3000)
        records.append(Record(STEP_S, table))
    return response, records


def by_columns(records, response, sigma):
    """Gains by the normal equations with a column for each bias, of which each has a prior."""
    blocks, wanted = [], []
    for place, one in enumerate(records):
        answers = [
            simulated(Response(response.rate_hz, unit), one.table[:, OTHERS[1]], 0.0)
            for unit in np.eye(3)
        ]
        columns = np.column_stack([*answers, np.zeros((len(one.table), len(records)))])
        columns[:, 3 + place] = 1.0
        start = np.exp(-response.rate_hz * STEP_S * np.arange(len(one.table)))
        start /= np.linalg.norm(start)
        blocks.append(columns - np.outer(start, start @ columns))
        wanted.append(one.table[:, 1] - start * (start @ one.table[:, 1]))
    table = np.concatenate(blocks)
    power = errors_of(records, 1, response).power
    least = power / STEP_S / sigma**2 * np.diag([0, 0, 0, *np.ones(len(records))])
    least[0, 0] = 1.0  # the speed is zero here: its gain is open
    return np.linalg.solve(table.T @ table + least, table.T @ np.concatenate(wanted))[:3]


def test_a_bias_of_each_record_is_no_answer_to_the_treads(rng):
    true, records = biased(rng)
    alone = fitted_response(records[:1], 1)
    settled = without_biases(records[:1], 1, alone, 0.005)
    straight = np.array([0.0, 0.02, 0.02])  # which turns nothing
    turned = [abs(response.gains @ straight) / 2.5 for response in (alone, settled)]
    assert turned[0] > 0.003
    assert turned[1] < turned[0] / 3
    assert np.abs(settled.gains - true.gains)[1:].max() < 0.3


def test_biases_are_those_of_least_squares_with_a_column_for_each(rng):
    _, records = biased(rng)
    response = fitted_response(records, 1)
    settled = without_biases(records, 1, response, 0.005)
    np.testing.assert_allclose(settled.gains, by_columns(records, response, 0.005), rtol=1e-3)
    assert settled.rate_hz == response.rate_hz
