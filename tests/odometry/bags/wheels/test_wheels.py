"""Tread speeds from wheels in any order, sign, gear, unit and message."""

import numpy as np
import pytest

from odometry.bags.topics.topic_roles import TopicMap
from odometry.errors import BagError
from tests.odometry.bags.imports import imported
from tests.odometry.bags.made_bags import RADIUS_M, TRACK_M, Bag, course, half_turn

COURSE = np.array(list(course(8.0)))
LEFT, RIGHT = COURSE[:, 1] / RADIUS_M, COURSE[:, 2] / RADIUS_M  # rad/s


def bag_of(messages, kind="mcap", **define):
    """A bag of wheel messages alone: `messages(bag, t, left, right)` adds one."""
    bag = Bag(kind)
    for name, text in define.items():
        bag.define(name.replace("__", "/"), text)
    for (t_s, *_), left, right in zip(COURSE, LEFT, RIGHT, strict=True):
        messages(bag, float(t_s), float(left), float(right))
    return bag


def speeds(bag, tmp_path, **options):
    run, said = imported(tmp_path / "run", bag.write(tmp_path / "drive"), **options)
    return run.odometry.stack("v_left", "v_right"), said


def true(rows=slice(None)):
    return pytest.approx(COURSE[rows, 1:3], abs=1e-7)


@pytest.mark.parametrize(
    "names",
    [
        ["wheel_fl", "wheel_fr", "wheel_rl", "wheel_rr"],
        ["lf_wheel", "rf_wheel", "lr_wheel", "rr_wheel"],
        ["robot1/front_left_wheel_joint", "robot1/front_right_wheel_joint"],
        ["LeftTrack", "RightTrack"],
        ["l_wheel", "r_wheel"],
    ],
)
@pytest.mark.parametrize("order", ["as named", "reversed"])
def test_wheels_are_known_by_their_names_in_any_order(names, order, tmp_path):
    sides = dict.fromkeys(names)
    for place, name in enumerate(names):
        sides[name] = place % 2
    arm = ["arm_left_elbow", *names, "gripper_right"]
    shown = arm if order == "as named" else arm[::-1]

    def message(bag, t, left, right):
        values = [(left, right)[sides[name]] if name in sides else 9.0 for name in shown]
        bag.joints(t, shown, np.zeros(len(shown)), values, topic="/ns/joint_states")

    assert speeds(bag_of(message), tmp_path)[0] == true()


def test_wheels_are_found_where_an_arm_has_its_own_messages_on_the_topic(tmp_path):
    def message(bag, t, left, right):
        bag.joints(t, ["elbow", "wrist"], np.zeros(2), np.ones(2))
        bag.joints(t + 0.001, ["left_wheel", "right_wheel"], np.zeros(2), [left, right])

    found, said = speeds(bag_of(message), tmp_path)
    assert found == true()
    assert said.losses == ("/joint_states: 160 messages dropped: a message without wheels",)


def test_a_side_is_the_mean_of_its_wheels(tmp_path):
    names = ["front_left_wheel", "rear_left_wheel", "front_right_wheel", "rear_right_wheel"]

    def message(bag, t, left, right):
        bag.joints(t, names, np.zeros(4), [left + 1, left - 1, right - 3, right + 3])

    assert speeds(bag_of(message), tmp_path)[0] == true()


def test_a_wheel_is_not_on_both_sides(tmp_path):
    def message(bag, t, left, right):
        bag.joints(t, ["motor_a", "motor_b"], np.zeros(2), [left, right])

    sides = {"wheels__left": ["motor_a"], "wheels__right": ["motor_a", "motor_b"]}
    with pytest.raises(BagError, match="motor_a is said to be left and right"):
        speeds(bag_of(message), tmp_path, wheels__topic="/joint_states", **sides)


def test_signs_gear_and_unit_are_given(tmp_path):
    def message(bag, t, left, right):
        rpm = 30 * 60 / (2 * np.pi)
        bag.joints(t, ["motor_a", "motor_b"], np.zeros(2), [-left * rpm, right * rpm])

    options = {
        "wheels__left": ["motor_a"],
        "wheels__right": ["motor_b"],
        "wheels__left_sign": -1.0,
        "wheels__gear": 30.0,
        "wheels__unit": "rpm",
        "wheels__topic": "/joint_states",
    }
    assert speeds(bag_of(message), tmp_path, **options)[0] == true()


def angles():
    """Angles of the wheels whose differences are the speeds of the course."""
    step_s = COURSE[1, 0] - COURSE[0, 0]
    return np.concatenate([[[0, 0]], np.cumsum(np.column_stack([LEFT, RIGHT]) * step_s, axis=0)])


@pytest.mark.parametrize("velocity", ["absent", "zero"])
@pytest.mark.parametrize("wrapped", [False, True])
def test_positions_are_differenced_where_velocities_are_not_measured(velocity, wrapped, tmp_path):
    turned = iter((angles() + np.pi) % (2 * np.pi) - np.pi if wrapped else angles())

    def message(bag, t, _left, _right):
        moved = np.zeros(0) if velocity == "absent" else np.zeros(2)
        bag.joints(t, ["left_wheel", "right_wheel"], next(turned), moved)

    found, said = speeds(bag_of(message), tmp_path)
    assert found == true(slice(None, -1))
    assert any("differences of places" in note for note in said.notes)


