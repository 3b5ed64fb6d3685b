"""The output folder of a comparison: numbers, windows, parameters."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from odometry.comparison.evaluation import Evaluation
from odometry.comparison.file_names import file_name
from odometry.comparison.fitting import SplitModels
from odometry.comparison.result import Comparison
from odometry.comparison.summary import COLUMNS, Place, Summary, values_of
from odometry.comparison.training_horizons import write_training_horizons
from odometry.io.csv_table import write_csv_table
from odometry.io.files import atomic_write
from odometry.parameters import write_parameters

FORMAT = 1  # of comparison.json


def write_comparison(
    comparison: Comparison, out: str | Path, about: Mapping[str, Any] | None = None
) -> list[Path]:
    """Write everything but figures and page.

    Parameters
    ----------
    comparison : Comparison
    out : path
        Folder; made if it is missing.
    about : Mapping, optional
        What made the comparison; its keys are added to comparison.json.

    Returns
    -------
    list of Path
        comparison.json, windows.csv, training_horizons.csv where training horizons were given
        for, and one file of parameters/ a model; where there are several robots, in a folder for
        each.
    """
    out = Path(out)
    content = comparison_table(comparison) | dict(about or {})
    text = json.dumps(content, indent=2, allow_nan=False)
    with atomic_write(out / "comparison.json") as part:
        part.write_text(text + "\n", encoding="utf-8")
    _write_windows(out / "windows.csv", comparison)
    files = [out / "comparison.json", out / "windows.csv"]
    horizons = out / "training_horizons.csv"
    horizons.unlink(missing_ok=True)  # of an earlier comparison
    if comparison.by_training_horizon:
        write_training_horizons(horizons, comparison.by_training_horizon)
        files.append(horizons)
    robots = {robot for robot, _ in comparison.parameters}
    for (robot, model), parameters in comparison.parameters.items():
        folder = out / "parameters" / (file_name(robot) if len(robots) > 1 else "")
        files.append(folder / f"{model}.toml")
        write_parameters(files[-1], parameters)
    return files


def comparison_table(comparison: Comparison) -> dict[str, Any]:
    """The content of comparison.json: plain values with the unit in each name."""
    return {
        "format": FORMAT,
        "version": version("terrain-odometry"),
        "settings": asdict(comparison.config),
        "models": list(comparison.models),
        "places": [_place(comparison, place) for place in comparison.places],
        "by_horizon": [
            _summary(summary)
            for robot, terrain in comparison.robots_and_terrains
            for horizon_m in comparison.config.evaluated_m
            for summary in comparison.summaries_at(Place(robot, terrain, horizon_m))
            if summary.windows
        ],
        "splits": [_split(each) for each in comparison.split_models],
        "fitness": [
            {
                "robot": each.robot,
                "run": each.run,
                "model": each.model,
                **asdict(each.fitness),
                "mean": each.fitness.mean,
            }
            for each in comparison.fitness
        ],
        "left_out": dict(comparison.left_out),
        "notes": list(comparison.notes),
    }


def _place(comparison: Comparison, place: Place) -> dict[str, Any]:
    return {
        **_place_names(place),
        "models": [_summary(summary) for summary in comparison.summaries_at(place)],
        "differences": [
            {
                "quantity": each.quantity,
                "first": each.first,
                "second": each.second,
                "windows": each.windows,
                **asdict(each.interval),
            }
            for each in comparison.differences_at(place)
        ],
        "sentences": comparison.sentences_at(place),
    }


def _place_names(place: Place) -> dict[str, Any]:
    return {
        "robot": place.robot,
        "terrain": place.terrain,
        "ground": place.terrain,  # its name up to 0.5
        "horizon_m": place.horizon_m,
    }


def _summary(summary: Summary) -> dict[str, Any]:
    return {
        **_place_names(summary.place),
        "model": summary.model,
        "runs": list(summary.runs),
        "seen": list(summary.training_runs),
        "windows": summary.windows,
        "complete": summary.complete,
        **{
            name: {
                "mean": summary.means.get(quantity),
                "median": summary.medians.get(quantity),
                "quartiles": summary.quartiles[quantity].tolist() if summary.windows else None,
            }
            for quantity, name in COLUMNS.items()
        },
        "reasons": list(summary.reasons),
        "not_identified": list(summary.not_identified),
    }


def _split(models: SplitModels) -> dict[str, Any]:
    split = models.split
    return {
        "robot": split.robot,
        "terrain": split.terrain,
        "ground": split.terrain,
        "judged": [part.name for part in split.held_out],
        "seen": split.training_names,
        "models": {
            model: {
                "model": predictor.model.name,
                "parameters": dict(predictor.values),
                "source": predictor.source,
                "undetermined": list(predictor.undetermined),
                "notes": list(predictor.notes),
                "not_identified": list(predictor.not_identified),
            }
            for model, predictor in models.predictors.items()
        },
        "failed": dict(models.reasons),
    }


def _write_windows(file: Path, comparison: Comparison) -> None:
    """One row a model and window, over the horizons that were given."""
    rows = [
        (evaluation, model)
        for evaluation in comparison.evaluations
        if evaluation.horizon_m in comparison.config.horizons_m
        for model in evaluation.errors
    ]
    columns = [_columns(evaluation, model) for evaluation, model in rows]
    if columns:
        write_csv_table(
            file, {name: np.concatenate([each[name] for each in columns]) for name in columns[0]}
        )


def _columns(evaluation: Evaluation, model: str) -> dict[str, Any]:
    windows, errors = evaluation.windows, evaluation.errors[model]
    speeds_m_s = evaluation.mean_speeds_m_s
    names = {
        "robot": evaluation.robot,
        "terrain": evaluation.terrain,
        "ground": evaluation.terrain,
        "run": evaluation.run,
        "model": model,
    }
    return {
        **{key: np.full(len(windows), name, dtype=object) for key, name in names.items()},
        "horizon": np.full(len(windows), evaluation.horizon_m),
        "start_s": windows.start_s,
        "travel": windows.travel_m,
        "translation_m_per_m": values_of(errors, "translation"),
        "rotation_deg_per_m": values_of(errors, "rotation"),
        "v_left": speeds_m_s[:, 0],
        "v_right": speeds_m_s[:, 1],
    }
