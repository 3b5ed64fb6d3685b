"""Import bags in one call, without the command line."""

from odometry.bags.files.bag_files import bag_files
from odometry.bags.files.damage import Losses
from odometry.bags.files.message_types import MessageTypes
from odometry.bags.import_bags import write_run
from odometry.bags.plan import make_plan
from odometry.bags.topics.survey import survey
from odometry.bags.topics.topic_roles import TopicMap
from odometry.recording.run import Run
from tests.odometry.bags.made_bags import RADIUS_M, TRACK_M

SIZE = {"robot.wheel_radius": RADIUS_M, "robot.track_width": TRACK_M}


def looked_at(*paths):
    """Survey of bags, and the types that decode them."""
    types, losses = MessageTypes(), Losses()
    return survey(bag_files(paths, losses), types, losses, lambda _: None), types


def imported(out, *paths, topic_map=TopicMap(), **options):  # noqa: B008 - frozen
    """Import bags with the size of the robot given; the run, and what was said."""
    found, types = looked_at(*paths)
    size = {} if options.pop("unsized", False) else SIZE
    dotted = {name.replace("__", "."): value for name, value in options.items()}
    plan = make_plan(found, topic_map.overridden({**size, **dotted}))
    out.mkdir()
    said = write_run(found, plan, types, out, lambda _: None)
    return Run.read(out), said
