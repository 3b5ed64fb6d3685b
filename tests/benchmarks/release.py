"""Compare a table of ratios with that of the last release, and mark what got slower.

    pytest -n 0 --benchmark-only tests/benchmarks --ratios-out new.csv
    python -m tests.benchmarks.release new.csv [--old tests/benchmarks/release.csv]

Figures in seconds are of the machine; all others are ratios measured in one run. Both tables should
come from one machine, under the same load. Exits with 1 where something got slower.
"""

import argparse
import csv
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.ratios import RATIOS, Row

LAST_RELEASE = Path(__file__).with_name("release.csv")
TOLERANCE = 1.15  # ratios of two runs differ by as much
MORE_IS_BETTER = {ratio.work for ratio in RATIOS if ratio.more_is_better}


@dataclass(frozen=True)
class Compared:
    """One row of two tables; `slower` is how many times worse the new figure is."""

    work: str
    old: float
    new: float

    @property
    def slower(self) -> float:
        """Above 1 where the new one is worse."""
        return self.old / self.new if self.work in MORE_IS_BETTER else self.new / self.old

    @property
    def mark(self) -> str:
        """In words; empty where nothing changed."""
        if self.slower > TOLERANCE:
            return "SLOWER"
        return "faster" if self.slower < 1 / TOLERANCE else ""


def write_table(file: Path, rows: Sequence[Row]) -> None:
    """One line for each row."""
    with file.open("w", newline="", encoding="utf-8") as stream:
        sheet = csv.writer(stream, lineterminator="\n")
        sheet.writerow(["work", "figure", "compared"])
        sheet.writerows([row.work, f"{row.figure:.4g}", row.compared] for row in rows)


def read_table(file: Path) -> dict[str, float]:
    """Figures by work."""
    with file.open(newline="", encoding="utf-8") as stream:
        return {row["work"]: float(row["figure"]) for row in csv.DictReader(stream)}


def compared(old: Mapping[str, float], new: Mapping[str, float]) -> list[Compared]:
    """What both tables have, in the order of the new one."""
    return [Compared(work, old[work], figure) for work, figure in new.items() if work in old]


def main() -> None:
    """Print both figures of each row, and how much slower the new one is."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("new", type=Path, help="table of --ratios-out")
    parser.add_argument("--old", type=Path, default=LAST_RELEASE, help="table of a release")
    arguments = parser.parse_args()
    old, new = read_table(arguments.old), read_table(arguments.new)
    rows = compared(old, new)
    print(f"{'':38s} {'release':>9s} {'now':>9s} {'times slower':>13s}")
    for row in rows:
        print(f"{row.work:38s} {row.old:9.3g} {row.new:9.3g} {row.slower:13.2f}  {row.mark}")
    for work in [work for work in {**old, **new} if (work in old) != (work in new)]:
        print(f"{work:38s} {'only in the ' + ('release' if work in old else 'new table'):>33s}")
    sys.exit(any(row.mark == "SLOWER" for row in rows))


if __name__ == "__main__":
    main()
