"""Sentences of a result in which something with a name is missing, and words of its numbers."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.gap.answer.next_drives import NextDrive
from odometry.gap.answer.result import Equivalent, NamedEffect
from odometry.gap.locate.regions import Region
from odometry.gap.prepare.statistic import Gap
from odometry.gap.show.quantities import (
    Share,
    evidence_words,
    held_out_share,
    percent,
    with_interval,
)
from odometry.gap.show.words import sentences


def text(result):
    return " ".join(sentences(result))


def test_a_named_effect_with_its_numbers(scaled_result):
    said = sentences(scaled_result)
    assert said[0] == (
        "Missing in icr: wheels of another size, or constant slip (wheel_scale) and a reference "
        "that sits elsewhere than stated (lever_arm); these runs do not distinguish "
        "wheel_scale from traction_loss."
    )
    share, closing = held_out_share(scaled_result), scaled_result.holdout
    for part in (
        f"falls from {with_interval(closing.before)} to {with_interval(closing.after)}",
        f"the noise floor is {with_interval(closing.noise_floor)}",
        f"{percent(share)} of the excess is closed",
    ):
        assert part in said[1]
    assert said[2].startswith("Measure the wheels")
    assert "What distinguishes wheel_scale from traction_loss: a free wheel." in said[2]
    whole = text(scaled_result)
    assert with_interval(scaled_result.measured.before) in whole
    assert "c_l = 0.800 (0.790 to 0.820), c_r = 0.800 (0.790 to 0.820)" in whole
    assert "x_arm = 0.001 m (-0.009 to 0.021)" in whole
    assert "(evidence 812, very strong)" in whole
    assert "acts on the commands" in whole
    assert "acts on the measurement" in whole
    predicted = [one.name for one in scaled_result.location.predictors if one.discovered]
    assert "speed" in predicted
    assert "speed" in next(s for s in said if s.startswith("What predicts the disagreement"))
    assert scaled_result.location.regions[0].words in whole


def test_a_gap_that_no_variable_locates_has_one_size(scaled_result):
    """A region's size is of the windows that did not choose it: beside the gap it contradicts."""
    everywhere = replace(scaled_result.location, regions=(Region("everywhere", {}, 0.66, 1.0),))
    said = sentences(replace(scaled_result, location=everywhere))
    assert "None of them says where it is larger." in said
    assert not [text for text in said if "0.66" in text]


def test_a_drive_that_decides_goes_before_another_measurement(scaled_result):
    drive = NextDrive("spins to both sides", ("wheel_scale", "traction_loss"), 0.934)
    todo = sentences(replace(scaled_result, next_drives=(drive,)))[2]
    assert (
        "To distinguish wheel_scale from traction_loss: spins to both sides, for a minute "
        "(decides in 93 % of cases)." in todo
    )
    assert "a free wheel" not in todo


def test_a_drive_for_all_rivals_is_said_once(scaled_result):
    drives = [
        NextDrive("spins", ("wheel_scale", name), odds)
        for name, odds in (("traction_loss", 0.934), ("tread_slip", 0.7))
    ]
    todo = sentences(replace(scaled_result, next_drives=tuple(drives)))[2]
    assert (
        "To distinguish wheel_scale from traction_loss or tread_slip: spins, for a minute "
        "(decides in 70 % of cases). If it is wheel_scale: measure" in todo
    )


def test_a_fault_of_the_reference_is_none_of_the_robot(scaled_result):
    one = np.array([0.1])
    late = NamedEffect(Added(TimeOffset(), one), one, one, 0.2, 0.1, 50.0)
    said = sentences(replace(scaled_result, effects=(late,), equivalent=()))
    assert said[0] == (
        "A sensor is at fault, not the robot: pose stamps that are late or early (time_offset)."
    )


def test_a_fault_that_may_be_of_the_robot_is_not_said_to_be_of_a_sensor(scaled_result):
    two = np.array([0.1, 0.0])
    arm = NamedEffect(Added(LeverArm(), two), two, two, 0.2, 0.1, 50.0)
    skid = Equivalent("lateral_skid", "lever_arm", "a second antenna", by_equation=True)
    said = sentences(replace(scaled_result, effects=(arm,), equivalent=(skid,)))
    assert said[0].startswith("A sensor or the robot: a reference that sits elsewhere than stated")


