from .drawing.figure import line_styles, terrain_colours
from .drawing.map_plots import plot_ground, plot_paths
from .gap.gap_figures import closing_picture, evidence_picture
from .gap.gap_map import map_picture
from .gap.gap_page import rollout_pictures
from .icrs.icr_map import plot_icrs
from .icrs.plots import mark_changes, plot_icr
from .modes.mode_figures import modes_picture
from .modes.modes_page import write_modes_report

__all__ = [
    "closing_picture",
    "evidence_picture",
    "line_styles",
    "map_picture",
    "mark_changes",
    "modes_picture",
    "plot_ground",
    "plot_icr",
    "plot_icrs",
    "plot_paths",
    "rollout_pictures",
    "terrain_colours",
    "write_modes_report",
]
