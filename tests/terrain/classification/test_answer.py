"""Doubtful names of images unlike the training photographs."""

import json
from copy import copy
from dataclasses import replace

import cv2
import numpy as np
import pytest
from click.testing import CliRunner

from terrain.classification.answer import (
    DOUBTFUL,
    IMPROBABLE,
    TOO_UNLIKE,
    UNNOTICED,
    Classification,
)
from terrain.classification.confidence import AnswerConfidence
from terrain.classification.likeness.likeness import Likeness
from terrain.cli.verbs.classify import classify
from tests.terrain.classification.test_no_ground import photographs

LIKE, UNLIKE = (Likeness(20, 0.5, 0.5, (), beyond=beyond) for beyond in (0.9, 1.1))
DOUBTED = Classification("mud", 0.52, 0.1, {"mud": 0.52, "snow": 0.48}, probability_right=0.69)


def test_a_doubtful_name_is_unknown_with_its_reason():
    answer = DOUBTED.unless_doubtful(UNLIKE)
    assert answer == replace(DOUBTED, label="unknown", reason=DOUBTFUL)


def test_in_images_far_beyond_training_nothing_is_named():
    without = replace(DOUBTED, probability_right=None)  # by a model that never erred
    far, farther = replace(UNLIKE, beyond=2.1), replace(UNLIKE, beyond=10.1)
    assert without.unless_doubtful(far) == replace(without, label="unknown", reason=TOO_UNLIKE)
    assert without.unless_doubtful(replace(far, images=4)).label == "mud"
    sure = replace(DOUBTED, probability_right=0.99)
    assert sure.unless_doubtful(far) == sure
    assert sure.unless_doubtful(farther) == replace(sure, label="unknown", reason=TOO_UNLIKE)
    assert without.unless_doubtful(replace(UNLIKE, rank=0.9, beyond=None)).label == "mud"


@pytest.mark.parametrize(
    ("answer", "likeness"),
    [
        (DOUBTED, LIKE),
        (DOUBTED, None),
        (DOUBTED, Likeness(0, float("nan"), float("nan"), ())),
        (replace(DOUBTED, probability_right=0.7), UNLIKE),
        (replace(DOUBTED, probability_right=None), UNLIKE),
        (replace(DOUBTED, label="unknown", reason="no terrain: overexposed"), UNLIKE),
    ],
)
def test_every_other_answer_stays(answer, likeness):
    assert answer.unless_doubtful(likeness) == answer


@pytest.mark.parametrize(
    ("likeness", "share", "right", "reason"),
    [
        (LIKE, 0.4, 0.69, UNNOTICED),
        (UNLIKE, 0.4, 0.69, DOUBTFUL),
        (LIKE, 0.4, 0.7, ""),
        (LIKE, 0.4, None, ""),
        (LIKE, 0.9, 0.69, ""),
        (Likeness(0, float("nan"), float("nan"), ()), 0.4, 0.69, ""),
    ],
)
def test_where_another_camera_would_not_be_noticed_a_doubtful_name_is_unknown(
    likeness, share, right, reason
):
    answer = replace(DOUBTED, probability_right=right).unless_doubtful(likeness, share)
    assert answer.reason == reason
    assert answer.label == ("unknown" if reason else "mud")


@pytest.mark.parametrize(("right", "label"), [(0.24, "unknown"), (0.25, "mud"), (None, "mud")])
def test_a_name_that_is_wrong_three_times_of_four_is_unknown_whatever_the_images(right, label):
    answer = replace(DOUBTED, probability_right=right).unless_improbable()
    assert answer.label == label
    assert answer.reason == (IMPROBABLE if label == "unknown" else "")
    assert answer.unless_improbable() == answer


@pytest.mark.slow
def test_a_classifier_asks_every_image_for_a_probable_name(model):
    images = photographs(2, photos=2)[0]
    assert not {answer.reason for answer in model.classify(images)} & {IMPROBABLE}
    doubting = copy(model)
    doubting.confidence_ = AnswerConfidence(np.array([-5.0, 0.0, 0.0, 0.0]))
    answers = doubting.classify(images)
    assert {answer.label for answer in answers} == {"unknown"}
    assert IMPROBABLE in {answer.reason for answer in answers}


def test_the_verb_doubts_names_of_images_in_another_light(model, tmp_path):
    model.save(tmp_path / "a.model")
    printed = {}
    for light, power in (("own", 1.0), ("dark", 2.0)):
        paths = []
        for i, image in enumerate(photographs(2, photos=3)[0]):
            paths.append(str(tmp_path / f"{light}_{i}.png"))
            cv2.imwrite(paths[-1], np.rint(255 * (image / 255) ** power))
        answered = CliRunner().invoke(classify, [str(tmp_path / "a.model"), *paths])
        assert answered.exit_code == 0, answered.output
        printed[light] = answered.output
    assert "unlike the training photographs of the model" in printed["dark"]
    for reason in (TOO_UNLIKE, DOUBTFUL):
        assert reason not in printed["own"]
    assert TOO_UNLIKE in printed["dark"] or DOUBTFUL in printed["dark"]


@pytest.mark.parametrize("as_folder", [False, True])
def test_the_verb_keeps_names_of_the_same_camera(model, tmp_path, as_folder):
    unsure = copy(model)
    unsure.noticed_share_ = 0.4
    unsure.confidence_ = AnswerConfidence(np.zeros(4))  # right with 0.5, whatever is seen
    unsure.save(tmp_path / "a.model")
    images, labels = (of[::9] for of in photographs(1, photos=40)[:2])
    paths = []
    for i, (image, label) in enumerate(zip(images, labels, strict=True)):
        (tmp_path / "shown" / label).mkdir(parents=True, exist_ok=True)
        paths.append(str(tmp_path / "shown" / label / f"{i}.png"))
        cv2.imwrite(paths[-1], cv2.cvtColor(image, cv2.COLOR_RGB2BGR))
    shown = [str(tmp_path / "a.model"), *([str(tmp_path / "shown")] if as_folder else paths)]
    answers, said = {}, []
    for option in ([], ["--same-camera"]):
        printed = CliRunner().invoke(classify, [*shown, "--json", *option])
        assert printed.exit_code == 0, printed.output
        assert ("--same-camera" in printed.stderr) is (option == [])
        said.append(printed.stderr)
        found = json.loads(printed.stdout)
        rows = found["images"] if as_folder else found
        answers[bool(option)] = [(row["label"], row["reason"]) for row in rows]
    before = [(answer.label, answer.reason) for answer in unsure.classify(images)]
    doubted = [of if of[0] == "unknown" else ("unknown", UNNOTICED) for of in before]
    assert len(set(before)) > 1
    named = sum(label != "unknown" for label, _ in before)
    assert (f"Note: {named} names are unknown, as the model" in said[0]) is as_folder
    assert sorted(answers[True]) == sorted(before)
    assert sorted(answers[False]) == sorted(doubted)
    both = CliRunner().invoke(classify, [*shown, "--same-camera", "--own-statistics"])
    assert both.exit_code == 2
