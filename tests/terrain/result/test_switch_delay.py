"""Delays worked out by hand: speed 0.5 m/s up to 10 s, then 1 m/s."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.recording.run import Robot, Run
from odometry.tables.table import Table
from terrain.result.switch_delay import SwitchDelay, switch_delays, true_changes, true_stretches
from terrain.switch.place_labels import PlaceLabel
from terrain.switch.switch import SwitchEvent

STAMPS_S = np.arange(0.0, 20.5, 0.5)
ROWS = np.arange(len(STAMPS_S)) + 2


def event(terrain, stamp_s):
    place_label = PlaceLabel(terrain, stamp_s - 1, 0.0, np.zeros(2), 0.5)
    return SwitchEvent(terrain, stamp_s, place_label, 1.0, 0.5)


def result_of(true, events, initial="ice", start_s=0.0):
    """`true` maps the stamp of each true change to the terrain from there on."""
    speeds = np.where(STAMPS_S < 10, 0.5, 1.0)
    odometry = Table(Path("o.csv"), {"t": STAMPS_S, "v_left": speeds, "v_right": speeds}, ROWS)
    truth = None
    if true is not None:
        names = np.full(len(STAMPS_S), "", dtype=object)
        for since_s, name in true.items():
            names[since_s <= STAMPS_S] = name
        truth = Table(Path("t.csv"), {"t": STAMPS_S, "terrain": names}, ROWS)
    run = Run(Path("run"), Robot(0.4), {}, odometry, truth=truth)
    return SimpleNamespace(
        run=run,
        initial_terrain=initial,
        replay=SimpleNamespace(stamps_s=STAMPS_S[start_s <= STAMPS_S]),
        source="none" if events is None else "camera",
        changes=tuple(events or ()),
    )


def test_late_and_early_switches():
    result = result_of({0: "ice", 5: "snow", 12: "ice"}, [event("snow", 6.5), event("ice", 11.0)])
    snow, ice = switch_delays(result)
    assert snow == SwitchDelay("snow", 6.5, 5.0, 1.5, pytest.approx(0.75))
    assert ice == SwitchDelay("ice", 11.0, 12.0, -1.0, pytest.approx(-1.0))


def test_the_way_is_wheel_travel_across_a_change_of_speed():
    (delay,) = switch_delays(result_of({0: "ice", 9: "snow"}, [event("snow", 11.0)]))
    assert delay.late_m == pytest.approx(0.5 + 1.0)


def test_a_change_is_answered_once_and_by_the_nearest():
    events = [event("snow", 3.0), event("ice", 4.0), event("snow", 6.0)]
    delays = switch_delays(result_of({0: "ice", 5: "snow"}, events))
    assert [delay.true_s for delay in delays] == [None, None, 5.0]
    assert delays[0] == SwitchDelay("snow", 3.0)
    assert delays[2].late_s == pytest.approx(1.0)


def test_missed_changes_come_last_in_order_of_time():
    true = {0: "ice", 4: "snow", 8: "mud", 12: "snow", 16: "ice"}
    delays = switch_delays(result_of(true, [event("snow", 12.5)]))
    assert delays[0].true_s == 12.0
    assert delays[1:] == [
        SwitchDelay("snow", None, 4.0),
        SwitchDelay("mud", None, 8.0),
        SwitchDelay("ice", None, 16.0),
    ]


def test_a_wrong_start_is_a_change_at_the_start():
    result = result_of({0: "snow"}, [event("snow", 2.0)], initial="ice")
    assert switch_delays(result) == [SwitchDelay("snow", 2.0, 0.0, 2.0, pytest.approx(1.0))]
    assert true_changes(result_of({0: "ice"}, [], initial="ice")) == ()


def test_the_truth_counts_from_the_first_estimate_on():
    result = result_of({0: "snow", 2: "ice", 8: "snow"}, [], start_s=4.0)
    assert [(s.terrain, s.start_s) for s in true_stretches(result)] == [("ice", 4.0), ("snow", 8.0)]
    assert [change.start_s for change in true_changes(result)] == [8.0]


def test_without_truth_the_delay_is_unknown():
    assert switch_delays(result_of(None, [event("snow", 3.0)])) == [SwitchDelay("snow", 3.0)]
    bare = result_of(None, [event("snow", 3.0)])
    bare.run.odometry.columns["terrain"] = np.full(len(STAMPS_S), "ice")  # read for truth by nobody
    assert true_stretches(bare) == ()


def test_without_vision_there_is_no_switch_to_be_late():
    assert switch_delays(result_of({0: "ice", 5: "snow"}, None)) == []
