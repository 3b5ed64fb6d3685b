"""Sentences of a result in which nothing is missing, or something that has no name."""

from dataclasses import replace

from odometry.effects.unknown.history import HISTORY
from odometry.effects.unknown.residual import VARIABLES, Residual
from odometry.effects.unknown.residual_of_place import PLACE, ResidualOfPlace
from odometry.effects.unknown.residual_variables import FURTHER
from odometry.gap.answer.result import Equivalent
from odometry.gap.name.verdict import Refusal
from odometry.gap.prepare.statistic import Gap
from odometry.gap.show.quantities import (
    held_out_share,
)
from odometry.gap.show.unknown import DRIVES, how_to_separate, where_to_look
from odometry.gap.show.words import sentences


def text(result):
    return " ".join(sentences(result))


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


def test_a_mast_that_leans_has_a_likely_cause():
    (clause,) = where_to_look([Residual("leaning_forward")])
    assert clause.endswith(
        "a mast of 1 m on the robot leans forward, such as positions of an antenna on a mast that "
        "are not corrected for roll and pitch"
    )


def test_every_variable_has_a_drive_that_separates_it():
    assert set(DRIVES) == {*VARIABLES, *FURTHER, PLACE, HISTORY}
