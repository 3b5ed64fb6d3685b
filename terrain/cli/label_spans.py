"""Spans of time and their terrains, as they stand on the command line."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from terrain.labelling.given_terrain import TerrainSpan

FORM = "[RUN:]FROM:TO=TERRAIN, such as 0:20.5=grass, or my_run:0:20.5=grass with several runs"


def spans_by_run(texts: Sequence[str], runs: Sequence[Path]) -> "dict[Path, list[TerrainSpan]]":
    """Spans of each run, from texts such as `0:20=grass` or `my_run:0:20=grass`.

    Raises
    ------
    click.BadParameter
        If a text is not of this form, does not say of which run it is, or a run has no span while
        others have.
    """
    found: dict[Path, list[TerrainSpan]] = {run: [] for run in runs}
    for text in texts:
        run, span = _parsed(text, runs)
        found[run].append(span)
    lacking = [str(run) for run, spans in found.items() if not spans]
    if texts and lacking:
        raise _bad(f"the run {lacking[0]} has no span")
    return found


def _parsed(text: str, runs: Sequence[Path]) -> "tuple[Path, TerrainSpan]":
    from terrain.labelling.given_terrain import TerrainSpan

    times, sign, terrain = text.partition("=")
    *name, begin, end = ["", *times.rsplit(":", 2)][-3:]
    try:
        from_s, to_s = float(begin), float(end)
    except ValueError:
        raise _bad(f"{text!r}, expected {FORM}") from None
    if not sign or not terrain.strip() or terrain.strip() == "unknown":
        raise _bad(f"{text!r}, expected {FORM}")
    if not (math.isfinite(to_s) and 0 <= from_s < to_s):
        raise _bad(f"{text!r}: expected a start of 0 or more, and an end after it")
    return _run_named(name[0], text, runs), TerrainSpan(from_s, to_s, terrain.strip())


def _run_named(name: str, text: str, runs: Sequence[Path]) -> Path:
    if not name and len(runs) == 1:
        return runs[0]
    meant = [run for run in runs if name in (str(run), run.resolve().name)]
    if len(meant) != 1:
        raise _bad(f"{text!r}: there are {len(runs)} runs; begin with the name of one of them")
    return meant[0]


def _bad(message: str) -> click.BadParameter:
    return click.BadParameter(message, param_hint="--span")
