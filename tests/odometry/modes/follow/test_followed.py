"""Runs followed: scores, sentences and files, against what was driven."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from odometry.modes.follow.camera_prior import PULLED_S, SeenTerrain
from odometry.modes.follow.followed import MOTION, MOTION_AND_CAMERA, Followed, followed
from odometry.modes.follow.track import ModesConfig
from odometry.modes.show.files import content_of, write_modes, write_runs
from odometry.modes.show.words import answer_words, sentences
from tests.odometry.modes.mode_examples import run_of, track, traction_set, velocity_set

HALVES = ["ice"] * 200 + ["tar"] * 200
TURNS = np.repeat([1.0, 2.0], 200)


@pytest.fixture(scope="module")
def halves():
    """Ice, then tar, whose gains are as the modes say."""
    return followed(run_of(TURNS, labels=HALVES), velocity_set())


def by_hand(most, labels, **others):
    """Answers that are given, of modes a and b."""
    known = track(most, labels, names=("a", "b"))
    mode_set = velocity_set(names=("a", "b"))
    signals = mode_set.modes.signals(run_of(1.0, size=len(most)))
    return Followed(run_of(1.0, size=len(most)), mode_set, ModesConfig(), signals, known, **others)


def test_modes_that_were_driven_are_recognised(halves):
    score = halves.score(halves.motion)
    assert [one.mode for one in score.detected] == ["ice", "tar"]
    assert all(one.after_s < 2.0 for one in score.detected)
    assert score.right > 0.7
    assert halves.tracks == {MOTION: halves.motion}
    assert halves.last_track is halves.motion


def test_modes_between_which_the_answer_lies_are_named():
    """Three modes for 0.5 s each stamp: b or c for 2 s of the 3 s that are open, any for 1 s."""
    known = track(["a", "", "", "", "", "", "", "a"], ["a"] * 8, names=("a", "b", "c"))
    known.probabilities[1:5] = [0.02, 0.5, 0.48]
    of_three = velocity_set((1.0, 2.0, 3.0), names=("a", "b", "c"))
    run = run_of(1.0, size=8)
    made = Followed(run, of_three, ModesConfig(), of_three.modes.signals(run), known)
    assert made.left_open(known) == {
        ("b", "c"): pytest.approx(2 / 3),
        ("a", "b", "c"): pytest.approx(1 / 3),
    }
    assert made.candidates(known).tolist() == ["a", *["b or c"] * 4, *["a or b or c"] * 2, "a"]
    said = "While undetermined, the candidates are b or c for 67 % of that time."
    assert said in sentences(made)
    score = made.score(known)  # half a second of 3.5 that the last stamp does not last
    assert (score.narrowed_of_all, score.missed_of_all) == pytest.approx((0.0, 2.0 / 3.5))
    (first, second) = content_of(made)["motion"]["undetermined_between"]
    assert (first["modes"], second["modes"]) == (["b", "c"], ["a", "b", "c"])


def test_a_mode_that_was_always_recognised_left_nothing_open():
    told = by_hand(["a"] * 5, ["a"] * 5)
    assert told.left_open(told.motion) == {}


def test_sight_at_the_start_decides_before_motion_does():
    """The run begins with the shares that the chain has in the long run."""
    leaves, pulled = 1 / 20.0, 0.98 / PULLED_S
    ice = leaves / (2 * leaves + pulled)
    sight = (SeenTerrain(0.0, "tar", 0.99),)
    both = followed(run_of(TURNS, labels=HALVES), velocity_set(), seen=sight)
    assert both.motion.probabilities[0] == pytest.approx([0.5, 0.5])
    assert both.with_camera.probabilities[0] == pytest.approx([ice, 1 - ice])
    assert both.last_track is both.tracks[MOTION_AND_CAMERA] is both.with_camera


def test_sight_that_lies_is_argued_with():
    config = ModesConfig(lasting_s=1.0)
    sight = (SeenTerrain(0.0, "tar", 0.9),)
    lie = followed(run_of(1.0, labels=["ice"] * 400), velocity_set(), config, sight)
    argued = lie.disagreements
    assert {(seen, felt) for _, _, seen, felt in argued} == {("tar", "ice")}
    assert sum(to_s - from_s for from_s, to_s, _, _ in argued) > 5.0
    said = sentences(lie)
    assert any(s.endswith("it is tar by the camera and ice by the motion.") for s in said)
    assert content_of(lie)["disagreements"] == [
        {"from_s": from_s, "to_s": to_s, "seen": "tar", "felt": "ice"}
        for from_s, to_s, _, _ in argued
    ]


def test_numbers_of_all_stretches_weigh_their_time():
    """a: detected at once, 2 of 4 half seconds right; b after 1 s, then 1 of 1."""
    most = ["a", "a", "b", "", "a", "a", "b", "b"]
    answers = by_hand(most, ["a"] * 4 + ["b"] * 4)
    score = answers.score(answers.motion)
    assert [one.after_s for one in score.detected] == [0.0, 1.0]
    assert score.median_after_s == 0.5
    shares = (score.right, score.wrong, score.undetermined)
    weighed = np.array([1.5, 0.5]) @ [[0.5, 0.25, 0.25], [1, 0, 0]] / 2
    assert shares == pytest.approx(weighed)
    assert score.wrong_of_all == pytest.approx(1.5 / 3.5)
    assert (score.narrowed_of_all, score.missed_of_all) == (0.0, 0.0)
    assert answers.shares(answers.motion) == pytest.approx(
        {"a": 2 / 3.5, "b": 1 / 3.5, "undetermined": 0.5 / 3.5}
    )


@pytest.mark.parametrize(
    ("most", "labels", "words"),
    [
        (["", "a", "a"], ["a"] * 3, "a: detected after 0.5 s; right 100 % of the time after that."),
        (["", "b"], ["a"] * 2, "a: not detected in 0.5 s; b 50 % of that time."),
        (["", ""], ["a"] * 2, "a: not detected in 0.5 s."),
        (
            ["a", "a", "b", ""],
            ["a"] * 4,
            "a: detected after 0.0 s; right 67 % of the time after that, ",
        ),
        (["a", "a", "b"], ["unknown"] * 3, "a 100 % of the time."),
        (["a", "", ""], ["unknown"] * 3, "a 50 % of the time, undetermined 50 % of the time."),
    ],
)
def test_the_answer_in_words(most, labels, words):
    answers = by_hand(most, labels)
    assert answer_words(answers, answers.motion).startswith(words)


def test_many_stretches_are_said_together():
    answers = by_hand(["a", "b"] * 6, ["a", "a", "b", "b"] * 3)
    words = answer_words(answers, answers.motion)
    assert words.startswith("6 of 6 stretches were detected, after 0.2 s in the median; right ")
    assert words.endswith("% of all the time.")
    never = by_hand([""] * 12, ["a", "a", "b", "b"] * 3)
    assert answer_words(never, never.motion) == (
        "0 of 6 stretches were detected; wrong 0 % of all the time."
    )


def test_what_is_no_mode_is_said_and_not_judged():
    answers = by_hand(["a", "a"], ["mud", "mud"])
    assert answers.foreign_labels == ("mud",)
    assert any("names mud, which is no mode" in sentence for sentence in sentences(answers))
    assert content_of(answers)["motion"]["detections"] == []


def rows_of(file):
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_a_row_for_each_stamp(halves, tmp_path):
    written = write_modes(halves, tmp_path)
    assert sorted(file.name for file in written) == ["modes.csv", "result.json"]
    rows = rows_of(tmp_path / "modes.csv")
    assert list(rows[0]) == [
        *("t", "probability_ice", "probability_tar", "answer", "candidates", "label"),
        *("vx", "wz", "gyro_bias", "sigma_vx", "sigma_wz", "sigma_gyro_bias"),
        *("probability_none of these", "innovation_vx", "innovation_wz"),
        *("between", "between_share"),
    ]
    assert len(rows) == len(halves.motion.stamps_s)
    assert [row["answer"] for row in rows] == halves.answers(halves.motion).tolist()
    assert [row["label"] for row in rows] == HALVES
    for name, column in zip(("ice", "tar"), halves.motion.probabilities.T, strict=True):
        read = [float(row[f"probability_{name}"]) for row in rows]
        assert read == pytest.approx(column, abs=1e-9)


def test_the_numbers_are_those_of_the_score_and_none_is_nan(halves, tmp_path):
    write_modes(halves, tmp_path)
    content = json.loads((tmp_path / "result.json").read_text())
    score = halves.score(halves.motion)
    assert content["kind"] == "velocity"
    assert content["names"] == ["ice", "tar"]
    assert content["motion"]["right"] == pytest.approx(score.right)
    assert content["motion"]["confusion_s"].keys() == {"ice", "tar"}
    assert content["motion"]["mean_normalised_innovation_squared"] > 0
    assert content["sight"] is None
    never = by_hand(["", ""], ["a", "a"])
    write_modes(never, tmp_path)
    content = json.loads((tmp_path / "result.json").read_text())
    assert content["motion"]["right"] is None
    assert content["motion"]["detections"][0]["after_s"] is None


def test_a_table_with_sight_goes_when_there_is_none(halves, tmp_path):
    sight = (SeenTerrain(1.0, "tar", 0.9),)
    with_sight = followed(halves.run, halves.mode_set, seen=sight)
    write_modes(with_sight, tmp_path)
    rows = rows_of(tmp_path / "modes_with_sight.csv")
    assert [row["seen"] for row in rows] == [""] * 50 + ["tar"] * 350
    write_modes(halves, tmp_path)
    assert not (tmp_path / "modes_with_sight.csv").exists()


def test_traction_modes_have_a_pose(tmp_path):
    run = run_of(0.5, track_width=0.5, labels=["none"] * 400)
    write_modes(followed(run, traction_set()), tmp_path)
    rows = rows_of(tmp_path / "modes.csv")
    x, y = (np.array([float(row[name]) for row in rows]) for name in ("x", "y"))
    distance = np.hypot(np.diff(x), np.diff(y)).sum()
    assert distance == pytest.approx(0.5 * run.odometry.stamps_s[-1], rel=0.1)
    assert float(rows[-1]["sigma_yaw"]) > 0


def test_a_run_that_failed_is_a_row(halves, tmp_path):
    unnamed = replace(halves.run, odometry=run_of(TURNS).odometry)
    blind = followed(unnamed, halves.mode_set)
    write_runs({"good": halves, "bad": "there, is none", "blind": blind}, tmp_path / "runs.csv")
    good, bad, blind = rows_of(tmp_path / "runs.csv")
    assert (good["run"], good["failed"], good["stretches"], good["told"]) == ("good", "", "2", "2")
    assert float(good["right"]) == pytest.approx(halves.score(halves.motion).right)
    assert (bad["failed"], bad["right"], bad["stretches"]) == ("there, is none", "", "")
    assert (blind["failed"], blind["right"], blind["stretches"]) == ("", "", "0")
