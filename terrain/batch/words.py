"""What is said at the end of a batch."""

from collections.abc import Iterable
from pathlib import Path

from odometry.outputs.manifest import read_manifest
from terrain.batch.batch import Batch
from terrain.batch.job import FAILED, KEPT, REPLAYED

MEGABYTE = 1e6
HOUR_S = 3600.0


def summary(batch: Batch) -> list[str]:
    """How many runs were replayed, kept and failed, and how long they took."""
    states = [outcome.state for outcome in batch.outcomes]
    replayed, kept, failed = (states.count(state) for state in (REPLAYED, KEPT, FAILED))
    said = [f"{replayed} replayed in {batch.wall_s:.0f} s"]
    said += [f"{kept} done already"] if kept else []
    said += [f"{failed} failed"] if failed else []
    return [f"{len(states)} runs: {', '.join(said)}."]


def cost(batch: Batch) -> list[str]:
    """Processor time and bytes of an hour of driving, from the runs that were replayed now."""
    replayed = [of for of in batch.outcomes if of.state == REPLAYED]
    hours = sum(
        (row.numbers["duration_s"] or 0.0) / HOUR_S
        for row, outcome in zip(batch.rows, batch.outcomes, strict=True)
        if outcome.state == REPLAYED
    )
    if not hours:
        return []
    cpu_s = sum(of.cpu_s for of in replayed)
    megabytes = sum(_bytes(of.job.out) for of in replayed) / MEGABYTE
    return [
        f"An hour of driving takes {cpu_s / hours:.0f} s of one core and {megabytes / hours:.0f} "
        f"MB of results ({hours:.2g} h were replayed)."
    ]


def not_of_these(out: Path, names: Iterable[str]) -> list[str]:
    """Say which folders of runs are of an earlier call with other runs."""
    known = set(names)
    others = [
        folder.name
        for folder in sorted(out.iterdir())
        if folder.is_dir() and folder.name not in known and read_manifest(folder) is not None
    ]
    if not others:
        return []
    return [f"{out} also holds runs of an earlier call, which no table counts: {', '.join(others)}"]


def _bytes(folder: Path) -> int:
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
