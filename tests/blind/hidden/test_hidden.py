"""The hidden effects are what they say, show in both runs, and are not in the calibration."""

import math

import numpy as np
import pytest

from odometry.recording.run import Run
from tests.blind.cases import make_case
from tests.blind.effects import slope_sliding
from tests.blind.ground import Ground
from tests.blind.hidden import courses
from tests.blind.hidden.catalogue import HIDDEN
from tests.blind.hidden.draw import HELD_OUT_OF_FLOOR, SIZES_OF_FLOOR, draw_hidden_case, parts_alone
from tests.blind.hidden.kind import Clock, Hidden
from tests.blind.hidden.motion import move
from tests.blind.hidden.scene import RUNS, STEP_S, Drive, draw_drive, draw_scene
from tests.blind.hidden.seen import sliding
from tests.blind.hidden.size import size_of_floor
from tests.blind.motion import drive as drive_on_slopes

HELD_S = 20.0


def rng(seed=0):
    return np.random.default_rng(seed)


def scene_of(kind, seed=0):
    return draw_scene(rng(seed), HIDDEN[kind])


def steady(left, right):
    """A drive from the origin at the same tread speeds for 20 s."""
    asked = np.tile([left, right], (round(HELD_S / STEP_S) + 1, 1)).astype(float)
    return Drive(asked, Ground(), (0.0, 0.0, 0.0), None)


def hidden_in(kind, scene, drive, seed=0):
    return HIDDEN[kind].draw(rng(seed), scene)(rng(seed + 1), drive.clock)


@pytest.mark.slow
@pytest.mark.parametrize("kind", HIDDEN)
def test_it_shows_in_both_runs_and_not_in_the_calibration(kind):
    drawn = draw_hidden_case(HIDDEN[kind], rng([0, *kind.encode()]))
    sizes = {run: size_of_floor(motion, drawn.scene) for run, motion in drawn.motions.items()}
    assert sizes["calibration"] < 0.01
    low, high = SIZES_OF_FLOOR
    if HIDDEN[kind].true:
        for alone in parts_alone(drawn.scene, drawn.motions["measured"]):
            assert low <= size_of_floor(alone, drawn.scene) <= high
        assert HELD_OUT_OF_FLOOR[0] <= sizes["holdout"] <= HELD_OUT_OF_FLOOR[1]
    else:  # rolling ground pitches the body while it turns, which the size leaves out
        assert max(sizes.values()) < (0.3 if HIDDEN[kind].sloped else 0.01)


@pytest.mark.parametrize("kind", ["late_commands", "changed_terrain", "multipath"])
def test_a_seed_gives_the_same_bytes_and_noise_changes_poses_alone(tmp_path, kind):
    first, again, louder = (
        make_case(kind, 3, tmp_path / name, noise=noise)
        for name, noise in (("a", 1.0), ("b", 1.0), ("c", 3.0))
    )
    assert first.truth == again.truth == louder.truth
    for run in RUNS:
        files = [getattr(case, run) for case in (first, again, louder)]
        for name in ("odometry.csv", "pose.csv"):
            a, b, c = ((folder / name).read_bytes() for folder in files)
            assert a == b
            assert (a == c) == (name == "odometry.csv")
        recorded = Run.read(files[0])
        assert recorded.odometry.stamps_s[-1] - recorded.odometry.stamps_s[0] > 80.0


def test_gyroscopes_are_recorded_in_about_half_and_rates_differ():
    scenes = [scene_of("slip_by_speed", seed) for seed in range(200)]
    kinds = [scene.sensors.gyroscope for scene in scenes]
    assert 0.4 < np.mean([kind != "" for kind in kinds]) < 0.6
    assert {"", "odometry", "imu"} == set(kinds)
    assert {1, 2, 5} == {scene.sensors.odometry_rows for scene in scenes}
    assert all(scene_of("late_commands", seed).sensors.gyroscope for seed in range(20))


@pytest.mark.parametrize(
    "kind", ["turtle_mode", "grip_lost", "lost_tyre", "put_down_load", "clock_step"]
)
def test_each_run_has_a_moment_of_its_own(kind):
    truth = draw_hidden_case(HIDDEN[kind], rng(1)).truth
    assert abs(truth["measured"]["moment_s"] - truth["holdout"]["moment_s"]) > 1e-3


