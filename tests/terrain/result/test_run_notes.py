"""What is said of a result before its numbers are used."""

from types import SimpleNamespace

import numpy as np

from odometry.estimation.filter_event import FilterEvent
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.recording.run import Robot
from terrain.classification.answer import COLOURLESS, ONE_CHANNEL
from terrain.classification.likeness.likeness import Likeness
from terrain.classification.no_ground import SKY
from terrain.image_labels.image_label import ASTRIDE
from terrain.image_labels.image_labeller import LOST_DETAILS
from terrain.result.run_notes import event_lines, run_notes
from tests.terrain.result.two_terrains import AT_S, two_terrains

TABLE = TerrainParameters("icr", {"y_left": 0.35, "y_right": -0.33, "x_icr": 0.0})


def result(
    initial="gravel",
    tables=("gravel",),
    classes=None,
    *,
    refused=0,
    events=(),
    source="camera",
    width_m=0.4,
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
        parameters=ParameterSet(dict.fromkeys(tables, TABLE), {"track_width": 0.4}),
        watcher=watcher,
        source=source,
        run=SimpleNamespace(
            robot=Robot(width_m), pose=None, yaw_rate=None, terrain=None, began_s=1000.0
        ),
        replay=SimpleNamespace(
            innovations_squared=np.array([np.nan] * 5 + [1.0] * (10 + refused)),
            accepted=np.array([False] * 5 + [True] * 10 + [False] * refused),
            events=events,
        ),
    )


def test_nothing_to_say():
    assert run_notes(result(classes=["gravel"])) == []
    assert run_notes(result()) == []
    assert run_notes(result(initial="ground", tables=())) == []


def test_a_set_of_several_terrains_of_which_nothing_names_one():
    of_two = {"tables": ("gravel", "mud"), "source": "none"}
    (hint,) = run_notes(result(initial="unknown", **of_two))
    assert hint.startswith("the terrain is unknown throughout")
    assert hint.endswith("has gravel, mud. --terrain names one")
    assert run_notes(result(initial="mud", **of_two)) == []
    assert run_notes(result(initial="unknown", tables=("gravel", "mud"))) == []


def test_images_that_are_unlike_the_training_photographs_come_before_their_labels():
    of = starting(["grass"])
    of.watcher.seen.likeness = Likeness(40, 0.93, 0.9, ("darker", "more blurred"))
    (hint, *_) = run_notes(of)
    assert "unlike the training photographs of the model (darker, more blurred)" in hint
    assert "93 % of held-out training patches" in hint
    of.watcher.seen.likeness = Likeness(40, 0.6, 0.5, ())
    assert not any("unlike" in one for one in run_notes(of))


def test_colours_that_are_unlike_leave_the_names():
    of = starting(["grass"])
    of.watcher.seen.likeness = Likeness(40, 0.6, 0.5, (), colour_beyond=1.5)
    (hint,) = [one for one in run_notes(of) if "colours" in one]
    assert hint.endswith("or with images in this light")


def test_where_another_camera_would_not_be_noticed_it_is_said_of_images_like_training():
    of = starting(["grass"])
    of.watcher.classifier.noticed_share_ = 0.4
    of.watcher.seen.likeness = Likeness(40, 0.6, 0.5, ())
    (note,) = [one for one in run_notes(of) if "another camera may pass" in one]
    assert "40 % of them are noticed" in note
    of.watcher.seen.likeness = Likeness(40, 0.93, 0.9, ("darker",))
    assert not any("may pass" in one for one in run_notes(of))
    of.watcher.seen.likeness = Likeness(0, float("nan"), float("nan"), ())
    assert not any("may pass" in one for one in run_notes(of))


def test_images_that_show_no_ground_are_counted():
    of = starting(["grass", "unknown", "unknown"])
    for image_label in of.watcher.image_labels[1:]:
        image_label.reason = SKY
    (hint,) = [one for one in run_notes(of) if "no terrain" in one]
    assert hint.startswith("2 of 3 images show no terrain and are unknown: smooth and blue")


def test_grey_images_before_a_model_in_colour_are_counted():
    of = starting(["grass", "unknown", ""])
    of.watcher.image_labels[1].reason = COLOURLESS
    of.watcher.image_labels[2].reason = ONE_CHANNEL
    (hint,) = [one for one in run_notes(of) if "grey" in one]
    assert hint.startswith("2 of 3 images have no name, since they are grey")


def test_a_set_of_another_robot_is_said():
    (note,) = run_notes(result(width_m=0.5))
    assert note.startswith("the parameter set is of a robot of track width 0.4 m")


def test_where_most_images_are_unknown_the_path_is_to_be_compared():
    of = starting(["grass"] * 12 + [""] * 9 + ["unknown"] * 13)
    (hint,) = [one for one in run_notes(of) if "--no-vision" in one]
    assert hint.startswith("13 of 25 classified images are unknown (most often: ")
    fewer = starting(["grass"] * 14 + ["unknown"] * 13)
    assert not any("--no-vision" in one for one in run_notes(fewer))


