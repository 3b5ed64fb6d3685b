"""The figure of measured ICRs over the robot, one panel a terrain."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from odometry.arrays import FloatArray
from odometry.icrs.measured import LEAST_WINDOWS, SHORT_WINDOWS, MeasuredIcrs, icrs_of_windows
from odometry.icrs.points import NO_SLIP
from odometry.identification.identification import Identification
from odometry.recording.run import Robot, Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.report.drawing.figure import save_figure
from odometry.report.icrs.icr_map import FITTED_STYLE, TURN_STYLES, Frame, frame_of, plot_icrs
from odometry.windows.travel.windows import windows_of

_WIDTH_IN, _BESIDE_IN, _ABOVE_IN, _KEYS_IN, _COLUMNS = 4.6, 0.8, 1.15, 0.6, 3
_TALLEST = 1.5  # height of a panel by its width


def save_identified_icrs(
    file: Path,
    runs: Sequence[Run],
    found: Identification,
    terrain: str | None,
    *,
    source: str | None = None,
) -> Path:
    """Draw the ICRs that runs show, window by window of 1 s, beside those identified from them.

    Tread speeds count with the slip factors of the fit, where its model has constant ICRs.

    Parameters
    ----------
    file : Path
        Ends in .png.
    runs : sequence of Run
    found : Identification
        From these runs.
    terrain : str or None
        Name of the terrain in runs that name none.
    source : str or None
        What made the file.
    """
    stated = found.window_config
    config = replace(
        SHORT_WINDOWS,
        position_sigma_m=stated.position_sigma_m,
        yaw_sigma_rad=stated.yaw_sigma_rad,
    )
    windows = windows_of([with_named_terrain(run, terrain) for run in runs], config)
    measured, fitted = {}, {}
    for name, of_terrain in found.terrains.items():
        fit, alphas = of_terrain.fit, np.array(NO_SLIP)
        if fit.model.has_constant_icrs:
            form = fit.model.icr_form(fit.packed)
            fitted[name], alphas = form.icrs, form.alphas
        here = windows.where(windows.terrain == name)
        measured[name] = icrs_of_windows(here, config, alphas=alphas)
    return save_icr_picture(file, measured, found.robot, fitted, source=source)


def save_icr_picture(
    file: Path,
    measured: Mapping[str, MeasuredIcrs],
    robot: Robot,
    fitted: Mapping[str, FloatArray],
    *,
    source: str | None = None,
) -> Path:
    """Draw the ICRs of every terrain over the robot.

    Parameters
    ----------
    file : Path
        Ends in .png.
    measured : Mapping of terrain to MeasuredIcrs
        One terrain or more.
    robot : Robot
    fitted : Mapping of terrain to (3,)
        y_left, y_right, x_icr of a model, where there are any.
    source : str or None
        What made the file.

    Returns
    -------
    Path
        `file`.
    """
    columns = min(len(measured), _COLUMNS)
    rows = -(-len(measured) // columns)
    frames = [frame_of(each.icrs, robot, fitted.get(name)) for name, each in measured.items()]
    tallest = min(max(frame.height_by_width for frame in frames), _TALLEST)
    height_in = rows * ((_WIDTH_IN - _BESIDE_IN) * tallest + _ABOVE_IN) + _KEYS_IN
    keys = _KEYS_IN / height_in

    def draw(figure: Figure) -> None:
        figure.set_layout_engine("constrained", rect=(0, keys, 1, 1 - keys))
        for number, (terrain, icrs) in enumerate(measured.items()):
            axes = figure.add_subplot(rows, columns, number + 1)
            frame = plot_icrs(axes, icrs, robot, fitted.get(terrain))
            axes.set_title(
                f"{terrain}\n{_turns(icrs, frame)}", loc="left", fontsize=9, parse_math=False
            )
        figure.legend(
            handles=_keys(bool(fitted)), loc="lower center", ncols=2, frameon=False, fontsize=8.5
        )

    return save_figure(file, (columns * _WIDTH_IN, height_in), draw, source=source)


def _turns(icrs: MeasuredIcrs, frame: Frame) -> str:
    counts = {side: int(np.count_nonzero(icrs.side == side)) for side in TURN_STYLES}
    turns = ", ".join(
        f"{count} {side}{' (too few for a median)' if count < LEAST_WINDOWS else ''}"
        for side, count in counts.items()
    )
    outside = int(np.count_nonzero(~frame.holds(icrs.icrs)))
    return f"turns: {turns}\n{outside} windows lie beyond the frame"


def _keys(with_fitted: bool) -> list[Line2D]:
    keys = [
        Line2D([], [], linestyle="", label=f"{side} turns, median with 95 %", **style)
        for side, style in TURN_STYLES.items()
    ]
    ring: dict[str, Any] = {"marker": "o", "markersize": 10, "markerfacecolor": "none"}
    keys.append(
        Line2D([], [], linestyle="", label="middle half of windows", color="#555555", **ring)
    )
    if with_fitted:
        keys.append(Line2D([], [], label="fitted ICRs", **{**FITTED_STYLE, "markersize": 11}))
    return keys
