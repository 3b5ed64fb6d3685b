"""The table of labels against the terrain that the run's images.csv names."""

from odometry.report.html import Grid
from terrain.label_confusion import label_confusions
from terrain.run_result import RunResult


def label_table(result: RunResult) -> Grid | None:
    """Images by the terrain that images.csv names and by label; None where it names none.

    Against truth.csv there is a picture, see `terrain.report.seen_ahead.confusion`.
    """
    of = label_confusions(result).get("images.csv")
    if of is None:
        return None
    rows = [(name, *map(str, row)) for name, row in zip(of.true, of.counts.tolist(), strict=True)]
    share = of.right_share
    right = "" if share is None else f"; {share:.0%} of the labels that are names are right"
    caption = f"Images by their terrain in images.csv (rows) and by label (columns){right}."
    return Grid(("true terrain", *of.labels), rows, caption)
