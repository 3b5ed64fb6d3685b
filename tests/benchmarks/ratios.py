"""What the benchmarks are compared to: one table of ratios, all measured in one run."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Ratio:
    """One row of the table.

    Attributes
    ----------
    work : str
    of, to : str
        Names of two benchmarks; the ratio of their times. With `is_figure`, what that of `of` is.
    aim : float
        At most so much; where `more_is_better`, at least.
    is_figure : bool
        Whether `of` states its own figure, as `figure` in its extra info.
    more_is_better : bool
    """

    work: str
    of: str
    to: str
    aim: float
    is_figure: bool = False
    more_is_better: bool = False


@dataclass(frozen=True)
class Row:
    """What was measured of one row: the figure, what it is, and the aim in words."""

    work: str
    figure: float
    compared: str
    aim: str


SIZES = {"200 x 200": 20, "640 x 480": 7, "1280 x 720": 6}
RATIOS = (
    *(
        Ratio(f"SFTA of {size}", f"test_sfta[chen2023-size{i}]", f"test_calc_hist[size{i}]", aim)
        for i, (size, aim) in enumerate(SIZES.items())
    ),
    Ratio("run with vision", "test_run[default]", "test_decoding", 15),
    Ratio("the same, fast", "test_run[fast]", "test_decoding", 5),
    Ratio("the same, chen2023", "test_run[chen2023]", "test_decoding", 5),
    *(
        Ratio(
            f"step of the filter, turned by {by}",
            f"test_a_step[{by}-as it comes]",
            f"test_filterpys_predict_and_update[{by}]",
            1.5,
        )
        for by in ("treads", "gyroscope")
    ),
    *(
        Ratio(
            f"IMM of {modes} modes",
            f"test_imm_against_filterpys[all filters at once-{modes}]",
            "times faster than filterpy's",
            aim,
            is_figure=True,
            more_is_better=True,
        )
        for modes, aim in ((3, 3), (16, 15))
    ),
    Ratio(
        "identification, 1 h at 20 Hz",
        "test_identification_against_a_loop",
        "times faster than a plain loop",
        50,
        is_figure=True,
        more_is_better=True,
    ),
    Ratio("gap, a case by formulas", "test_a_gap_case[curvature]", "s", 1, is_figure=True),
    Ratio("gap, a case with contacts", "test_a_gap_case[contact_slope]", "s", 4, is_figure=True),
    Ratio(
        "contact simulator, one drive",
        "test_simulate_contact[coulomb-1]",
        "times faster than real time",
        200,
        is_figure=True,
        more_is_better=True,
    ),
    Ratio(
        "training, 2 processes",
        "test_training_by_two_processes",
        "times faster than 1 process",
        1.8,
        is_figure=True,
        more_is_better=True,
    ),
    Ratio(
        "peak memory of run, 5 times as long",
        "test_peak_memory_of_a_long_run",
        "times that of the demo five times over",
        1.1,
        is_figure=True,
    ),
    Ratio("--help", "test_a_start[help]", "s", 0.08, is_figure=True),
    Ratio("first output of run", "test_a_start[run]", "s", 1.0, is_figure=True),
    Ratio("import of the packages", "test_a_start[import]", "s", 0.05, is_figure=True),
)


def ratio_table(medians_s: Mapping[str, float], figures: Mapping[str, float]) -> list[Row]:
    """Rows of what was measured.

    Parameters
    ----------
    medians_s : Mapping of name to float
    figures : Mapping of name to float
        What benchmarks said of themselves.
    """
    rows = []
    for ratio in RATIOS:
        aim = f"at {'least' if ratio.more_is_better else 'most'} {ratio.aim:g}"
        if ratio.is_figure and ratio.of in figures:
            rows.append(Row(ratio.work, figures[ratio.of], ratio.to, aim))
        elif not ratio.is_figure and ratio.of in medians_s and ratio.to in medians_s:
            figure = medians_s[ratio.of] / medians_s[ratio.to]
            rows.append(Row(ratio.work, figure, f"times {ratio.to}", aim))
    return rows
