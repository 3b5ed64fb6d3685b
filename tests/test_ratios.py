"""The table of ratios of the benchmarks, from times made up here."""

from tests.benchmarks.ratios import RATIOS, ratio_table


def test_a_row_has_the_ratio_of_two_times_and_its_aim():
    times = {"test_run[default]": 1.2, "test_decoding": 0.1, "test_run[fast]": 0.4}
    assert ratio_table(times, {}) == [
        ("run with vision", "12", "times test_decoding", "at most 15"),
        ("the same, fast", "4", "times test_decoding", "at most 5"),
    ]


def test_what_was_not_measured_has_no_row():
    assert ratio_table({"test_run[default]": 1.0}, {}) == []
    assert ratio_table({}, {"test_identification_against_a_loop": 7.25}) == [
        ("identification, 1 h at 20 Hz", "7.25", "times faster than a plain loop", "at least 50")
    ]


def test_every_row_has_a_name_of_its_own():
    assert len({ratio.work for ratio in RATIOS}) == len(RATIOS)
