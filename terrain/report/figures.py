"""The figures of a report about trajectories and ICRs, as files with captions."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from odometry.evaluation.stretches import Stretch
from odometry.report.drawing.figure import save_figure, show_run_time
from odometry.report.drawing.html import Picture
from odometry.report.drawing.labels import broken_at_outages
from odometry.report.drawing.map_plots import plot_ground, plot_paths
from odometry.report.icrs.plots import (
    mark_changes,
    plot_error_distribution,
    plot_icr,
    plot_position_errors,
)
from terrain.report.lines import ICR_COORDINATES, ReportLines
from terrain.result.run_result import RunResult
from terrain.result.switch_delay import true_stretches

_WIDTH_IN = 7.0
_LEFT, _RIGHT = 0.115, 0.75  # of the width; labels stand to the right
Tints = dict[str, str]


def in_force(result: RunResult) -> tuple[Stretch, ...]:
    """Stretches of the terrain in force."""
    return result.in_force


def path_picture(lines: ReportLines, tints: Tints, folder: Path) -> Picture:
    """The paths over the terrain along the true, the measured or the estimated one."""
    result, paths = lines.result, lines.paths()
    driven = result.replay.trajectory() if result.reference is None else result.reference
    true = true_stretches(result)
    places = np.concatenate([path.poses[:, :2] for path in paths.values()])
    spans = np.nanmax(places, axis=0) - np.nanmin(places, axis=0)
    height_in = 4.6 * float(np.clip(spans[1] / max(spans[0], 1e-9), 0.35, 1.1)) + 0.9

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((_LEFT, 0.6 / height_in, _RIGHT - _LEFT, 1 - 0.8 / height_in))
        plot_paths(axes, paths, lines.styles())
        plot_ground(axes, driven, true or in_force(result), tints)

    along = "the true terrain" if true else "the terrain in force"
    return Picture(
        save_figure(folder / "path.png", (_WIDTH_IN, height_in), draw),
        f"Map of the paths: {', '.join(paths)}.",
        f"Paths from above. The broad band is {along}.",
    )


def position_picture(lines: ReportLines, folder: Path) -> Picture | None:
    """Position errors over time; None without a reference."""
    errors = {name: of.position_errors for name, of in lines.evaluated().items()}
    errors = {n: broken_at_outages(*error) for n, error in errors.items() if len(error[0])}
    if not errors:
        return None

    def draw(figure: Figure) -> None:
        axes = figure.add_axes((_LEFT, 0.16, _RIGHT - _LEFT, 0.74))
        plot_position_errors(axes, errors, lines.styles())
        show_run_time(axes, lines.result.run.began_s)
        mark_changes(axes, in_force(lines.result), names=True)

    finals = ", ".join(f"{name} {distances[-1]:.2f} m" for name, (_, distances) in errors.items())
    return Picture(
        save_figure(folder / "position_errors.png", (_WIDTH_IN, 3.2), draw),
        f"Position errors over time; at the end: {finals}.",
        f"Distance from the {lines.reference_name} over time.{_dotted(lines)}",
    )


def distribution_picture(lines: ReportLines, folder: Path) -> Picture | None:
    """Errors per metre of all horizons; None where there is no whole horizon."""
    result = lines.result
    relative = {name: of.window_errors for name, of in lines.evaluated().items()}
    if not any(len(errors.start_s) for errors in relative.values()):
        return None
    translation = {name: errors.translation_per_m for name, errors in relative.items()}
    rotation = {
        name: np.degrees(errors.rotation_per_m[np.isfinite(errors.rotation_per_m)])
        for name, errors in relative.items()
    }
    has_yaw = any(len(errors) for errors in rotation.values())
    height_in = 0.8 + 0.45 * len(relative)

    def draw(figure: Figure) -> None:
        bottom, height = 0.6 / height_in, 1 - 0.7 / height_in
        left = figure.add_axes((0.29, bottom, 0.32 if has_yaw else 0.69, height))
        plot_error_distribution(left, translation, lines.styles(), "position [m per m]")
        if has_yaw:
            right = figure.add_axes((0.66, bottom, 0.32, height))
            plot_error_distribution(right, rotation, lines.styles(), "heading [degrees per m]")
            right.set_yticklabels([])

    horizon_m = result.config.evaluation.horizon_m
    return Picture(
        save_figure(folder / "error_per_metre.png", (_WIDTH_IN, height_in), draw),
        f"Boxes of the errors per metre of {', '.join(relative)}.",
        f"Errors over stretches of {horizon_m:g} m of wheel travel, per metre. Boxes: quartiles; "
        "whiskers: 5 to 95 %; diamonds: means.",
    )


def icr_picture(lines: ReportLines, folder: Path) -> Picture:
    """The three ICR coordinates over time."""
    stamps_s = lines.result.replay.stamps_s

    def draw(figure: Figure) -> None:
        for row, name in enumerate(ICR_COORDINATES):
            axes = figure.add_axes((_LEFT, 0.69 - 0.305 * row, _RIGHT - _LEFT, 0.26))
            axes.set_xlim(float(stamps_s[0]), float(stamps_s[-1]))
            plot_icr(axes, name, lines.icr_lines(row), lines.true_icr(name), lines.icr_styles())
            mark_changes(axes, in_force(lines.result), names=row == 0)
            show_run_time(axes, lines.result.run.began_s)
            if row < len(ICR_COORDINATES) - 1:
                axes.tick_params(labelbottom=False)
                axes.set_xlabel("")

    return Picture(
        save_figure(folder / "icrs.png", (_WIDTH_IN, 6.4), draw),
        "The ICR coordinates y_left, y_right and x_icr over time with bands of two sigma.",
        "Instantaneous centres of rotation as the filter held them, with bands of two standard "
        f"deviations.{_dotted(lines)}"
        + (" Dashed: the truth." if lines.true_icr("y_left") else ""),
    )


def _dotted(lines: ReportLines) -> str:
    changes = len(in_force(lines.result)) > 1
    return " Dotted: another terrain comes into force." if changes else ""
