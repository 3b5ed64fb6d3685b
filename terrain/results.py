"""The output folder of a run: tables, trajectories, numbers, what was learned, figures, page."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import repeat
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.blocks import blocks_of
from odometry.checks.findings.finding import CheckReport
from odometry.estimation.estimate import STATE_NAMES
from odometry.estimation.kept_estimates import EVERY
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.io.csv_table import write_csv_blocks, write_csv_table
from odometry.io.files import atomic_write
from odometry.io.formats import check_format
from odometry.io.structured import read_json
from odometry.io.tum import write_tum
from odometry.outputs.manifest import check_finished
from odometry.outputs.output_folder import OutputFolder
from odometry.outputs.provenance import about_result
from odometry.parameters import write_parameters
from odometry.replays.estimates import Replay
from odometry.trajectory import Trajectory
from terrain.errors import ResultError
from terrain.report import page
from terrain.result.new_terrain import contradiction_columns
from terrain.result.result_table import (
    COVARIANCE_COLUMNS,
    FORMAT,
    covariance_columns,
    reference_columns,
    result_table,
)
from terrain.result.run_result import RunResult
from terrain.result.terrain_table import terrain_columns


def write_run(result: RunResult, output: OutputFolder, reports: Sequence[CheckReport]) -> None:
    """Write all of one run into the folder that was claimed for it.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    with output.writing() as part:
        write_results(
            result, part, about_result(output.made, [report.to_table() for report in reports])
        )
        page.write_report(result, part, reports=reports)


ERRORS = (  # of each trajectory in it, and which number of each the tables show
    ("translation_m_per_m", "mean"),
    ("rotation_deg_per_m", "mean"),
    ("position_m", "mean"),
    ("position_m", "final"),
)


def write_results(
    result: RunResult, out: str | Path, about: Mapping[str, Any] | None = None
) -> list[Path]:
    """Write everything but figures and page.

    Parameters
    ----------
    result : RunResult
    out : path
        Made if it is missing; files of an earlier run are replaced one by one.
    about : Mapping, optional
        What made the result; its keys are added to result.json, after the check of the result.

    Returns
    -------
    list of Path
        odometer.csv and .tum, estimate.csv and .tum, result.json; learned.toml where there is
        anything to store; terrain.csv where there is a source of terrain; contradictions.csv where
        camera, feel and motion differ for long; reference.csv where there are poses to evaluate
        with, and reference.tum where they have a yaw.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> with TemporaryDirectory() as folder:
    ...     print([file.name for file in terrain.write_results(result, folder)][:2])
    ['odometer.csv', 'odometer.tum']
    """
    out = Path(out)
    replay = result.replay
    odometer = replay.odometer()
    write_csv_blocks(
        out / "odometer.csv",
        ("t", "x", "y", "yaw", *COVARIANCE_COLUMNS),
        _odometer_blocks(odometer, result.uncertainty),
    )
    write_tum(out / "odometer.tum", odometer)
    del odometer  # of a long run the estimate's would not fit beside it
    write_csv_blocks(
        out / "estimate.csv",
        ("t", *STATE_NAMES, *(f"sigma_{name}" for name in STATE_NAMES)),
        _estimate_blocks(replay, result.uncertainty),
    )
    write_tum(out / "estimate.tum", replay.trajectory())
    names = ["odometer.csv", "odometer.tum", "estimate.csv", "estimate.tum"]
    if result.learned.terrains:
        write_parameters(out / "learned.toml", result.learned)
        names.append("learned.toml")
    tables = {
        "terrain.csv": terrain_columns(result),
        "contradictions.csv": contradiction_columns(result.contradictions),
        "reference.csv": reference_columns(result),
    }
    for name, columns in tables.items():
        if columns:
            write_csv_table(out / name, columns)
            names.append(name)
    if result.reference is not None and np.isfinite(result.reference.poses).all():
        write_tum(out / "reference.tum", result.reference)
        names.append("reference.tum")
    for name in {"learned.toml", *tables, "reference.tum"} - set(names):
        (out / name).unlink(missing_ok=True)  # of an earlier run
    about = {"check": [report.to_table() for report in result.reports]} | dict(about or {})
    text = json.dumps(result_table(result) | about, indent=2, allow_nan=False)
    with atomic_write(out / "result.json") as part:
        part.write_text(text + "\n", encoding="utf-8")
    return [out / name for name in (*names, "result.json")]


