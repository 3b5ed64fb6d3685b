"""Print the table of ratios after the benchmarks."""

from tests.benchmarks.ratios import ratio_table


def pytest_terminal_summary(terminalreporter, config):
    """After the tables of pytest-benchmark."""
    session = getattr(config, "_benchmarksession", None)
    measured = [one for one in getattr(session, "benchmarks", []) if one.stats.rounds]
    rows = ratio_table(
        {one.name: one.stats.median for one in measured},
        {
            one.name: one.extra_info["times_faster"]
            for one in measured
            if "times_faster" in one.extra_info
        },
    )
    if not rows:
        return
    terminalreporter.write_sep("-", "ratios, all measured in this run")
    for work, ratio, compared, aim in rows:
        terminalreporter.write_line(f"{work:38s} {ratio:>8s}  {compared:52s} {aim}")