def test_images_that_were_not_classified_although_they_show_the_terrain_are_counted():
    of = starting(["grass"] * 40 + [""] * 30)
    for row, image_label in enumerate(of.watcher.image_labels):
        image_label.region, image_label.image = object(), f"images/{row}.jpg"
        image_label.reason = LOST_DETAILS if row >= 45 else ""
    (hint,) = run_notes(of)
    assert hint.startswith("30 of 70 images that show the terrain ahead have no label (most often:")
    assert f"{LOST_DETAILS}, 25, the first is images/45.jpg)" in hint
    del of.watcher.image_labels[50:]
    assert run_notes(of) == []


def test_a_terrain_without_a_table_is_named():
    (hint,) = run_notes(result(initial="gravle"))
    assert "'gravle' has no table" in hint
    assert "gravel" in hint
    (hint,) = run_notes(result(classes=np.array(["gravel", "ice"])))
    assert hint.startswith("the model knows 'ice', the parameter set does not")
    assert hint.endswith("the terrains that the set has (gravel)")


def test_names_that_differ_by_capitals_or_signs_alone_are_named_together():
    of = result("Wet grass", ("wet_grass", "ice"), classes=["WET-GRASS", "sand"])
    start, model = run_notes(of)
    assert start.endswith("'wet_grass' there is 'Wet grass' here: give both one name")
    assert model.startswith("the model knows 'WET-GRASS', 'sand', the parameter set does not")
    assert model.endswith("'wet_grass' there is 'WET-GRASS' here: give both one name")


def starting(labels):
    """A run whose set begins with grass, and the first labels of its images."""
    of = result("grass", ("grass", "gravel"), classes=["grass", "gravel"])
    of.watcher.image_labels = [seen_label(label) for label in labels]
    return of


def seen_label(label, reason=""):
    return SimpleNamespace(label=label, reason=reason, region=None, image="", stamp_s=0.0)


def test_many_refused_poses_are_named():
    assert run_notes(result(refused=1)) == []
    (hint,) = run_notes(result(refused=2))
    assert "refused 2 of 12 poses" in hint


def seen_labels(*labels_and_reasons):
    """A result whose images got these labels."""
    of = result(classes=["gravel"])
    of.watcher.image_labels = [seen_label(*each) for each in labels_and_reasons]
    return of


def test_vision_that_names_nothing_says_why():
    outside = ("", "the region lies outside the image")
    (hint,) = run_notes(seen_labels(outside, outside, ("unknown", "")))
    assert "named no terrain in any of 3 images" in hint
    assert "the region lies outside the image (2), unlike any training patch (1)" in hint
    assert run_notes(seen_labels(outside, ("gravel", ""))) == []
    assert run_notes(seen_labels()) == []


def test_treads_on_two_terrains_are_no_matter_of_the_pitch():
    """As `--per-tread` labels them: a reason of its own for each pair of names."""
    edge = [("unknown", f"{ASTRIDE} {pair}") for pair in ("a on the left", "b on the left")]
    still = ("", "the robot is stationary")
    (hint,) = run_notes(seen_labels(*edge, *edge, still, still, still))
    assert "one terrain for both treads in none of 7 images" in hint
    assert "--per-tread" in hint
    assert "pitch" not in hint
    (hint,) = run_notes(seen_labels(*edge, still, still))
    assert "pitch" in hint


def test_what_the_filter_noticed_is_said_the_first_ten_in_full():
    jump = FilterEvent("reinitialised", 1012.0, 1014.5, "the poses jumped by 2.0 m")
    assert event_lines(result(events=(jump,))) == ["12.0 to 14.5 s: the poses jumped by 2.0 m"]
    spike = FilterEvent("spike", 1003.0, 1003.0, "a spike")
    said = event_lines(result(events=(spike,) * 13))
    assert said[0] == "3.0 s: a spike"
    assert len(said) == 11
    assert said[-1].startswith("3 more events")


def test_refused_poses_are_said_once():
    event = FilterEvent("refused_poses", 0.0, 9.0, "2 of 12 poses were refused as outliers")
    assert event_lines(result(refused=2, events=(event,))) == []
    assert run_notes(result(refused=1, events=(event,))) == []
    (line,) = event_lines(result(refused=1, events=(event,)))
    assert line.endswith("were refused as outliers")


def test_names_that_describe_the_motion_worse_than_one_terrain_are_said():
    of = result(classes=np.array(["a", "b"]))
    drive = two_terrains({"alpha_left": 0.9, "alpha_right": 0.9})
    of.run, of.parameters, of.initial_terrain = drive.run, drive.parameters, "a"
    of.replay.stamps_s = AT_S
    of.replay.terrains = ["ab"[int(stamp_s // 4) % 2] for stamp_s in AT_S]
    assert sum("--no-vision --terrain a" in note for note in run_notes(of)) == 1
    of.replay.terrains = ["a"] * len(AT_S)
    assert not any("--no-vision" in note for note in run_notes(of))