def _odometer_blocks(
    odometer: Trajectory, uncertainty: OdometerUncertainty
) -> Iterator[dict[str, FloatArray]]:
    blocks = zip(blocks_of(len(odometer)), uncertainty.covariance_blocks(), strict=True)
    for rows, covariances in blocks:
        x, y, yaw = odometer.poses[rows].T
        poses = {"t": odometer.stamps_s[rows], "x": x, "y": y, "yaw": yaw}
        yield poses | covariance_columns(covariances)


def _estimate_blocks(
    replay: Replay, uncertainty: OdometerUncertainty
) -> Iterator[dict[str, FloatArray]]:
    """Estimates with standard deviations: of a pose without measured poses those of the odometer.

    Errors of both are alike then, and the filter is too sure (`odometer_uncertainty`).
    """
    of_odometer: Iterable[FloatArray | None] = repeat(None)
    if not uncertainty.poses:
        of_odometer = uncertainty.covariance_blocks()
    for rows, covariances in zip(blocks_of(len(replay.estimates)), of_odometer, strict=False):
        sigmas = replay.sigmas_of(EVERY, rows)
        if covariances is not None:
            sigmas[:, :3] = np.sqrt(np.diagonal(covariances, axis1=1, axis2=2))
        yield (
            {"t": replay.numbers("stamp_s", rows)}
            | dict(zip(STATE_NAMES, replay.numbers("mean", rows).T, strict=True))
            | {f"sigma_{name}": of for name, of in zip(STATE_NAMES, sigmas.T, strict=True)}
        )


def read_errors(folder: str | Path) -> dict[str, Any]:
    """Errors of a finished run, from the `result.json` in its folder.

    Returns
    -------
    dict
        `errors` by trajectory, `reference` and `horizon_m`, as `result.json` holds them, `run`,
        its name, and `run_path`, as it was given to `run`; None where the result does not say;
        `other_odometry`, names of what the run folder kept; `remarks`, sentences beside the errors.

    Raises
    ------
    ResultError
        If the folder has no result of `run`, or one of a newer format.
    OutputError
        If `run` was stopped while it wrote the folder.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> with TemporaryDirectory() as folder:
    ...     written = terrain.write_results(result, folder)
    ...     print(terrain.read_errors(folder)["reference"])
    truth
    """
    file = Path(folder) / "result.json"
    check_finished(file.parent)
    if not file.exists():
        raise ResultError(f"{folder} has no result.json; expected a folder that `run` wrote")
    content = read_json(file, ResultError)
    try:
        check_format(file, content.get("format", FORMAT), FORMAT, ResultError)
        for errors in content["errors"].values():
            for name, statistic in ERRORS:
                _check_error(errors[name][statistic])
        errors = {key: content[key] for key in ("errors", "reference", "horizon_m")}
        run = str(content["run"]) if "run" in content else None
        kept = [str(name) for name in content.get("other_odometry", [])]
        remarks = [str(each) for each in content.get("remarks", [])]
        return errors | {
            "run": run,
            "run_path": _run_path(content),
            "other_odometry": kept,
            "remarks": remarks,
        }
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ResultError(f"{file}: it is not a result of `run`") from error


def _run_path(content: Mapping[str, Any]) -> str | None:
    """Where the run folder was, by what made the result."""
    inputs = content.get("made", {}).get("inputs", [])
    return next((str(each["path"]) for each in inputs if each["role"] == "RUN"), None)


def _check_error(value: Any) -> None:
    """Raise ValueError unless it is a number, or None where there was nothing to measure."""
    if value is not None and not (
        isinstance(value, int | float) and not isinstance(value, bool) and np.isfinite(value)
    ):
        raise ValueError(value)
