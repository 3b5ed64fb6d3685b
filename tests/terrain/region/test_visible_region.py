"""How far ahead the region lies, and which part of it the image shows."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import terrain.region.region as region_file
from odometry.geometry import se2
from terrain.camera.camera import Camera
from terrain.region.footprint_parts import footprint_parts, visible_shares
from terrain.region.region import NoRegion, Region, RegionConfig, predict_region
from tests.terrain.region.regions import (
    AHEAD,
    MATRIX,
    MOUNT,
    ROBOT,
    box_round_footprint,
    corners_of_footprint,
    pixels_outside,
    pose_on_circle,
    seen,
)


@settings(max_examples=25)
@given(
    speed=st.floats(0.1, 2.0),
    curvature=st.floats(-0.3, 0.3),
    pitch=st.floats(0.6, 1.2),
    camera_yaw=st.floats(-0.2, 0.2),
    focal=st.floats(200.0, 400.0),
)
def test_default_time_is_the_smallest_for_which_all_of_the_footprint_is_in_sight(
    speed, curvature, pitch, camera_yaw, focal
):
    """Against a search in steps of 5 mm; without a lens the corners of a rectangle suffice."""
    matrix = [[focal, 0, 320.0], [0, focal, 240.0], [0, 0, 1]]
    camera = Camera.from_mount((640, 480), matrix, [], [0.3, 0.0, 0.9, 0.0, pitch, camera_yaw])
    twist = np.array([speed, 0.0, speed * curvature])
    region = predict_region(ROBOT, camera, twist, speed, RegionConfig(least_share=1.0))
    travels_m = np.arange(0.0, 3.6, 0.005)
    footprints = [corners_of_footprint(pose_on_circle(d, curvature), 0.72, 0.6) for d in travels_m]
    found_m = travels_m[seen(camera, np.array(footprints)).all(axis=1)]
    assume(not len(found_m) or found_m[0] < 3.57)  # a step may end just before or after the limit
    if not len(found_m):
        assert region.reason == "the region lies outside the image"
    else:
        assert isinstance(region, Region)
        assert found_m[0] - 0.0051 <= region.ahead_s * speed <= found_m[0] + 3.6 / 199
        assert region.distance_ahead_m == pytest.approx(region.ahead_s * speed)


@settings(max_examples=25)
@given(
    speed=st.floats(0.1, 2.0),
    curvature=st.floats(-1.0, 1.0),
    pitch=st.floats(0.5, 1.2),
    rows=st.integers(200, 479),
)
def test_a_bumper_over_the_lowest_rows_is_as_an_image_that_ends_there(
    speed, curvature, pitch, rows
):
    mount = [0.3, 0.0, 0.9, 0.0, pitch, 0.0]
    whole, shorter = (Camera.from_mount((640, h), MATRIX, [], mount) for h in (480, rows))
    bumper = np.array([[0, rows], [639, rows], [639, 479], [0, 479]], float)
    twist = np.array([speed, 0.0, speed * curvature])
    beside, above = (
        predict_region(ROBOT, camera, twist, speed, RegionConfig())
        for camera in (replace(whole, robot_outlines=(bumper,)), shorter)
    )
    assert type(beside) is type(above)
    if isinstance(above, Region):
        # pixels are looked up in the nearest one: half a pixel of terrain, a cell at the most
        assert beside.ahead_s == pytest.approx(above.ahead_s, abs=2 * 3.6 / 199 / speed)


@settings(max_examples=40)
@given(
    curvature=st.floats(0.0, 2.5),
    camera_yaw=st.floats(-0.8, 0.8),
    least_share=st.sampled_from([0.4, 0.6, 0.8]),
)
def test_where_a_corner_stays_outside_the_visible_part_is_the_region(
    curvature, camera_yaw, least_share
):
    """Against points strewn over the footprint, each carried there by itself."""
    camera = Camera.from_mount((640, 480), MATRIX, [], [*MOUNT[:5], camera_yaw])
    twist = np.array([1.0, 0.0, curvature])
    region = predict_region(ROBOT, camera, twist, 1.0, RegionConfig(least_share=least_share))
    strewn = np.random.default_rng(0).uniform(-0.5, 0.5, (400, 2)) * [0.72, 0.6]
    poses = np.array([pose_on_circle(travel_m, curvature) for travel_m in np.arange(0, 3.6, 0.02)])
    places = poses[:, 0] + 1j * poses[:, 1]
    carried = places[:, None] + (strewn @ [1, 1j]) * np.exp(1j * poses[:, 2:])
    middle = seen(camera, np.column_stack([places.real, places.imag]))
    shares = middle * seen(camera, np.stack([carried.real, carried.imag], axis=-1)).mean(axis=1)
    most = max(shares)
    if isinstance(region, NoRegion):
        assert region.reason == "the region lies outside the image"
        assert most < least_share + 0.08  # 49 points give a share to so much
        return
    assert most > least_share - 0.08
    reached = shares[min(round(region.distance_ahead_m / 0.02), len(shares) - 1)]
    assert reached > max(least_share, most - (1 - least_share) / 3) - 0.12
    low, high = box_round_footprint(region.pose_ahead, 0.72, 0.6)
    shown = region.rectangle
    assert (shown.x_min, shown.y_min) >= tuple(low - 1e-9)
    assert shown.x_max <= high[0] + 1e-9
    assert shown.y_max <= high[1] + 1e-9
    assert pixels_outside(camera, shown) < 1e-6


def test_the_place_is_the_middle_of_what_is_labelled():
    """At the time given the near half is outside the image: the label belongs to the far half."""
    forward = np.array([1.0, 0.0, 0.0])
    whole = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig())
    np.testing.assert_allclose(whole.place, whole.pose_ahead[:2], atol=1e-12)
    nearer = RegionConfig(ahead_s=whole.ahead_s - 0.2)
    part = predict_region(ROBOT, AHEAD, forward, 1.0, nearer)
    assert part.rectangle.x_max == pytest.approx(whole.rectangle.x_max - 0.2)
    assert part.rectangle.x_min >= whole.rectangle.x_min - 0.05
    assert part.place[0] > part.pose_ahead[0] + 0.05


def test_the_region_is_the_first_that_can_be_classified():
    """A stand-in that can read no region nearer than 1.5 m."""
    forward = np.array([1.0, 0.0, 0.0])

    def scale_mismatch(rectangle):
        return "too near" if rectangle.x_min < 1.5 else ""

    region = predict_region(
        ROBOT, AHEAD, forward, 1.0, RegionConfig(), scale_mismatch=scale_mismatch
    )
    assert 1.5 <= region.rectangle.x_min < 1.9
    never = predict_region(
        ROBOT, AHEAD, forward, 1.0, RegionConfig(), scale_mismatch=lambda _: "no"
    )
    assert never == NoRegion("no")
    of_left_tread = predict_region(
        ROBOT,
        AHEAD,
        forward,
        1.0,
        RegionConfig(per_tread=True),
        scale_mismatch=lambda part: "left" if part.y_max > 0.15 else "right",
    )
    assert of_left_tread == NoRegion("left")


def test_coarse_ground_is_as_good_as_out_of_sight():
    """0.9 m above the ground and with 300 px, 0.013 m a pixel is some 2 m away."""
    forward = np.array([1.0, 0.0, 0.0])
    fine = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(ahead_s=2.0), coarsest_m=0.013)
    whole = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(ahead_s=2.0))
    assert fine.rectangle.x_min == whole.rectangle.x_min
    assert 1.8 < fine.rectangle.x_max < whole.rectangle.x_max
    none = predict_region(ROBOT, AHEAD, forward, 1.0, RegionConfig(), coarsest_m=0.001)
    assert none == NoRegion("the image is too coarse there")


@settings(max_examples=50)
@given(
    k1=st.floats(-0.35, 0.3),
    k2=st.floats(-0.05, 0.1),
    focal=st.floats(150.0, 400.0),
    pitch=st.floats(0.5, 1.2),
    camera_yaw=st.floats(-0.2, 0.2),
    omega=st.floats(-0.4, 0.4),
)
def test_the_whole_region_lies_in_the_image_of_a_curved_lens(
    *, k1, k2, focal, pitch, camera_yaw, omega
):
    """Sides bulge: the corners alone may lie in the image and the side between them not."""
    matrix = [[focal, 0, 320.0], [0, focal, 240.0], [0, 0, 1]]
    mount = [0.3, 0.0, 0.8, 0.0, pitch, camera_yaw]
    camera = Camera.from_mount((640, 480), matrix, [k1, k2, 0.001, -0.001], mount)
    region = predict_region(ROBOT, camera, np.array([1.0, 0.0, omega]), 1.0, RegionConfig())
    assume(isinstance(region, Region))
    assert pixels_outside(camera, region.rectangle) < 0.5  # the area of a pixel reaches that far


@settings(max_examples=25)
@given(
    omega=st.floats(-1.5, 1.5),
    camera_yaw=st.floats(-0.4, 0.4),
    per_tread=st.booleans(),
    least_share=st.sampled_from([0.4, 1.0]),
    coarsest_m=st.sampled_from([0.004, 0.01, np.inf]),
)
def test_places_are_tried_in_the_order_of_the_shares_of_all(
    omega, camera_yaw, per_tread, least_share, coarsest_m
):
    """The first is found without looking at the others: the order is that of looking at all."""
    config = RegionConfig(per_tread=per_tread, least_share=least_share)
    mount = [*MOUNT[:5], camera_yaw]
    camera = Camera.from_mount((640, 480), MATRIX, [-0.1, 0.02, 0.001, 0.0], mount)
    poses = se2.exp(np.array([0.8, 0.0, omega]) * np.linspace(0.0, 5.0, 60)[:, None])
    parts = footprint_parts(ROBOT, config.footprint_scale, per_tread=per_tread)
    shares = visible_shares(camera, poses, parts, coarsest_m)
    expected = []
    for share in np.linspace(1.0, least_share, region_file.GRADES):
        places = np.flatnonzero(shares >= share - 1e-9)
        expected.extend(places[:: max(1, -(-len(places) // region_file.TRIES))])
    found = region_file._places(camera, poses, parts, coarsest_m, least_share)
    assert list(found) == expected
