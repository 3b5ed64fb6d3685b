from dataclasses import replace

from odometry.bags.files.message_types import MessageTypes
from odometry.bags.files.topic import Connection


def test_a_type_is_compiled_once_for_all_bags():
    first, second = (Connection(topic, "std_msgs/msg/Float64", "cdr") for topic in ("/a", "/b"))
    readers = [MessageTypes()._reader(connection) for connection in (first, second)]
    assert readers[0] is readers[1]
    own = replace(second, definition="int8 data")
    assert MessageTypes()._reader(own) is not readers[0]


def test_a_type_without_a_definition_is_refused_with_its_topic():
    unknown = Connection("/wheels", "robot_msgs/msg/Wheels", "cdr")
    problem = MessageTypes().problem(unknown)
    assert problem.startswith("/wheels: the bag has no definition of robot_msgs/msg/Wheels, and ")
