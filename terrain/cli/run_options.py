"""The options of a replay, which `run` and `batch` share."""

import sys
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.recordings import span_options

if TYPE_CHECKING:
    from odometry.run_span import Span

SOURCES = ("camera", "labels", "modes", "feel", "none")
PRESETS = ("chen2023",)
FILE = click.Path(exists=True, dir_okay=False, path_type=Path)


def run_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of a replay; the command gets them as `options`, a `RunOptions`."""

    @click.option("--model", type=FILE, help="Classifier made by `train`; without it, no vision.")
    @click.option("--parameters", type=FILE, help="Parameter set: ICRs by terrain (TOML).")
    @click.option("--no-vision", is_flag=True, help="Keep one terrain in force throughout.")
    @click.option(
        "--source",
        type=click.Choice(SOURCES),
        help="Source of the terrain: the images (needs --model), the run's own column `terrain`, "
        "the motion (needs --modes), what the robot feels (needs --feel), or nothing.  [default: "
        "camera with --model, else feel with --feel, else none]",
    )
    @click.option(
        "--modes", metavar="SET.toml", type=FILE, help="Set of modes made by `identify-modes`."
    )
    @click.option(
        "--feel",
        metavar="FEEL",
        type=FILE,
        help="Model made by `identify-feel`: a source of its own, or one more beside the camera.",
    )
    @click.option(
        "--preset",
        type=click.Choice(PRESETS),
        help="A published system whole; what contradicts it is an error.",
    )
    @click.option("--terrain", metavar="NAME", help="In force until the first switch.")
    @click.option("--config", type=FILE, help="Settings (TOML): [filter] [region] [switch] ...")
    @click.option("--per-tread", is_flag=True, help="Classify the terrain under each tread apart.")
    @click.option(
        "--own-statistics",
        is_flag=True,
        help="Standardise features by the images of the run as they arrive: for a camera unlike "
        "that of training which sees several terrains.",
    )
    @span_options
    @click.option(
        "--detect-jumps", is_flag=True, help="Watch the innovations for jumps of the ICRs."
    )
    @wraps(command)
    def with_options(
        *,
        model: Path | None,
        parameters: Path | None,
        no_vision: bool,
        source: str | None,
        modes: Path | None,
        feel: Path | None,
        preset: str | None,
        terrain: str | None,
        config: Path | None,
        per_tread: bool,
        own_statistics: bool,
        detect_jumps: bool,
        span: "Span",
        **others: Any,
    ) -> None:
        from dataclasses import replace

        say_that_it_begins()
        from terrain.config import ClassifierConfig, Config
        from terrain.run_options import RunOptions
        from terrain.run_presets import run_preset

        settings = run_preset(preset).config if preset else Config()
        if config:
            settings = Config.read(config, settings)
        if per_tread:
            settings = replace(settings, region=replace(settings.region, per_tread=True))
        if own_statistics:
            settings = replace(settings, classifier=ClassifierConfig(own_statistics=True))
        if detect_jumps:
            settings = replace(settings, filter=replace(settings.filter, detect_jumps=True))
        options = RunOptions(
            settings,
            model=model,
            parameters=parameters,
            modes=modes,
            feel=feel,
            vision=not no_vision,
            terrain=terrain,
            source=source,
            preset=preset,
            span=span,
        )
        command(options=options, **others)

    return with_options


def say_that_it_begins() -> None:
    """On a terminal, before the libraries are loaded: that alone takes seconds."""
    if sys.stderr.isatty():
        click.echo("Loading libraries, reading the run ...", err=True)
