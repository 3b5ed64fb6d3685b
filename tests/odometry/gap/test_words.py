"""Sentences of a result: nothing is missing, something unknown is, or something with a name."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.corrected import Added
from odometry.effects.history import HISTORY
from odometry.effects.residual import VARIABLES, Residual
from odometry.effects.residual_of_place import PLACE, ResidualOfPlace
from odometry.effects.residual_variables import FURTHER
from odometry.effects.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.time_offset import TimeOffset
from odometry.gap.answer.next_drives import NextDrive
from odometry.gap.answer.result import Equivalent, NamedEffect
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.statistic import Gap
from odometry.gap.show.quantities import (
    Share,
    evidence_words,
    held_out_share,
    percent,
    with_interval,
)
from odometry.gap.show.unknown import DRIVES, how_to_separate, where_to_look
from odometry.gap.show.words import sentences


def text(result):
    return " ".join(sentences(result))


def test_a_named_effect_with_its_numbers(scaled_result):
    said = sentences(scaled_result)
    assert said[0] == (
        "Missing in icr: wheels of another size, or constant slip (wheel_scale) and a reference "
        "that is not at the robot's origin (lever_arm); these runs do not distinguish "
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
    assert said[0].startswith("A sensor or the robot: a reference that is not at the robot's")


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


def test_none_claims_nothing(none_result):
    said = sentences(none_result)
    assert said[0] == "Nothing that these runs could show is missing in icr (none)."
    assert said[2] == "Keep the model as it is."
    assert held_out_share(none_result) is None
    whole = text(none_result)
    for word in ("Missing", "Effect", "closed", "left", "share"):
        assert word not in whole


def test_none_admits_a_gap_above_the_floor(none_result):
    """On the measured runs: held-out stretches may be too few, or at rest."""
    measured = replace(none_result.measured, before=Gap(0.2, 0.15, 0.3))
    doubtful = replace(none_result, measured=measured)
    said = sentences(doubtful)
    assert said[0].endswith("but the gap on the measured runs is above the noise floor.")
    assert said[2].startswith("Do not rely on this")
    reasons = [Refusal(n, "constant", "held-out data") for n in ("time_offset", "unknown")]
    said = sentences(replace(doubtful, refusals=tuple(reasons)))
    assert said[0].endswith(": time_offset or a smooth function would close part of it there.")


def test_none_that_the_base_closes_with_other_values_is_no_advice_to_keep_it(none_result):
    """The noise floor is of calibration runs that are noisier than the measured ones."""
    before, after = Gap(0.116, 0.10, 0.13), Gap(0.029, 0.02, 0.04)
    floor = Gap(0.2, 0.15, 0.25)
    closing = replace(none_result.holdout, before=before, after=after, noise_floor=floor)
    missing, _, to_do, *_ = sentences(replace(none_result, holdout=closing))
    assert "(none), but other values of its parameters lower the gap on held-out data" in missing
    assert "from 0.12 m to 0.029 m" in missing
    assert to_do.startswith("Identify the parameters on runs like the measured ones")
    near = replace(closing, after=Gap(0.09, 0.08, 0.11))
    assert sentences(replace(none_result, holdout=near))[2].startswith("Keep the model as it is")


def test_unknown_without_any_name_says_so(none_result):
    sure = replace(none_result.holdout, before=Gap(0.2, 0.15, 0.3))
    first, _, to_do, *_ = sentences(replace(none_result, verdict="unknown", holdout=sure))
    assert first.startswith("Something is missing in icr (unknown): neither an effect")
    assert first.endswith("A reference that is noisier than in the calibration looks the same.")
    assert to_do.startswith("Look at the worst stretches")


def test_a_gap_that_only_the_measured_runs_show_asks_for_another_run_to_hold_out(none_result):
    measured = replace(none_result.measured, before=Gap(0.2, 0.15, 0.3))
    first, _, to_do, *_ = sentences(replace(none_result, verdict="unknown", measured=measured))
    assert "on the measured runs (unknown), and held-out data do not show it" in first
    assert to_do.startswith("Hold out whole runs that are driven as the measured ones are")


def test_unknown_that_a_fault_of_the_reference_explains_as_well_says_so(none_result):
    reason = "a map that drifts, or wind: no data of a run distinguish them"
    beside = Equivalent("reference_fault", "unknown", "let the robot stand still")
    result = replace(
        none_result,
        verdict="unknown",
        equivalent=(beside,),
        refusals=(Refusal("reference_fault", "drifting_map", reason),),
    )
    missing, _, to_do, *_ = sentences(result)
    assert missing == f"Something is missing in icr (unknown): {reason}."
    assert to_do.endswith("If it is reference_fault: let the robot stand still.")


def test_unknown_of_a_gap_that_is_not_surely_above_the_floor_says_so(none_result):
    refused = (Refusal("time_offset", "constant", "within noise"),)
    first, *_ = sentences(replace(none_result, verdict="unknown", refusals=refused))
    assert first.startswith("Whether something is missing in icr is undetermined (unknown)")
    assert first.endswith("not surely: time_offset would close part of it there.")


def test_unknown_says_what_it_depends_on_and_what_is_left(unknown_result):
    said = sentences(unknown_result)
    assert said[0] == (
        "Something is missing in icr that the catalogue of effects does not have (unknown): it "
        "depends on heading."
    )
    left = unknown_result.holdout.after.value - unknown_result.holdout.noise_floor.value
    assert f"{left:.2g} m stays unexplained" in said[1]
    assert said[2] == "Look for a cause that depends on heading."


def test_several_variables_are_said_to_go_together_with_drives_that_separate_them():
    names = ("heading", "time_since_stop", "tread_speed_lost")
    residuals = [Residual(name) for name in names]
    assert where_to_look([*residuals, residuals[0], ResidualOfPlace(nodes=((0, 0),))]) == [
        "look for a cause that depends on heading",
        "look for a cause that depends on time since the last stop",
        "look for a cause that depends on speed that each tread lost in the last 0.6 s",
        ResidualOfPlace.remedy,
    ]
    assert how_to_separate(residuals).endswith(
        "drive for a minute each: straight lines on several headings; one speed, with and without "
        "stops and reversals."
    )
    assert how_to_separate([residuals[0], residuals[0]]) == ""


def test_every_variable_has_a_drive_that_separates_it():
    assert set(DRIVES) == {*VARIABLES, *FURTHER, PLACE, HISTORY}


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
