"""Why no mode is named, said of tracks whose gyroscope or whose modes are in doubt by hand."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.checks.gain_check import GainCheck
from odometry.modes.checks.travel_check import TravelCheck
from odometry.modes.follow.followed import Followed
from odometry.modes.follow.gyroscope_bias import GyroscopeTrust
from odometry.modes.models.mode_set import NONE_OF_THESE, UNDETERMINED
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.turning_points import TurningPoints
from odometry.modes.show.doubts import doubts, not_checked
from odometry.modes.show.files import content_of
from odometry.modes.show.words import in_short, sentences
from tests.odometry.modes.mode_examples import run_of, track, velocity_set

SIZE, FROM = 11, 6  # stamps, half a second apart


def followed_with(**fields):
    """Mode a probable all along, and something in doubt from row FROM on."""
    known = replace(track(["a"] * SIZE, ["unknown"] * SIZE, names=("a", "b")), **fields)
    mode_set = velocity_set(names=("a", "b"))
    run = run_of(1.0, size=SIZE)
    return Followed(run, mode_set, ModesConfig(), mode_set.modes.signals(run), known)


def late(value, before):
    values = np.full(SIZE, before)
    values[FROM:] = value
    return values


def cases():
    never, known = np.zeros(SIZE, dtype=bool), np.full(SIZE, np.nan)
    open_ = GyroscopeTrust(late(True, before=False), known)
    off = GyroscopeTrust(never, late(1.21, before=np.nan))
    alike = np.column_stack([never, late(True, before=False)])
    travel = TravelCheck(
        np.column_stack([late(True, before=False), never]),
        np.column_stack([late(0.93, before=1.0)] * 2),
    )
    turns = late(True, before=False)
    gain = GainCheck(turns, late(0.05, before=0.0))
    return [
        ({"travel": travel}, UNDETERMINED, "positions went 0.93 times as far", "check the size"),
        ({"turns_are_off": turns}, UNDETERMINED, "turns by more or by less", "identify a mode"),
        ({"blocked": turns}, UNDETERMINED, "the robot does not turn, between", "look whether"),
        ({"gain": gain}, UNDETERMINED, "turns by 5 % more than on a, which", "identify a mode"),
        ({"centre": turns}, UNDETERMINED, "turns about another point", "identify a mode"),
        ({"drifts": turns}, UNDETERMINED, "drifts in one direction of the world", "look whether"),
        ({"contradicted": turns}, UNDETERMINED, "the motion contradicted the", "identify a mode"),
        ({"headings_disagree": turns}, UNDETERMINED, "headings turn apart by", "check the gyro"),
        ({"gyroscope": off}, NONE_OF_THESE, "the gyroscope reads 1.21 times", "check the gyro"),
        ({"gyroscope": open_}, UNDETERMINED, "a gyroscope bias of 0.000 rad/s", "let the robot r"),
        ({"alike": alike}, UNDETERMINED, "from another for 40 % of the time", "drive turns of"),
    ]


@pytest.mark.parametrize(("fields", "answer", "reason", "remedy"), cases())
def test_a_doubt_is_an_answer_a_reason_and_a_remedy(fields, answer, reason, remedy):
    found = followed_with(**fields)
    answers = found.answers(found.motion)
    assert (set(answers[:FROM]), set(answers[FROM:])) == ({"a"}, {answer})
    (one,) = doubts(found)
    assert one.share == pytest.approx(0.4)
    assert reason in one.reason
    _, how_sure, to_do = in_short(found)
    assert reason in how_sure
    assert to_do.startswith(remedy)
    assert any(reason in sentence for sentence in sentences(found))
    (said,) = content_of(found)["not_named"]
    assert said["share"] == one.share


def test_poses_that_scatter_are_said_whatever_is_named():
    found = followed_with(scatter=late(4.2, before=1.0))
    (one,) = doubts(found)
    assert "scatter 4.2 times as far as in the runs of identification" in one.reason
    assert not doubts(followed_with(scatter=late(1.5, before=np.nan)))


def test_what_holds_for_a_moment_is_not_said():
    scale = np.full(SIZE, np.nan)
    scale[FROM] = 1.2
    trust = GyroscopeTrust(np.zeros(SIZE, dtype=bool), scale)
    assert doubts(followed_with(gyroscope=trust))  # half a second of five
    scale = np.full(SIZE, np.nan)
    scale[-1] = 1.2  # the last stamp lasts no time
    assert not doubts(followed_with(gyroscope=GyroscopeTrust(np.zeros(SIZE, dtype=bool), scale)))


def test_without_doubts_none_is_said():
    found = followed_with()
    assert doubts(found) == ()
    assert content_of(found)["not_named"] == []


def test_what_is_off_in_parts_says_for_how_long_in_all():
    def reason(*rows):
        scale = np.where(np.isin(np.arange(SIZE), rows), 1.21, np.nan)
        trust = GyroscopeTrust(np.zeros(SIZE, dtype=bool), scale)
        (one,) = doubts(followed_with(gyroscope=trust))
        return one.reason

    assert "between 1.5 s and 2.5 s" in reason(3, 4, 5)
    assert "for 1.5 s in all between 0.5 s and 3.0 s" in reason(1, 2, 6)


def test_a_gyroscope_that_repeats_one_reading_is_said():
    run, mode_set = run_of(1.6, size=400), velocity_set(names=("a", "b"))
    known = track(["a"] * 400, ["unknown"] * 400, names=("a", "b"))
    rates = np.where(np.arange(400) > 200, run.odometry["gyro_z"][200], run.odometry["gyro_z"])
    held = replace(
        run, odometry=replace(run.odometry, columns=run.odometry.columns | {"gyro_z": rates})
    )
    said = [
        one.reason
        for of in (run, held)
        for one in doubts(Followed(of, mode_set, ModesConfig(), mode_set.modes.signals(of), known))
    ]
    assert len(said) == 1
    assert "the gyroscope repeats one reading between" in said[0]


@pytest.mark.parametrize(
    ("windows", "most_m", "missing"),
    [
        (None, 0.1, "without measured yaw:"),
        (1, np.nan, "without measured yaw in the runs of the set:"),
        (0, 0.1, "without 16 s of measured yaw in which it turns enough:"),
        (1, 0.1, None),
    ],
)
def test_it_says_what_lacks_to_check_the_point_of_turns(windows, most_m, missing):
    followed = followed_with()
    modes = replace(followed.mode_set.modes, turning_least_m=-most_m, turning_most_m=most_m)
    points = None if windows is None else TurningPoints(*np.zeros((3, windows)))
    signals = replace(followed.signals, turning_points=points)
    known = replace(followed, mode_set=replace(followed.mode_set, modes=modes), signals=signals)
    found = [sentence for sentence in not_checked(known) if "which point" in sentence]
    assert len(found) == (missing is not None)
    assert missing is None or missing in found[0]