def test_nothing_hidden_is_the_arc_of_the_icrs_and_steps_by_place_follow_it():
    scene, drive = scene_of("nothing"), steady(0.3, 0.5)
    exact = move(scene, drive, Hidden()).poses
    base = scene.base
    left, right = base.alpha_left * 0.3, base.alpha_right * 0.5
    omega = (right - left) / base.width
    v_x, v_y = left + base.y_left * omega, -base.x_icr * omega
    end = (v_x + 1j * v_y) * (np.exp(1j * omega * HELD_S) - 1) / (1j * omega)
    assert exact[-1, [0, 1, 4]] == pytest.approx([end.real, end.imag, omega * HELD_S])
    stepped = move(scene, drive, Hidden(at_place=lambda *given: given[-1])).poses
    assert stepped[-1] == pytest.approx(exact[-1], abs=1e-4)


def test_deflation_and_late_commands_by_their_closed_forms():
    scene, drive = scene_of("deflation"), steady(0.4, 0.4)
    whole = move(scene, drive, Hidden())
    hidden = hidden_in("deflation", scene, drive)
    share = np.ptp(move(scene, drive, hidden).yaw_rates_rad_s) / whole.yaw_rates_rad_s[0]
    assert abs(share) == pytest.approx(hidden.truth["loss"])
    delay_s = hidden_in("late_commands", scene, drive).truth["delay_s"]
    ramp = np.arange(2000.0)[:, None] * [1.0, 2.0]
    late = hidden_in("late_commands", scene, drive).treads(ramp)
    assert late[500] == pytest.approx(ramp[500] - delay_s / STEP_S * np.array([1.0, 2.0]))


def test_sliding_on_a_slope_is_that_of_the_papers_cases():
    scene = scene_of("slope_and_wheels")
    ground = Ground((0.12, 0.05))
    p = slope_sliding(rng(), scene.body, scene.base) | {"v_max": 2.0}
    drive = Drive(steady(0.3, 0.6).asked_m_s[:1001], ground, (1.0, 2.0, 0.3), None)
    hidden = Hidden(at_place=lambda _, pose, twist: sliding(scene.base, p, pose, twist))
    here = move(scene, drive, hidden).poses[-1]
    there = drive_on_slopes(
        drive.asked_m_s[::2],
        scene.body,
        scene.base,
        {"slope_sliding": p},
        ground=ground,
        start=drive.start,
    ).poses[-1]
    assert here == pytest.approx(there, abs=1e-9)


def test_limits_of_drives():
    scene, clock = scene_of("top_speed"), Clock(STEP_S, np.arange(1000) * STEP_S)
    ramp = np.column_stack([np.linspace(-1, 1, 1000)] * 2)
    for kind in ("deadband", "weak_side"):
        hidden = HIDDEN[kind].draw(rng(), scene)(rng(), clock)
        changed = hidden.treads(ramp) != ramp
        assert changed.any()
        assert np.abs(ramp[changed]).max() < hidden.truth["least_m_s"]
    slewed = HIDDEN["acceleration_limit"].draw(rng(), scene)(rng(), clock)
    steps = np.diff(slewed.treads(np.sign(ramp)), axis=0) / STEP_S
    assert np.abs(steps).max() == pytest.approx(slewed.truth["most_m_s2"])
    play = HIDDEN["backlash"].draw(rng(), scene)(rng(), clock)
    lost = (ramp - play.treads(ramp)).sum(axis=0) * STEP_S
    assert np.abs(lost).max() <= play.truth["play_m"] + 1e-9


def test_courses_by_their_laws():
    clock = Clock(STEP_S, np.arange(20000) * STEP_S)
    mask, events = courses.bursts(rng(), clock, (1.0, 2.0), (3.0, 4.0))
    assert mask.sum() * STEP_S == pytest.approx(
        sum(min(end, 200.0) - begin for begin, end in events), abs=1.0
    )
    step = np.ones((500, 1))
    step[0] = 0.0
    assert courses.lagged(step, 0.5, STEP_S)[101, 0] == pytest.approx(1 - math.exp(-2.02), abs=1e-6)
    assert courses.wander(rng(), clock, 2.0).std() == pytest.approx(1.0)
    patches = courses.Patches(rng(), 5.0, 0.3)
    on = [patches.at(*point) > 0.5 for point in rng(5).uniform(-200, 200, (4000, 2))]
    assert np.mean(on) == pytest.approx(0.3, abs=0.04)


def test_a_drive_is_slow_and_level_to_calibrate():
    for seed in range(20):
        scene = scene_of("uphill_slip", seed)
        slow = draw_drive(rng(seed), scene, "calibration")
        assert slow.ground.level
        assert np.abs(slow.asked_m_s).max() < 0.52
        assert not draw_drive(rng(seed), scene, "measured").ground.level
