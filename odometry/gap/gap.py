"""Locate the gap, name what is missing, add it, and measure what that closes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from tqdm import tqdm

from odometry.errors import GapError
from odometry.gap.answer.answered import answered
from odometry.gap.answer.result import GapResult
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.names import explained
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.measures import measures_of, shown_as_measured
from odometry.gap.prepare.prepared import Prepared, prepared
from odometry.gap.prepare.statistic import Measure, floor_there
from odometry.models.base import KinematicModel
from odometry.models.icr import Icr
from odometry.recording.independent_runs import check_no_run_twice
from odometry.recording.run import Run


def find_gap(
    measured: Sequence[Run],
    calibration: Sequence[Run],
    holdout: Sequence[Run] = (),
    *,
    model: KinematicModel | None = None,
    given: Mapping[str, float] | None = None,
    config: GapConfig | None = None,
    show_progress: bool = False,
) -> GapResult:
    """Find where a model and measured runs disagree, and which effect is missing.

    Parameters
    ----------
    measured : sequence of Run
        Runs on which the gap shows, with poses.
    calibration : sequence of Run
        Runs on which the base is identified (unless `given`), and the noise.
    holdout : sequence of Run
        Runs on which the answer is evaluated; pieces of the measured runs where there are none.
    model : KinematicModel, optional
        The base, `icr` when absent.
    given : Mapping of name to float, optional
        Parameters of the base, taken as they are.
    config : GapConfig, optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    GapError
        If runs are missing or too short.
    WindowError
        If a run has no poses, or the runs are of different robots.
    RunFolderError
        If a run is given twice.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> try:
    ...     odometry.find_gap([run], calibration=[run])
    ... except odometry.OdometryError as error:
    ...     print(str(error).split("; ")[1])
    expected each run once: none can be its own test
    """
    config = config or GapConfig()
    if not measured or not calibration:
        raise GapError(
            f"{len(measured)} measured and {len(calibration)} calibration runs, expected one or "
            "more of each"
        )
    check_no_run_twice([*measured, *calibration, *holdout])
    ready = prepared(measured, calibration, holdout, (model or Icr(), given), config)
    fitter = Fitter(ready.known, measured_of(ready.scenes[0], ready.known, ready.config))
    with tqdm(desc="candidates", unit="fit", disable=None if show_progress else True) as bar:
        found, measure = _explained(ready, fitter, _counting(bar))
    return answered(ready, fitter, found, measure)


def _explained(
    ready: Prepared, fitter: Fitter, count: Callable[[], None]
) -> tuple[Explanation, Measure]:
    """The explanation by the first measure that gives a name, or else by the last.

    Nothing is "none" that another measure surely shows on the measured runs.
    """
    config, known, (fitted, held_out) = ready.config, ready.known, ready.scenes
    for measure in measures_of(known, fitted, held_out, config, has_yaw=ready.has_yaw):
        floor = ready.floor(measure)
        floors = (
            floor_there(floor, known, fitted, config),
            floor_there(floor, known, held_out, config),
        )
        found = explained(fitter, held_out, floors, config, count)
        if found.has_name:
            break
    if not found.steps and not found.unexplained:
        other = shown_as_measured(known, fitted, held_out, config, has_yaw=ready.has_yaw)
        if other is not None:
            return replace(found, unexplained=True), other
    return found, measure


def _counting(bar: "tqdm[None]") -> Callable[[], None]:
    def count() -> None:
        bar.update()

    return count
