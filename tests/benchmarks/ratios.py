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
        Names of two benchmarks; the ratio of their times.
    aim : float
        At most so much; where `faster`, at least.
    faster : bool
        Whether `of` tells itself how many times faster it is than `to`, in its extra info.
    """

    work: str
    of: str
    to: str
    aim: float
    faster: bool = False


SIZES = {"200 x 200": 20, "640 x 480": 7, "1280 x 720": 6}
RATIOS = (
    *(
        Ratio(f"SFTA of {size}", f"test_sfta[size{i}-chen2023]", f"test_calc_hist[size{i}]", aim)
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
            "filterpy's",
            aim,
            faster=True,
        )
        for modes, aim in ((3, 3), (16, 15))
    ),
    Ratio(
        "identification, 1 h at 20 Hz",
        "test_identification_against_a_loop",
        "a plain loop",
        50,
        faster=True,
    ),
)


def ratio_table(
    medians_s: Mapping[str, float], times_faster: Mapping[str, float]
) -> list[tuple[str, str, str, str]]:
    """Rows (work, ratio, compared to, aim) of what was measured.

    Parameters
    ----------
    medians_s : Mapping of name to float
    times_faster : Mapping of name to float
        What benchmarks said of themselves.
    """
    rows = []
    for ratio in RATIOS:
        if ratio.faster and ratio.of in times_faster:
            seen, aim = times_faster[ratio.of], f"at least {ratio.aim:g}"
            compared = f"times faster than {ratio.to}"
        elif not ratio.faster and ratio.of in medians_s and ratio.to in medians_s:
            seen, aim = medians_s[ratio.of] / medians_s[ratio.to], f"at most {ratio.aim:g}"
            compared = f"times {ratio.to}"
        else:
            continue
        rows.append((ratio.work, f"{seen:.3g}", compared, aim))
    return rows
