"""The first page of the site of public names: what the project is, and where to begin."""

import importlib
import inspect
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from terrain.cli.main import VERBS
from tests.public_names import PUBLIC

README = Path(__file__).parents[1] / "README.md"
PICTURE = "notebooks/pictures/first_page.jpg"
COMMANDS = "command_line.html"
GUIDES = (
    "The guides stand in the repository: `terrain/README.md` to the commands and to Python, "
    "`odometry/README.md` to models, filter and methods, `data/README.md` to files and symbols.\n"
)
TASKS = {  # by public names
    "odometry of a recorded run, terrain from its images": ("terrain.run_odometry",),
    "a classifier from labelled patches": ("terrain.train", "terrain.TerrainClassifier"),
    "frame by frame, as in a node of ROS": ("terrain.LiveOdometry", "odometry.LiveFrames"),
    "a recording, and the messages of a bag": ("odometry.Run", "odometry.bag_messages"),
    "what is odd about a recording": ("odometry.check_recording", "terrain.check_run"),
    "parameters of a kinematic model": ("odometry.identify", "odometry.model_named"),
    "errors of several models, held out": ("odometry.compare",),
    "the filter of centres of rotation (ICRs)": ("odometry.IcrEkf",),
    "features of texture (SFTA)": ("terrain.SftaFeatures", "terrain.texture.sfta"),
    "which effect a model lacks": ("odometry.find_gap", "odometry.gap.write_gap"),
    "which terrain the motion speaks for": ("odometry.follow_modes",),
    "trajectories of other programs, and errors": ("odometry.read_trajectory", "odometry.score"),
}


@dataclass(frozen=True)
class FirstPage:
    """What the template shows.

    Attributes
    ----------
    text : str
        Markdown.
    places : dict
        Pages by name.
    """

    text: str
    places: dict[str, str]


def first_page() -> FirstPage:
    """The first words and commands of README.md, and tables of all that the site has."""
    places = {module: page_of(module) for module in PUBLIC} | {"command line": COMMANDS}
    parts = (
        beginning(),
        "## Where to begin\n",
        table(("you want", "names"), ((task, links(names)) for task, names in TASKS.items())),
        GUIDES,
        "## Packages\n",
        table(
            ("package", "what is in it"),
            ((f"[`{module}`]({page_of(module)})", described(module)) for module in PUBLIC),
        ),
        f"## Commands\n\nEach has `--help`; all of them on [one page]({COMMANDS}).\n",
        table(
            ("command", "what it does"),
            ((f"[`{verb}`]({COMMANDS}#{verb})", does) for verb, does in VERBS.items()),
        ),
    )
    return FirstPage("\n".join(parts), places)


def beginning() -> str:
    """README.md up to its first section, and the commands there; files of links in brackets."""
    text = README.read_text(encoding="utf-8")
    opening, _, rest = text.partition("\n## Two commands\n")
    commands = rest[: rest.index("```\n", rest.index("```bash") + 1) + 4]
    begun = opening.replace(PICTURE, Path(PICTURE).name) + commands
    return re.sub(r"\[([^]]+)\]\(([\w/]+\.md)[^)]*\)", r"\1 (\2)", begun)


def page_of(module: str) -> str:
    return f"{module.replace('.', '/')}.html"


def links(names: tuple[str, ...]) -> str:
    """Names as links to their places."""
    split = [name.rpartition(".") for name in names]
    return ", ".join(f"[`{owner}.{name}`]({page_of(owner)}#{name})" for owner, _, name in split)


def described(module: str) -> str:
    return (inspect.getdoc(importlib.import_module(module)) or "").partition("\n")[0]


def table(header: tuple[str, str], rows: Iterable[tuple[str, str]]) -> str:
    lines = [f"| {first} | {second} |" for first, second in (header, ("---", "---"), *rows)]
    return "\n".join(lines) + "\n"
