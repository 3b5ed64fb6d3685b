"""The demonstration: every step of the main job on the shipped data."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from odometry.installed import shipped_data
from odometry.recording.run import Run
from terrain.classification.training import train
from terrain.main_job import run_odometry
from terrain.report.page import write_report
from terrain.result.run_result import RunResult
from terrain.results import write_results

WITH, WITHOUT = "with terrain classification", "without terrain classification"


def run_demo(
    out: str | Path, *, about: Mapping[str, Any] | None = None, show_progress: bool = False
) -> tuple[dict[str, RunResult], list[Path]]:
    """Train on the shipped patches, replay the shipped run with and without vision, report.

    Parameters
    ----------
    out : path
        Gets terrain.model, the results with vision and the page; the results without vision go
        to its folder `without_vision`.
    about : Mapping, optional
        What made the results; its keys are added to each result.json.
    show_progress : bool

    Returns
    -------
    results : dict of str to RunResult
    written : list of Path

    Examples
    --------
    >>> import terrain
    >>> results, written = terrain.run_demo("demo")  # doctest: +SKIP
    """
    out, data = Path(out), shipped_data()
    run = Run.read(data / "runs" / "demo")
    training = train(data / "patches", show_progress=show_progress)
    model = out / "terrain.model"
    training.classifier.save(model)
    parameters = run.folder / "parameters.toml"
    seen = run_odometry(run, model=model, parameters=parameters, show_progress=show_progress)
    blind = run_odometry(run, parameters=parameters, show_progress=show_progress)
    written = [model, *write_results(seen, out, about)]
    written += write_results(blind, out / "without_vision", about)
    written += write_report(seen, out, compared_with={WITHOUT: blind})
    return {WITH: seen, WITHOUT: blind}, written
