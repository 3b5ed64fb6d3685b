"""Answers are scored as the study's docstring says."""

import pytest

from tests.blind.faults.bases import Base
from tests.studies.recordings import check_scoring as scoring

RIGHT = ("yaw_unit", "warning", "yaw of +170", "Yaw is in degrees.")
WRONG = ("late", "warning", "0.2 s", "The poses are late.")
NOTE = ("unit_note", "note", "yaw of +170", "Yaw is in degrees.")


@pytest.fixture
def answer(bases, monkeypatch):
    """Answer to a yaw in degrees, of a check that finds these, and these on the clean one."""

    def judge(found, clean=(), key="pose_yaw_in_degrees"):
        def check(folder):
            if isinstance(found, Exception):
                raise found
            return list(clean if folder == bases[1].folder else found)

        scoring.findings_of_clean.cache_clear()
        monkeypatch.setattr(scoring, "check", check)
        return scoring.judge([bases[1]], (key, 0))

    return judge


def verdict(answer):
    return answer.noticed, answer.first, answer.anywhere


def test_the_cause_counts_where_it_stands(answer):
    assert verdict(answer([RIGHT, WRONG])) == (True, True, True)
    assert verdict(answer([WRONG, RIGHT])) == (True, False, True)
    assert verdict(answer([WRONG])) == (True, False, False)
    assert verdict(answer([])) == (False, False, False)


def test_a_note_is_not_enough_for_a_warning(answer):
    assert verdict(answer([NOTE])) == (False, False, True)
    assert verdict(answer([NOTE, RIGHT])) == (True, True, True)


def test_what_the_clean_recording_has_too_does_not_count(answer):
    assert verdict(answer([RIGHT], clean=[RIGHT])) == (False, False, False)
    stronger = (*RIGHT[:2], "yaw of +9000", RIGHT[3])
    assert verdict(answer([stronger], clean=[RIGHT])) == (True, True, True)
    other_figures = (*WRONG[:2], "0.3 s", WRONG[3])
    assert verdict(answer([other_figures], clean=[WRONG])) == (False, False, False)


def test_a_warning_of_something_harmless_is_reported(answer):
    bias = ("bias", "warning", "0.02 rad/s", "A bias of the gyroscope.")
    assert answer([bias], key="gyro_bias").too_severe
    assert not answer([("bias", "note", *bias[2:])], key="gyro_bias").too_severe


def test_an_exception_is_a_crash(answer):
    result = answer(MemoryError("193 GiB"))
    assert "193 GiB" in result.crash
    assert verdict(result) == (False, False, False)


def test_a_fault_without_a_place_is_reported(tmp_path):
    result = scoring.judge([Base("empty", tmp_path, frozenset())], ("pose_late", 0))
    assert result.crash == "not drawn"


def test_wilson_intervals():
    """Values of Newcombe 1998 (method 3): 81 of 263, and 0 of 20."""
    assert scoring.interval(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert scoring.interval(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)
