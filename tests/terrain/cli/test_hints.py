"""Hints for what a user may not have meant."""

from types import SimpleNamespace

import numpy as np

from odometry.estimation.filter_event import FilterEvent
from terrain.classification.likeness import Likeness
from terrain.classification.no_ground import SKY
from terrain.cli.hints import hints
from terrain.image_label import ASTRIDE


def result(
    initial="gravel", tables=("gravel",), classes=None, *, images=True, refused=0, events=()
):
    watcher = (
        None
        if classes is None
        else SimpleNamespace(
            classifier=SimpleNamespace(classes_=classes),
            image_labels=[],
            seen=SimpleNamespace(likeness=None),
        )
    )
    return SimpleNamespace(
        initial_terrain=initial,
        parameters=SimpleNamespace(terrains=dict.fromkeys(tables)),
        watcher=watcher,
        run=SimpleNamespace(images=images or None, began_s=1000.0),
        replay=SimpleNamespace(
            innovations_squared=np.array([np.nan] * 5 + [1.0] * (10 + refused)),
            accepted=np.array([False] * 5 + [True] * 10 + [False] * refused),
            events=events,
        ),
    )


def test_nothing_to_say():
    assert hints(result(classes=["gravel"]), vision=True) == []
    assert hints(result(), vision=False) == []
    assert hints(result(initial="ground", tables=(), images=False), vision=True) == []


def test_images_that_are_unlike_the_training_photographs_come_before_their_labels():
    of = starting(["grass"])
    of.watcher.seen.likeness = Likeness(40, 0.93, 0.9, ("darker", "more blurred"))
    (hint, *_) = hints(of, vision=True)
    assert "unlike the training photographs of the model (darker, more blurred)" in hint
    assert "93 % of held-out training patches" in hint
    of.watcher.seen.likeness = Likeness(40, 0.6, 0.5, ())
    assert not any("unlike" in one for one in hints(of, vision=True))


def test_images_that_show_no_ground_are_counted():
    of = starting(["grass", "unknown", "unknown"])
    for image_label in of.watcher.image_labels[1:]:
        image_label.reason = SKY
    (hint,) = [one for one in hints(of, vision=True) if "no terrain" in one]
    assert hint.startswith("2 of 3 images show no terrain and are unknown: smooth and blue")


def test_where_most_images_are_unknown_the_path_is_to_be_compared():
    of = starting(["grass"] * 12 + [""] * 9 + ["unknown"] * 13)
    (hint,) = [one for one in hints(of, vision=True) if "--no-vision" in one]
    assert hint.startswith("13 of 25 classified images are unknown (most often: ")
    fewer = starting(["grass"] * 14 + ["unknown"] * 13)
    assert not any("--no-vision" in one for one in hints(fewer, vision=True))


def test_a_terrain_without_a_table_is_named():
    (hint,) = hints(result(initial="gravle", images=False), vision=True)
    assert "'gravle' has no table" in hint
    assert "gravel" in hint
    (hint,) = hints(result(classes=np.array(["gravel", "ice"])), vision=True)
    assert hint.startswith("the model knows 'ice', the parameter set does not")


def starting(labels, *, initial="grass", of_run=None):
    """A run whose set begins with grass, and the first labels of its images."""
    of = result(initial, ("grass", "gravel"), classes=["grass", "gravel"])
    of.run.terrain = of_run
    of.watcher.image_labels = [SimpleNamespace(label=label, reason="") for label in labels]
    return of


def test_a_start_that_nobody_named_and_no_image_shows_is_doubted():
    (hint,) = hints(starting(["", "unknown", "gravel", "grass"]), vision=True)
    assert "--terrain gravel" in hint
    assert "'grass'" in hint
    assert hints(starting(["grass", "gravel"]), vision=True) == []
    assert hints(starting(["gravel"]), vision=True, named="grass") == []
    assert hints(starting(["gravel"], of_run="grass"), vision=True) == []


def test_images_without_a_model_are_named():
    (hint,) = hints(result(), vision=True)
    assert "--model" in hint


def test_many_refused_poses_are_named():
    assert hints(result(refused=1), vision=False) == []
    (hint,) = hints(result(refused=2), vision=False)
    assert "refused 2 of 12 poses" in hint


def sighted(*labels_and_reasons):
    """A result whose images got these labels."""
    of = result(classes=["gravel"])
    of.watcher.image_labels = [
        SimpleNamespace(label=label, reason=reason) for label, reason in labels_and_reasons
    ]
    return of


def test_vision_that_names_nothing_says_why():
    outside = ("", "the region lies outside the image")
    (hint,) = hints(sighted(outside, outside, ("unknown", "")), vision=True)
    assert "named no terrain in any of 3 images" in hint
    assert "the region lies outside the image (2), unlike any training patch (1)" in hint
    assert hints(sighted(outside, ("gravel", "")), vision=True) == []
    assert hints(sighted(), vision=True) == []


def test_treads_on_two_terrains_are_no_matter_of_the_pitch():
    """As `--per-tread` labels them: a reason of its own for each pair of names."""
    edge = [("unknown", f"{ASTRIDE} {pair}") for pair in ("a on the left", "b on the left")]
    still = ("", "the robot is stationary")
    (hint,) = hints(sighted(*edge, *edge, still, still, still), vision=True)
    assert "one terrain for both treads in none of 7 images" in hint
    assert "--per-tread" in hint
    assert "pitch" not in hint
    (hint,) = hints(sighted(*edge, still, still), vision=True)
    assert "pitch" in hint


def test_the_label_of_the_start_is_a_plain_name():
    (hint,) = hints(starting([np.str_("gravel")]), vision=True)
    assert "the first label is 'gravel'" in hint


def test_what_the_filter_noticed_is_said_the_first_ten_in_full():
    jump = FilterEvent("reinitialised", 1012.0, 1014.5, "the poses jumped by 2.0 m")
    assert hints(result(events=(jump,)), vision=False) == [
        "12.0 to 14.5 s: the poses jumped by 2.0 m"
    ]
    spike = FilterEvent("spike", 1003.0, 1003.0, "a spike")
    said = hints(result(events=(spike,) * 13), vision=False)
    assert said[0] == "3.0 s: a spike"
    assert len(said) == 11
    assert said[-1].startswith("3 more events")


def test_refused_poses_are_said_once():
    event = FilterEvent("refused_poses", 0.0, 9.0, "2 of 12 poses were refused as outliers")
    (hint,) = hints(result(refused=2, events=(event,)), vision=False)
    assert "refused 2 of 12 poses, because they lie far" in hint
    (hint,) = hints(result(refused=1, events=(event,)), vision=False)
    assert hint.endswith("were refused as outliers")
