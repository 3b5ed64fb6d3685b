"""How the commands read run folders: the one place through which every recording comes."""

import math
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from odometry.run import Run
    from odometry.run_span import Span


def span_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --from and --to, which cut every run that is read; the command gets them as `span`."""

    @click.option(
        "--from",
        "from_s",
        type=click.FloatRange(min=0),
        default=0.0,
        metavar="SECONDS",
        help="Leave out what each run holds before, from its first stamp.  [default: its start]",
    )
    @click.option(
        "--to",
        "to_s",
        type=click.FloatRange(min=0, min_open=True),
        default=math.inf,
        metavar="SECONDS",
        help="Leave out what each run holds after.  [default: its end]",
    )
    @wraps(command)
    def with_span(*, from_s: float, to_s: float, **others: Any) -> None:
        from odometry.run_span import Span

        command(span=Span(from_s, to_s), **others)

    return with_span


def read_runs(folders: Sequence[Path], span: "Span") -> "list[Run]":
    """Read run folders in their order, each cut to the span.

    Raises
    ------
    RunFolderError
        If a folder is not as the format says, or nothing of it lies in the span.
    """
    return [read_run(folder, span) for folder in folders]


def read_run(folder: Path, span: "Span") -> "Run":
    """Read one run folder, cut to the span."""
    from odometry.run import Run
    from odometry.run_span import cut_run

    return cut_run(Run.read(folder), span)
