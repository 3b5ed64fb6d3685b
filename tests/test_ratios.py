"""The table of ratios of the benchmarks, and its comparison with a release, from times made up."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.benchmarks.ratios import RATIOS, Row, ratio_table
from tests.benchmarks.release import LAST_RELEASE, compared, read_table, write_table


def test_a_row_has_the_ratio_of_two_times_and_its_aim():
    times = {"test_run[default]": 1.2, "test_decoding": 0.1, "test_run[fast]": 0.4}
    assert [(row.work, round(row.figure, 9), row.aim) for row in ratio_table(times, {})] == [
        ("run with vision", 12.0, "at most 15"),
        ("the same, fast", 4.0, "at most 5"),
    ]


def test_what_was_not_measured_has_no_row():
    assert ratio_table({"test_run[default]": 1.0}, {}) == []
    assert ratio_table({}, {"test_identification_against_a_loop": 7.25}) == [
        Row("identification, 1 h at 20 Hz", 7.25, "times faster than a plain loop", "at least 50")
    ]


@pytest.mark.slow
def test_every_row_is_of_benchmarks_that_there_are():
    folder = Path(__file__).parent / "benchmarks"
    command = [sys.executable, "-m", "pytest", "-n", "0", "--collect-only", "-q", str(folder)]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    names = {line.rpartition("::")[2] for line in listed.splitlines()}
    assert {ratio.of for ratio in RATIOS} <= names
    assert {ratio.to for ratio in RATIOS if not ratio.is_figure} <= names


def test_every_row_has_a_name_of_its_own():
    assert len({ratio.work for ratio in RATIOS}) == len(RATIOS)


@pytest.mark.parametrize(
    ("work", "old", "new", "mark"),
    [
        ("run with vision", 10.0, 12.0, "SLOWER"),
        ("run with vision", 10.0, 11.0, ""),
        ("run with vision", 12.0, 10.0, "faster"),
        ("IMM of 3 modes", 2.0, 1.6, "SLOWER"),
        ("IMM of 3 modes", 1.6, 2.0, "faster"),
    ],
)
def test_what_got_slower_is_marked(work, old, new, mark):
    (row,) = compared({work: old, "gone": 1.0}, {work: new, "new": 1.0})
    assert row.mark == mark


def test_a_table_comes_back(tmp_path):
    write_table(tmp_path / "a.csv", [Row("run, with vision", 12.3456, "times b", "at most 15")])
    assert read_table(tmp_path / "a.csv") == {"run, with vision": 12.35}


def test_the_table_of_the_last_release_has_rows_that_are_measured():
    works = {ratio.work for ratio in RATIOS}
    assert set(read_table(LAST_RELEASE)) <= works