def test_a_turned_reference_may_be_a_robot_that_goes_to_one_side(scaled_result):
    one = np.array([0.1])
    turned = NamedEffect(Added(HeadingOffset(), one), one, one, 0.2, 0.1, 50.0)
    said = sentences(replace(scaled_result, effects=(turned,), equivalent=()))
    assert said[0].startswith("A sensor is at fault, or a robot that always travels to one side")


def test_a_worse_gap_is_said_in_words(scaled_result):
    worse = replace(scaled_result.holdout, after=Gap(9.0, 8.0, 10.0))
    said = sentences(replace(scaled_result, holdout=worse))
    assert said[1].startswith("The gap on held-out data gets worse, from ")
    assert said[1].endswith("do not trust the name.")


def test_where_few_stretches_are_held_out_the_measured_runs_say_how_much(scaled_result):
    held = scaled_result.holdout
    near = replace(held.noise_floor, value=0.97 * held.before.value)
    few = replace(held.before, pieces=3)
    result = replace(scaled_result, holdout=replace(held, before=few, noise_floor=near))
    _, how_sure, *_ = sentences(result)
    assert held_out_share(result) is None
    fitted = result.measured
    assert "too near for a share on so few stretches" in how_sure
    assert f"measured runs had {fitted.before.value:.2g} m, have" in how_sure


def test_an_effect_by_which_the_ends_come_no_nearer_says_what_does(scaled_result):
    wheels, *others = scaled_result.effects
    worse = replace(wheels, gap_before=0.081, gap_after=0.088)
    said = text(replace(scaled_result, effects=(worse, *others)))
    assert "very strong, by headings and the way there: the ends of the windows" in said
    assert "no nearer" not in text(scaled_result)


def test_a_named_effect_beside_an_unknown_one(scaled_result, unknown_result):
    both = (scaled_result.effects[0], unknown_result.effects[0])
    said = sentences(replace(scaled_result, effects=both, equivalent=()))
    assert said[0].endswith("(wheel_scale), and something unknown that depends on heading.")


def test_a_name_that_is_a_smaller_part_goes_after_what_is_unknown(scaled_result, unknown_result):
    effects = (*unknown_result.effects, *scaled_result.effects)
    first = sentences(replace(unknown_result, effects=effects, equivalent=()))[0]
    assert first.startswith("Something is missing in icr (unknown): it depends on ")
    assert "; a smaller part of the gap is " in first
    assert "(wheel_scale)" in first.partition(";")[2]


def test_every_sentence_ends_and_holds_no_odd_number(scaled_result, none_result, unknown_result):
    for result in (scaled_result, none_result, unknown_result):
        for sentence in sentences(result):
            assert sentence.endswith(".")
            assert "nan" not in sentence.split()
            assert "inf" not in sentence.split()


def test_the_share_is_that_of_its_definition(scaled_result):
    closing = scaled_result.holdout
    share = held_out_share(scaled_result)
    expected = (closing.before.value - closing.after.value) / (
        closing.before.value - closing.noise_floor.value
    )
    assert share.value == pytest.approx(expected)
    assert share.low < expected < share.high
    assert share.low > 0.85
    assert share.high < 1.15
    assert share == held_out_share(scaled_result)


def test_an_effect_that_explains_nothing_closes_nothing(unknown_result):
    share = held_out_share(unknown_result)
    assert abs(share.value) < 0.05
    assert share.low < 0.05


def test_an_interval_is_stated_only_of_several_stretches():
    for pieces, words in (
        (1, "0.050 m (no interval from one stretch)"),
        (3, "0.050 m (0.040 to 0.060, from only 3 stretches)"),
        (5, "0.050 m (0.040 to 0.060)"),
    ):
        assert with_interval(Gap(0.0498, 0.04, 0.06, pieces)) == words
    assert percent(Share(0.9, 0.9, 0.9, 1)) == "90 % (no interval from one stretch)"
    assert percent(Share(0.9, 0.8, 1.0, 4)) == "90 % (80 to 100, from only 4 stretches)"


@pytest.mark.parametrize(
    ("evidence", "words"),
    [(-3, "none"), (1, "hardly any"), (5, "weak"), (7, "strong"), (812, "very strong")],
)
def test_evidence_has_a_scale_in_words(evidence, words):
    assert evidence_words(evidence) == words


def test_one_measured_stretch_says_neither_nothing_nor_something(none_result):
    one = Gap(0.2, 0.2, 0.2, 1)
    measured = replace(none_result.measured, before=one, after=one)
    said = sentences(replace(none_result, measured=measured))
    assert said[0].startswith("Whether something is missing in icr is undetermined")
    assert "0.2 m (no interval from one stretch) from the measured" in said[3]
