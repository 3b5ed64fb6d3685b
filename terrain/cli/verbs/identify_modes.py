"""`terrain-odometry identify-modes`: models of terrains or slipping wheels from recorded runs."""

import shlex
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import click

from terrain.cli.options import OUTPUT, Positive
from terrain.cli.recordings import span_options
from terrain.cli.results import print_table
from terrain.cli.run_folders import run_folders

if TYPE_CHECKING:
    from odometry.modes.models.mode_pairs import Pair
    from odometry.modes.models.traction import TractionModes
    from odometry.modes.models.velocity import VelocityModes
    from odometry.recording.run_span import Span

ALIKE_S = 5.0  # pairs that take longer to be distinguished are named
PAIRS = 4  # so many of them
SLOW_TIGHT_TURNS_M_S = ((0.05, 0.15), (0.15, 0.05))  # to the left, to the right


@click.command(name="identify-modes")
@run_folders
@click.option(
    "--out",
    required=True,
    metavar="SET.toml",
    type=OUTPUT,
    help="Set of modes to write (TOML).",
)
@click.option(
    "--kind",
    type=click.Choice(["velocity", "traction"]),
    default="velocity",
    show_default=True,
    help="Terrains, from the yaw rate; or slipping wheels, from the poses.",
)
@click.option(
    "--shared",
    is_flag=True,
    help="Velocity: one model of all modes, which differ by their noise alone.",
)
@click.option(
    "--common-noise",
    is_flag=True,
    help="Velocity: one noise for all, so that modes differ by their answer to the treads alone.",
)
@click.option("--paper", is_flag=True, help="Traction: one k and m alone, as in Salvi 2024.")
@click.option(
    "--dwell",
    type=Positive(1e6),
    default=20.0,
    show_default=True,
    help="Mean time in a mode [s].",
)
@span_options
def identify_modes(
    folders: tuple[Path, ...],
    *,
    out: Path,
    kind: str,
    shared: bool,
    common_noise: bool,
    paper: bool,
    dwell: float,
    span: "Span",
) -> None:
    """Identify the modes that the run folders RUN name, for `modes` to recognise them.

    A mode is a name of [run] terrain in run.toml or of the column terrain in odometry.csv: a
    terrain, or the wheels that slip. Every mode needs turns, traction modes to both sides.

    \b
    Example:
      terrain-odometry identify-modes grass_1 asphalt_1 --out set.toml
      terrain-odometry identify-modes none all --kind traction --out set.toml
    """
    import numpy as np

    from odometry.modes.identify.drive_turns import (
        drive_turns,
        turn_notes,
        with_unknown_turns,
    )
    from odometry.modes.identify.identify_traction import identify_traction_modes
    from odometry.modes.identify.identify_velocity import identify_velocity_modes
    from odometry.modes.models.mode_pairs import pairs
    from odometry.modes.models.mode_set import ModeSet
    from odometry.modes.models.mode_set_file import write_mode_set
    from odometry.modes.models.traction import TractionModes
    from odometry.outputs.output_file import is_set_of
    from terrain.cli.outputs import claim_file, comment
    from terrain.cli.recordings import read_runs, with_turns, with_yaw_rates

    for given, option in ((shared, "--shared"), (common_noise, "--common-noise")):
        if given and kind != "velocity":
            raise click.UsageError(f"{option} is for --kind velocity")
    if shared and common_noise:
        raise click.UsageError(
            "--shared and --common-noise together leave no difference between modes"
        )
    if paper and kind != "traction":
        raise click.UsageError("--paper is for --kind traction")
    if out.suffix != ".toml":
        raise click.UsageError(f"--out {out}: expected a name that ends in .toml")
    made = claim_file(out, is_set_of("identify-modes"))
    runs = read_runs(folders, span)
    modes: VelocityModes | TractionModes
    if kind == "velocity":
        runs = with_yaw_rates(runs)
        modes = identify_velocity_modes(
            runs, shared=shared, common_noise=common_noise, show_progress=True
        )
    else:
        runs = with_turns(runs)
        modes = identify_traction_modes(runs, paper=paper, show_progress=True)
    turns = drive_turns(runs)
    unknown = () if shared else with_unknown_turns(turns)
    if isinstance(modes, TractionModes):
        _print_traction(modes, unknown)
    else:
        _print_velocity(modes, unknown)
    if len(modes.names) == 1:
        click.echo("Note: there is one mode: `modes` needs two or more", err=True)
    _print_alike(tuple(of for of in pairs(modes, runs) if not set(of.names) & set(unknown)))
    for note in turn_notes(turns):
        click.echo(f"Note: {note}", err=True)
    said = ((shared, "shared model"), (common_noise, "common noise"), (paper, "as in Salvi 2024"))
    variant = "".join(f", {words}" for given, words in said if given)
    names = ", ".join(dict.fromkeys(run.name for run in runs))
    source = f"identify-modes of terrain-odometry{variant}: {names}"
    mode_set = ModeSet(modes, np.full(len(modes.names), dwell), source)
    write_mode_set(out, mode_set, comment(made))
    click.echo(f"Wrote {out}")
    click.echo(f"Next: terrain-odometry modes RUN --models {shlex.quote(str(out))} --out modes")


