"""The tables of a result as Parquet (extra `tables`)."""

from pathlib import Path

from odometry.export.source import ExportSource
from odometry.installed import extra_module
from odometry.io.files import atomic_write

NAMES = ("odometer", "estimate", "terrain", "reference")


def write(source: ExportSource, folder: Path) -> None:
    """Write each table that the result has: its columns, an empty name missing.

    Raises
    ------
    ExtraError
        If pandas or pyarrow is not installed.
    """
    extra_module("pyarrow", "tables", "Parquet")
    for name in NAMES:
        if (source.folder / f"{name}.csv").exists():
            frame = source.table(name).to_pandas()
            with atomic_write(folder / f"{name}.parquet") as part:
                frame.to_parquet(part, engine="pyarrow", index=False)
