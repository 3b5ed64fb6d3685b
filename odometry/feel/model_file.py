"""A model of feel as a file of arrays and JSON, and back."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import OdometryError
from odometry.feel.assessment.evidence import Calibration
from odometry.feel.assessment.limits import NEVER, Limits
from odometry.feel.classifier.design import Design
from odometry.feel.classifier.discriminant import Discriminant
from odometry.feel.classifier.logistic import Logistic
from odometry.feel.classifier.members import Choice, Members
from odometry.feel.classifier.sensor import SensorShape
from odometry.feel.classifier.strangeness import LENGTHS, TERMS, Strangeness
from odometry.feel.model import FeelModel
from odometry.feel.recorded.motion_features import SPEED_NAMES
from odometry.io.array_file import FileKind, read_array_file, write_array_file


class FeelFileError(OdometryError):
    """A file of how terrains feel is damaged, foreign, or newer than this program."""


FEEL = FileKind("terrain-odometry feel", 4, "model of `identify-feel`", FeelFileError)

OF_RUNS = "of_runs"  # beside the numbers of the discriminants


def write_feel_model(
    path: str | Path, model: FeelModel, made: Mapping[str, Any] | None = None
) -> None:
    """Write a model, whole or not at all; `made` states what made it, for people alone.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> model = odometry.read_feel_model(odometry.shipped_data() / "feel" / "demo.feel")
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_feel_model(Path(folder) / "my.feel", model)
    ...     odometry.read_feel_model(Path(folder) / "my.feel").names
    ('grass', 'gravel')
    """
    arrays: dict[str, AnyArray] = {}
    for place, one in enumerate(model.members.discriminants):
        arrays |= _arrays(one, place)
    if model.members.of_runs is not None:
        arrays |= _arrays(model.members.of_runs, OF_RUNS)
    arrays |= {f"usual_{place}": usual for place, usual in enumerate(model.members.usual)}
    if model.members.logistic is not None:
        arrays |= {
            "logistic_weights": model.members.logistic.weights,
            "logistic_levels": model.members.logistic.levels,
        }
    if model.sensor is not None:
        arrays |= model.sensor.arrays()
    arrays |= {f"strangeness_{name}": of for name, of in model.strangeness.weights.items()}
    write_array_file(Path(path), FEEL, _settings(model), arrays, made)


def read_feel_model(path: str | Path) -> FeelModel:
    """Read what `write_feel_model` wrote.

    Raises
    ------
    FeelFileError
        If the file is missing, damaged, foreign, or of a newer program. Nothing in it is executed.

    Examples
    --------
    >>> import odometry
    >>> try:
    ...     odometry.read_feel_model("nowhere.feel")
    ... except odometry.OdometryError as error:
    ...     print(error)
    nowhere.feel: cannot be read: No such file or directory
    """
    settings, arrays = read_array_file(Path(path), FEEL)
    try:
        return _model(settings, arrays)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise FeelFileError(f"{path}: its settings or arrays do not fit: {error!r}") from error


def is_feel_model(path: Path) -> bool:
    """Whether a file is a whole model of a format that this program reads."""
    try:
        read_feel_model(path)
    except FeelFileError:
        return False
    return True


def _settings(model: FeelModel) -> dict[str, Any]:
    return {
        "names": list(model.names),
        "window_s": model.design.window_s,
        "axes": list(model.design.axes),
        "motion": list(model.design.motion),
        "top_hz": model.design.top_hz,
        "layouts": list(model.design.layouts),
        "shaped": model.design.shaped,
        "crossed": model.design.crossed,
        "sets": [list(one) for one in model.choice.sets],
        "shrinkage": model.choice.shrinkage,
        "unknown_share": model.strangeness.share,
        "calibration": vars(model.calibration),
        "limits": asdict(model.limits),
        "track_width_m": model.track_width_m,
        "robot": model.robot,
        "source": model.source,
        "report": dict(model.report),
        "repeats": model.repeats,
    }


def _model(settings: dict[str, Any], arrays: dict[str, AnyArray]) -> FeelModel:
    names = tuple(map(str, settings["names"]))
    design = Design(
        float(settings["window_s"]),
        tuple(map(str, settings["axes"])),
        tuple(map(str, settings["motion"])),
        float(settings["top_hz"]),
        tuple(map(int, settings["layouts"])),
        bool(settings.get("shaped", False)),
        bool(settings.get("crossed", False)),
    )
    sets = tuple(tuple(map(str, one)) for one in settings["sets"])
    choice = Choice(sets, float(settings["shrinkage"]), "logistic_weights" in arrays)
    return FeelModel(
        names,
        design,
        choice,
        _members(arrays, [len(columns) for _, columns in choice.parts(design)], len(names)),
        _calibration(settings["calibration"]),
        _strangeness(settings, arrays),
        _limits(settings["limits"], design.window_s),
        SensorShape.from_arrays(arrays),
        float(settings["track_width_m"]),
        str(settings["robot"]),
        str(settings["source"]),
        dict(settings["report"]),
        float(settings.get("repeats", 1.0)),
    )


def _strangeness(settings: dict[str, Any], arrays: Mapping[str, AnyArray]) -> Strangeness:
    """Those of versions 1 and 2 were none, or of other terms."""
    if "strangeness_run" not in arrays:
        return Strangeness.none()
    weights = {name: _array(arrays, f"strangeness_{name}", (TERMS,)) for name in LENGTHS}
    return Strangeness(weights, float(settings["unknown_share"]))


def _members(arrays: Mapping[str, AnyArray], sizes: Sequence[int], terrains: int) -> Members:
    """Discriminants, and the logistic regression as the last where there is one."""
    covariates, with_logistic = len(SPEED_NAMES), "logistic_weights" in arrays
    usual = [
        _array(arrays, f"usual_{place}", (size + covariates,)) for place, size in enumerate(sizes)
    ]
    discriminants = [
        _discriminant(arrays, place, size, terrains)
        for place, size in enumerate(sizes[: len(sizes) - with_logistic])
    ]
    logistic, of_runs = None, None
    if f"means_{OF_RUNS}" in arrays:
        of_runs = _discriminant(arrays, OF_RUNS, sizes[-1], terrains)
    if with_logistic:
        logistic = Logistic(
            _array(arrays, "logistic_weights", (sizes[-1] + covariates, terrains)),
            _array(arrays, "logistic_levels", (terrains,)),
        )
    return Members(tuple(discriminants), tuple(usual), logistic, of_runs)


def _arrays(one: Discriminant, place: int | str) -> dict[str, AnyArray]:
    return {
        f"slopes_{place}": one.slopes,
        f"means_{place}": one.means,
        f"whitening_{place}": one.whitening,
    }


def _discriminant(
    arrays: Mapping[str, AnyArray], place: int | str, size: int, terrains: int
) -> Discriminant:
    return Discriminant(
        _array(arrays, f"slopes_{place}", (len(SPEED_NAMES), size)),
        _array(arrays, f"means_{place}", (terrains, size)),
        _array(arrays, f"whitening_{place}", (size, size)),
    )


def _calibration(settings: Mapping[str, Any]) -> Calibration:
    """Versions 1 and 2 had one kind of classifier."""
    one = [settings["temperature"]] if "temperature" in settings else settings["temperatures"]
    return Calibration(
        tuple(map(float, one)), float(settings["outliers"]), float(settings["correlation"])
    )


def _limits(settings: Mapping[str, Any], window_s: float) -> Limits:
    """Versions 1 and 2 knew no distance of the mean, and judged runs as stretches."""
    more = (float(settings["slowest_m_s"]), float(settings["fastest_m_s"]), window_s)
    if "novelty" in settings:
        novelty, farness = (
            {name: float(settings[kind][name]) for name in LENGTHS}
            for kind in ("novelty", "farness")
        )
        return Limits(novelty, farness, *more)
    window, stretch = float(settings["window"]), float(settings["stretch"])
    novelty = {"window": window, "stretch": stretch, "run": stretch}
    return Limits(novelty, dict.fromkeys(LENGTHS, NEVER), *more)


def _array(arrays: Mapping[str, AnyArray], name: str, shape: tuple[int, ...]) -> FloatArray:
    if arrays[name].shape != shape:
        raise ValueError(f"{name} of shape {arrays[name].shape}, expected {shape}")
    return arrays[name].astype(np.float64)