def _print_velocity(modes: "VelocityModes", unknown: Collection[str]) -> None:
    """Print what steady turns give, how fast, and what the models leave of the measurements.

    Of modes whose turns are `unknown` the last alone.
    """
    click.echo(
        "Steady yaw rate per difference of tread speeds, the effective track, the lag, steady "
        "speed per speed of both treads, and what the models leave (standard deviations):"
    )
    rows: list[tuple[str, ...]] = [
        ("mode", "rad/m", "track m", "lag s", "speed", "speed m/s", "yaw rate rad/s")
    ]
    gains, sigmas = modes.steady_gains(), modes.measurement_variance**0.5
    for name, gain, lag, sigma in zip(
        modes.names, gains, -1 / modes.A[:, 1, 1], sigmas, strict=True
    ):
        turn = (gain[1, 1] - gain[1, 0]) / 2
        response = [f"{of:.3f}" for of in (turn, 1 / turn, lag, gain[0].sum())] if turn else []
        shown = response if response and name not in unknown else ["-"] * 4
        rows.append((name, *shown, *(f"{of:.3f}" for of in sigma)))
    print_table(rows)
    click.echo(f"Errors of the models last {modes.errors_last_s:.2f} s.")


def _print_traction(modes: "TractionModes", unknown: Collection[str]) -> None:
    """Print the shares of requested speed and turn rate, and the noise.

    No shares of modes whose turns are `unknown`.
    """
    import numpy as np

    from odometry.modes.models.traction import requested, twists_of

    click.echo(
        "Share k of the requested speed, shares m of the requested turn rate in wide and in tight "
        "slow turns (tight: one tread three times as fast as the other), and the lag of turns:"
    )
    rows: list[tuple[str, ...]] = [
        ("mode", "k", "m left", "m right", "m left tight", "m right tight", "lag s")
    ]
    width = modes.track_width
    tight = [
        twists_of(modes.gains, treads, width)[:, 2] / requested(treads, width)[1]
        for treads in np.array(SLOW_TIGHT_TURNS_M_S)
    ]
    shares = np.column_stack([modes.k[:, 0], modes.m, *tight, modes.lag_s])
    rows += [
        (name, *("-" if name in unknown else f"{share:.3f}" for share in of))
        for name, of in zip(modes.names, shares, strict=True)
    ]
    print_table(rows)
    place, yaw, _ = modes.process_variance**0.5
    click.echo(
        f"Noise of all modes after a metre of wheel travel: {place:.3f} m, {yaw:.4f} rad; of "
        f"measured poses: {modes.measurement_variance[0] ** 0.5:.3f} m, "
        f"{modes.measurement_variance[2] ** 0.5:.4f} rad; of yaw rates: "
        f"{modes.measurement_variance[3] ** 0.5:.3f} rad/s. While the treads speed up by 1 m/s2 "
        f"it is {(1 + modes.variance_growth) ** 0.5:.1f} times as large."
    )


def _print_alike(found: "tuple[Pair, ...]") -> None:
    """Say which modes differ little, and how long it takes to distinguish them."""
    equal = [pair for pair in found if pair.seconds > ALIKE_S]
    for pair in equal[:PAIRS] or found[:1]:
        both = " and ".join(pair.names)
        words = "differ little" if equal else "are the most similar"
        digits = 0 if pair.seconds >= 10 else 1
        time = f"about {pair.seconds:.{digits}f} s" if pair.seconds < 1e4 else "for ever"
        time = "less than 0.1 s" if pair.seconds < 0.1 else time
        click.echo(f"{both} {words}: driven as in these runs they take {time} to be distinguished.")
    if len(equal) > PAIRS:
        click.echo(f"So do {len(equal) - PAIRS} further pairs (more than {ALIKE_S:g} s).")