@pytest.mark.parametrize("kind", ["ros1", "sqlite3", "mcap"])
def test_a_type_of_the_bag_itself_is_read_by_its_definition(kind, tmp_path):
    inner, outer = "my_robot/msg/Drive", "my_robot/msg/Feedback"

    def message(bag, t, left, right):
        drives = [bag.message(inner, measured=one, current=3.0) for one in (left, right)]
        made = bag.message(outer, header=bag.header(t), drives=drives)
        bag.add("/feedback", outer, t, made)

    types = {
        "my_robot__msg__Drive": "float64 measured\nfloat32 current\n",
        "my_robot__msg__Feedback": "std_msgs/Header header\nmy_robot/Drive[] drives\n",
    }
    options = {
        "wheels__topic": "/feedback",
        "wheels__left": ["drives[0].measured"],
        "wheels__right": ["drives[1].measured"],
        "wheels__unit": "rad/s",
    }
    bag = bag_of(message, kind, **types)
    path = bag.write(tmp_path / ("drive.bag" if kind == "ros1" else "drive"))
    run, _ = imported(tmp_path / "run", path, **options)
    assert run.odometry.stack("v_left", "v_right") == true()


def test_fields_of_a_type_are_known_by_their_names(tmp_path):
    name = "my_robot/msg/WheelSpeeds"

    def message(bag, t, left, right):
        made = bag.message(name, left_rpm=left * 60 / 2 / np.pi, right_rpm=right * 60 / 2 / np.pi)
        bag.add("/wheel_speeds", name, t, made)

    types = {"my_robot__msg__WheelSpeeds": "float64 right_rpm\nfloat64 left_rpm\n"}
    assert speeds(bag_of(message, **types), tmp_path)[0] == true()


def arrays(order):
    def message(bag, t, left, right):
        layout = bag.message("std_msgs/msg/MultiArrayLayout", dim=[], data_offset=0)
        data = np.array([(left, right)[side] * RADIUS_M for side in order])
        made = bag.message("std_msgs/msg/Float64MultiArray", layout=layout, data=data)
        bag.add("/wheel_speeds", "std_msgs/msg/Float64MultiArray", t, made)

    return message


def test_places_of_an_array_are_given(tmp_path):
    options = {"wheels__left": [1, "3"], "wheels__right": ["0", 2], "wheels__unit": "m/s"}
    options["wheels__topic"] = "/wheel_speeds"
    assert speeds(bag_of(arrays([1, 0, 1, 0])), tmp_path, **options)[0] == true()


def test_an_array_of_no_known_unit_stops_the_import(tmp_path):
    with pytest.raises(BagError, match="unit of its wheel speeds is not known: add --unit"):
        speeds(bag_of(arrays([0, 1])), tmp_path)


def test_four_numbers_of_no_known_order_stop_the_import(tmp_path):
    with pytest.raises(BagError, match="which are the wheels of the left"):
        speeds(bag_of(arrays([0, 1, 0, 1])), tmp_path, wheels__topic="/wheel_speeds")


def test_odometry_is_parted_into_tread_speeds(tmp_path):
    def message(bag, t, left, right):
        ahead, turn = (left + right) / 2 * RADIUS_M, (right - left) * RADIUS_M / TRACK_M
        bag.odometry("/odom", t, bag.pose((0, 0, 0), half_turn(0)), bag.twist(ahead, turn))

    assert speeds(bag_of(message), tmp_path)[0] == true()


def test_odometry_without_a_twist_is_differenced(tmp_path):
    poses = {round(t * 20): (x, y, yaw) for t, _, _, x, y, yaw in COURSE}

    def message(bag, t, _left, _right):
        x, y, yaw = poses[round(t * 20)]
        bag.odometry("/odom", t, bag.pose((x, y, 0), half_turn(yaw)), bag.twist(0, 0))

    assert speeds(bag_of(message), tmp_path)[0] == true(slice(None, -1))


def test_the_separation_of_the_odometry_may_differ_from_the_track_width(tmp_path):
    def message(bag, t, left, right):
        ahead, turn = (left + right) / 2 * RADIUS_M, (right - left) * RADIUS_M / 1.1
        twist = bag.message(
            "geometry_msgs/msg/TwistStamped", header=bag.header(t), twist=bag.twist(ahead, turn)
        )
        bag.add("/wheel_odom/twist", "geometry_msgs/msg/TwistStamped", t, twist)

    assert speeds(bag_of(message), tmp_path, wheels__separation=1.1)[0] == true()


def test_commands_are_never_taken_as_measured_speeds(tmp_path):
    def message(bag, t, left, right):
        twist = bag.message(
            "geometry_msgs/msg/TwistStamped", header=bag.header(t), twist=bag.twist(left, right)
        )
        bag.add("/cmd_vel", "geometry_msgs/msg/TwistStamped", t, twist)

    with pytest.raises(BagError, match=r"hold measured wheel speeds.*a command"):
        speeds(bag_of(message), tmp_path)


@pytest.mark.parametrize(
    ("unsaid", "words"),
    [("robot.wheel_radius", "--wheel-radius METRES"), ("robot.track_width", "--track-width")],
)
def test_a_size_that_is_not_known_is_requested(unsaid, words, tmp_path):
    def message(bag, t, left, right):
        bag.joints(t, ["left_wheel", "right_wheel"], np.zeros(2), [left, right])

    path = bag_of(message).write(tmp_path / "drive")
    other = {"robot.wheel_radius": 0.15, "robot.track_width": 0.6}
    del other[unsaid]
    topic_map = TopicMap().overridden(other)
    with pytest.raises(BagError, match=f"{words}.*[Tt]o measure it"):
        imported(tmp_path / "run", path, topic_map=topic_map, unsized=True)
