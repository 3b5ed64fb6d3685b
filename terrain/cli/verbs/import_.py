"""`terrain-odometry import`: a run folder from bags."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import OUTPUT, Positive
from terrain.cli.verbs.import_poses import (
    PoseFiles,
    add_to_run,
    pose_options,
    without_reference,
    write_poses,
)

if TYPE_CHECKING:
    from odometry.bags.files.message_types import MessageTypes
    from odometry.bags.import_bags import Imported
    from odometry.bags.topics.survey import Survey
    from odometry.bags.topics.topic_roles import TopicMap

LARGEST_M = 1000.0
OF_RUNS = ("run.toml", "odometry.csv")
# Options that override a key of the map, and the key
KEYS = {
    "wheels": "wheels.topic",
    "left": "wheels.left",
    "right": "wheels.right",
    "left_sign": "wheels.left_sign",
    "right_sign": "wheels.right_sign",
    "gear": "wheels.gear",
    "unit": "wheels.unit",
    "wheel_radius": "robot.wheel_radius",
    "track_width": "robot.track_width",
    "frame": "robot.frame",
    "frame_height": "robot.frame_height",
    "imu": "imu.topic",
    "reference": "reference.topic",
    "images": "images.topic",
    "camera_info": "images.camera_info",
    "time": "time",
}


@click.command(name="import")
@click.argument("bags", metavar="BAG...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--out",
    metavar="RUN",
    type=OUTPUT,
    help="Run folder to make: missing, empty, or made by an earlier `import`.",
)
@click.option("--list", "as_list", is_flag=True, help="Only list the topics and what is guessed.")
@click.option(
    "--map",
    "map_file",
    metavar="FILE.toml",
    type=click.Path(path_type=Path),
    help="What is taken from which topic; options override it.",
)
@click.option("--wheels", metavar="TOPIC", help="Measured wheel speeds.")
@click.option("--left", metavar="NAMES", help="Left wheels, by commas: joints, places or paths.")
@click.option("--right", metavar="NAMES", help="Right wheels.")
@click.option("--left-sign", type=click.Choice(["1", "-1"]), help="-1: they count backwards.")
@click.option("--right-sign", type=click.Choice(["1", "-1"]), help="-1: they count backwards.")
@click.option("--gear", type=Positive(1e6), help="Turns that are counted for one turn of a wheel.")
@click.option("--unit", metavar="UNIT", help="Of the wheel speeds: rad/s, rpm, m/s, rad, ...")
@click.option(
    "--wheel-radius",
    type=Positive(LARGEST_M),
    metavar="METRES",
    help="From the axle to the terrain, where the bag does not say.",
)
@click.option(
    "--track-width",
    type=Positive(LARGEST_M),
    metavar="METRES",
    help="Between the middles of the treads, where the bag does not say.",
)
@click.option(
    "--frame",
    metavar="FRAME",
    help="The robot's base frame.  [default: base_footprint, else base_link, ...]",
)
@click.option(
    "--frame-height", type=float, metavar="METRES", help="Height of that frame above the terrain."
)
@click.option("--imu", metavar="TOPIC|none", help="The inertial sensor.")
@click.option("--reference", metavar="TOPIC|none", help="The poses or fixes to compare with.")
@click.option("--images", metavar="TOPIC|none", help="The camera that shows the terrain.")
@click.option("--camera-info", metavar="TOPIC|none", help="The calibration of its lens.")
@click.option(
    "--time",
    type=click.Choice(["auto", "header", "log"]),
    help="Stamps of headers, or the times at which the bag received the messages.  [default: "
    "headers, where all clocks agree]",
)
@pose_options
def import_(
    *,
    bags: tuple[Path, ...],
    out: Path | None,
    as_list: bool,
    map_file: Path | None,
    poses: PoseFiles,
    **options: Any,
) -> None:
    """Make a run folder from bags of ROS 1 or ROS 2 (SQLite, MCAP); several are one recording.

    Wheel speeds come from joint states, odometry, twists or numbers of any message; what each
    topic is good for is guessed from types and names, and said. What is damaged is read as far as
    possible, and what was lost is said. With --pose or --truth BAG may be a run folder: a
    trajectory of another program is added to it.

    \b
    Example:
      terrain-odometry import drive.bag --list
      terrain-odometry import drive.bag --out my_run
      terrain-odometry import rosbag2_folder --map my_robot_bags.toml --out my_run
      terrain-odometry import my_run --pose slam.tum
    """
    if poses.files and any((bag / name).exists() for bag in bags for name in OF_RUNS):
        _check(add_to_run(bags, out, poses))
        return
    if out is None and not as_list:
        raise click.UsageError("--out RUN is missing (or --list, to list the topics first)")
    _require_extra()
    if as_list or out is None:
        _list(bags)
        return
    from odometry.bags.topics.topic_roles import TopicMap, read_topic_map
    from terrain.cli.outputs import claim_folder

    topic_map = read_topic_map(map_file) if map_file is not None else TopicMap()
    options = without_reference(options, poses)
    topic_map = topic_map.overridden(
        {KEYS[name]: _value(name, said) for name, said in options.items()}
    )
    output = claim_folder(out)
    with output.writing() as part:
        imported = _write(bags, topic_map, part)
        added = write_poses(part, poses)
    _print_imported(out, imported)
    for line in added:
        click.echo(line)
    _check(out)


def _require_extra() -> None:
    """Raise a message where the packages that read bags are not installed."""
    from importlib.util import find_spec

    from odometry.errors import OdometryError

    missing = [name for name in ("rosbags", "pymap3d") if find_spec(name) is None]
    if missing:
        raise OdometryError(
            f"reading bags needs {' and '.join(missing)}: pip install 'terrain-odometry[bags]'"
        )


def _value(name: str, said: Any) -> Any:
    """The value of an option as a map has it; None where it is not given."""
    if said is None or name not in ("left", "right", "left_sign", "right_sign"):
        return said
    return float(said) if name.endswith("sign") else [one.strip() for one in said.split(",")]


def _list(bags: tuple[Path, ...]) -> None:
    from odometry.bags.files.message_types import MessageTypes
    from odometry.bags.plan import make_plan
    from odometry.bags.topics.message_fields import NO_WHEELS
    from odometry.bags.topics.topic_guess import best
    from odometry.bags.topics.topic_list import topic_lines
    from odometry.bags.topics.topic_roles import TopicMap
    from odometry.bags.wheels.wheel_choice import NO_SPEEDS
    from odometry.errors import BagError

    found = _surveyed(bags, MessageTypes())
    for line in topic_lines(found):
        click.echo(line)
    for loss in found.losses:
        click.echo(f"Lost: {loss}", err=True)
    if all(topic.message_type in NO_WHEELS for topic in found.topics.values()):
        click.echo(f"Note: {NO_SPEEDS}")
        return
    missing = ""
    try:
        make_plan(found, TopicMap())
    except BagError as problem:
        click.echo(f"Note: {problem}")
        missing = "".join(f" {option}" for option in problem.options)
    named = " ".join(shlex.quote(str(bag)) for bag in bags)
    wheels = "" if best(found.topics, "wheels") else " --wheels TOPIC"
    out = shlex.quote(_run_name(bags[0]))
    click.echo(f"Next: terrain-odometry import {named} --out {out}{wheels}{missing}")


def _run_name(bag: Path) -> str:
    return f"{bag.resolve().name.split('.')[0]}_run"


def _surveyed(bags: tuple[Path, ...], types: "MessageTypes") -> "Survey":
    from tqdm import tqdm

    from odometry.bags.files.bag_files import bag_files
    from odometry.bags.files.damage import Losses
    from odometry.bags.topics.survey import survey

    losses = Losses()
    files = bag_files(bags, losses)
    with tqdm(desc="look", unit=" messages", leave=False, disable=None) as bar:
        return survey(files, types, losses, bar.update)


def _write(bags: tuple[Path, ...], topic_map: "TopicMap", folder: Path) -> "Imported":
    from tqdm import tqdm

    from odometry.bags.files.message_types import MessageTypes
    from odometry.bags.import_bags import write_run
    from odometry.bags.plan import make_plan

    types = MessageTypes()
    found = _surveyed(bags, types)
    plan = make_plan(found, topic_map)
    with tqdm(desc="import", total=found.count, unit=" messages", leave=False, disable=None) as bar:
        return write_run(found, plan, types, folder, bar.update)


def _print_imported(out: Path, imported: "Imported") -> None:
    click.echo(f"Wrote the run {out}:")
    for file, (rows, topic) in imported.rows.items():
        click.echo(f"  {file}: {rows} rows from {topic}")
    for note in imported.notes:
        click.echo(f"  {note}")
    for loss in imported.losses:
        click.echo(f"Lost: {loss}", err=True)


def _check(out: Path) -> None:
    """Check the run folder, and say what to do next."""
    from terrain.checks.recording import check_run
    from terrain.cli.verbs.check import next_step, print_findings

    report = check_run(out)
    print_findings(out, report)
    click.echo(next_step({out: report}, {}))
