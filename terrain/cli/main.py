"""Entry point: finds the verb, and turns known errors into a message and an exit code."""

import importlib
import signal
import sys
from difflib import get_close_matches
from keyword import iskeyword
from types import FrameType
from typing import TYPE_CHECKING

import click

from odometry.errors import OdometryError, RunFolderError

if TYPE_CHECKING:
    from pathlib import Path

VERBS = {
    "import": "Make a run folder from bags of ROS 1 or ROS 2.",
    "check": "What is odd about recordings, before anything is fitted to them.",
    "camera": "The terrain in the camera's image; calibrate its lens and mount.",
    "label": "Cut labelled patches from recordings.",
    "train": "Train a terrain classifier on labelled patches.",
    "classify": "Name the terrain of images.",
    "run": "Replay a run: the main job.",
    "batch": "Replay many runs, on the cores of one machine or of many.",
    "evaluate": "Show the errors of finished runs side by side.",
    "synthesise": "Make a run folder with images, its patches and parameters.",
    "simulate": "Make a run folder from a simulated skid-steer robot.",
    "identify": "Parameters of a kinematic model from recorded runs.",
    "compare": "Held-out errors of several models, side by side.",
    "gap": "Which effect a model lacks, and the gap closed.",
    "identify-modes": "Models of terrains or of slipping wheels, to be recognised by the motion.",
    "modes": "Which terrain, or which slipping wheels, the motion supports.",
    "identify-feel": "How terrains feel: vibration, currents and yaw response.",
    "feel": "Which terrain a run feels like.",
    "export": "Results in the formats of other programs: ROS, MCAP, maps, trajectories.",
    "demo": "Train, run and report on the shipped data.",
}


class LazyGroup(click.Group):
    """Imports the file of a verb only when that verb is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Verbs in the order in which one uses them."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002
        """The verb's command, None where there is no such verb."""
        if cmd_name not in VERBS:
            return None
        name = cmd_name.replace("-", "_")
        name += "_" if iskeyword(name) else ""
        module = importlib.import_module(f"terrain.cli.verbs.{name}")
        command: click.Command = getattr(module, name)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The verb that is meant; the nearest ones are named where there is no such verb."""
        if args[0] not in VERBS:
            ctx.fail(f"No such command {args[0]!r}. {_meant(args[0])}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """List the verbs without importing them."""
        with formatter.section("Verbs"):
            formatter.write_dl(list(VERBS.items()))


def _meant(word: str) -> str:
    """The verbs that someone may mean who writes `word`; all where none is near."""
    plain = word.lower().replace("_", "-")
    begun = [verb for verb in VERBS if plain and (verb.startswith(plain) or plain.startswith(verb))]
    near = [plain] if plain in VERBS else [*get_close_matches(plain, VERBS, n=2), *begun]
    if not near:
        return f"Verbs: {', '.join(VERBS)}"
    return f"Did you mean {' or '.join(map(repr, dict.fromkeys(near)))}?"


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="terrain-odometry")
def cli() -> None:
    """Terrain-aware odometry for skid-steer robots.

    \b
    Example:
      terrain-odometry demo --out demo
    """


def main() -> None:
    """Run the command line.

    A known error prints one message and exits with 1; so does an interrupt, with 130, or 143 for
    a request to terminate.
    """
    raise_on_signals(signal.SIGINT, signal.SIGTERM)
    _written().clear()  # of an earlier call in this process
    try:
        cli()
    except Interrupted as error:
        click.echo(f"{error}: {error.left}", err=True)
        sys.exit(error.exit_code)
    except RunFolderError as error:
        click.echo(f"Error: {'. '.join([str(error), *_likely_cause(error)])}", err=True)
        sys.exit(1)
    except (OdometryError, OSError) as error:
        click.echo(f"Error: {error}", err=True)
        sys.exit(1)
    except MemoryError as error:
        click.echo(f"Error: there is not enough memory for this input: {error}", err=True)
        sys.exit(1)


def _likely_cause(error: RunFolderError) -> tuple[str, ...]:
    """Why a run folder cannot be read and what to do, as `check` says it; nothing if unclear."""
    from odometry.checks.findings.unreadable import likely_cause

    return likely_cause(error) or ()


def _written() -> "list[Path]":
    """What commands have written to its end; nothing where their module was never loaded."""
    outputs = sys.modules.get("terrain.cli.outputs")
    return [] if outputs is None else outputs.WHOLE


class Interrupted(BaseException):
    """The user, or the system, stopped the command.

    It is no `KeyboardInterrupt`, which click turns into an exit code of its own.
    """

    def __init__(self, number: int) -> None:
        super().__init__("Interrupted" if number == signal.SIGINT else "Terminated")
        self.exit_code = 128 + number

    @property
    def left(self) -> str:
        """What was written, by those who were writing and those who had written."""
        whole = dict.fromkeys(_written())
        said = [f"{out} was written and is whole; only what follows it is missing" for out in whole]
        return "; ".join([*getattr(self, "__notes__", []), *said]) or "nothing was written"


def raise_on_signals(*numbers: signal.Signals) -> None:
    """Raise `Interrupted` at the first of these signals; a second one ends the process at once.

    A signal that is ignored, as after `nohup`, stays ignored.
    """

    def stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the signal's own
        for one in numbers:
            signal.signal(one, signal.SIG_DFL)
        raise Interrupted(number)

    for one in numbers:
        if signal.getsignal(one) != signal.SIG_IGN:
            signal.signal(one, stop)
