"""Print the table of ratios after the benchmarks, and write it where a file is asked for."""

from pathlib import Path

from tests.benchmarks.ratios import ratio_table
from tests.benchmarks.release import write_table


def pytest_addoption(parser):
    """Where the table goes."""
    parser.addoption("--ratios-out", type=Path, help="write the table of ratios to this CSV file")


def pytest_terminal_summary(terminalreporter, config):
    """After the tables of pytest-benchmark."""
    session = getattr(config, "_benchmarksession", None)
    measured = [one for one in getattr(session, "benchmarks", []) if one.stats.rounds]
    rows = ratio_table(
        {one.name: one.stats.median for one in measured},
        {one.name: one.extra_info["figure"] for one in measured if "figure" in one.extra_info},
    )
    if not rows:
        return
    terminalreporter.write_sep("-", "ratios, all measured in this run")
    for row in rows:
        line = f"{row.work:38s} {row.figure:>8.3g}  {row.compared:52s} {row.aim}"
        terminalreporter.write_line(line)
    file = config.getoption("--ratios-out", default=None)
    if file is not None:
        write_table(file, rows)
