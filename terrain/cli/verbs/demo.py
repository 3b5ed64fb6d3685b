"""`terrain-odometry demo`: train, run and report on the shipped data."""

from pathlib import Path

import click

from terrain.cli.options import OUTPUT


@click.command()
@click.option(
    "--out",
    default=Path("terrain-odometry-demo"),
    show_default=True,
    metavar="DIR",
    type=OUTPUT,
    help="Folder for the results.",
)
def demo(out: Path) -> None:
    """Train on the shipped patches, replay the shipped run, with and without vision.

    \b
    Example:
      terrain-odometry demo --out demo
    """
    from terrain.cli.outputs import about, claim_folder
    from terrain.cli.results import print_errors, print_written
    from terrain.demo import run_demo

    output = claim_folder(out)
    click.echo("Training on the shipped patches, then replaying the shipped run twice ...")
    with output.writing() as part:
        results, _ = run_demo(part, about=about(output.made), show_progress=True)
    print_errors(results)
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}")
