"""Answers are scored by families of names, and counted with intervals."""

import pytest
from scipy.stats import binomtest

from tests.blind.cases import NAMES
from tests.blind.hidden.catalogue import GROUPS, HIDDEN
from tests.studies.gap.gap_names import COURSES, MEANING, all_named, course_of, score
from tests.studies.gap.gap_table import mistakes_of, table_of, with_interval


@pytest.mark.parametrize(
    ("verdict", "course", "kind", "expected"),
    [
        ("wheel_scale", "", "deflation", "right"),
        ("traction_loss", "gradual", "deflation", "acceptable"),
        ("traction_loss", "", "deflation", "wrong"),
        ("unknown", "", "deflation", "unknown"),
        ("unknown", "", "shared_pump", "right"),
        ("none", "", "shared_pump", "none"),
        ("none", "", "nothing", "right"),
        ("curvature", "", "nothing", "wrong"),
        ("time_offset", "", "late_commands", "wrong"),
    ],
)
def test_the_score_of_an_answer(verdict, course, kind, expected):
    assert score(verdict, course, HIDDEN[kind].true, HIDDEN[kind].acceptable) == expected


def test_a_name_that_may_as_well_be_the_true_one_is_honest():
    parts = (("late commands",),)
    assert score("time_offset", "", parts, (), ["command_delay"]) == "acceptable"
    assert score("time_offset", "", parts, (), ["inertia"]) == "wrong"


def test_every_family_has_a_meaning_and_every_kind_is_listed_once():
    for kind in HIDDEN.values():
        families = [*(one for part in kind.true for one in part), *kind.acceptable]
        for family in (*families, *kind.without_gyroscope):
            plain, _, last = family.rpartition(" ")
            assert (plain if last in COURSES else family) in MEANING
        assert kind.course in ("", *COURSES)
    assert len(HIDDEN) == sum(map(len, GROUPS.values()))
    assert len(NAMES) == len(set(NAMES))


@pytest.mark.parametrize(
    ("form", "course"),
    [("drift", "gradual"), ("scale_drift", ""), ("factors gradual", "gradual"), ("k_m", "")],
)
def test_the_course_of_a_form(form, course):
    assert course_of(form) == course


def test_both_of_a_mixed_kind_are_to_be_named():
    parts = HIDDEN["late_commands+slip_by_speed"].true
    assert all_named([("tread_slip", ""), ("command_delay", "")], parts)
    assert not all_named([("tread_slip", "")], parts)


@pytest.mark.parametrize(("count", "of"), [(10, 10), (0, 7), (5, 20)])
def test_intervals_are_those_of_wilson(count, of):
    low, high = binomtest(count, of).proportion_ci(method="wilson")
    assert (
        with_interval(count, of) == f"{100 * count / of:.0f} ({100 * low:.0f} to {100 * high:.0f})"
    )
    assert with_interval(0, 0) == "-"


def test_the_table_counts_each_kind_and_group():
    row = {
        "group": "seen",
        "kind": "deadband",
        "score": "right",
        "effects": "drive_limit",
        "course": "",
    }
    row |= {
        "course_right": "1",
        "worse": "0",
        "all_named": "1",
        "closed": "0.9",
        "verdict": "drive_limit",
    }
    row |= {"cpu_s": "3.0"}
    failed = {**row, "score": "failed", "closed": "", "all_named": ""}
    worse = {**row, "kind": "outliers", "score": "wrong", "worse": "1"}
    lines = [
        [cell.strip() for cell in line.split("|")[1:-1]] for line in table_of([row, failed, worse])
    ]
    assert lines[2][:4] == ["deadband", "2", "50", "0"]
    assert lines[4][:3] == ["**seen**", "3", "33 (6 to 79)"]
    by_head = dict(zip(lines[0], lines[4], strict=True))
    assert by_head["worse"] == "50 (9 to 91)"
    assert by_head["failed"] == "33 (6 to 79)"
    assert by_head["closed"] == "0.90"
    told = {"seed": "0", "true": "reference", "before": "1", "after": "2", "error": ""}
    assert mistakes_of([{**one, **told} for one in (row, worse)]) == [
        "outliers 0: wrong, drive_limit (drive_limit) for reference, gap 1 to 2"
    ]
