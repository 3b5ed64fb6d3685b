from .figure import line_styles, terrain_colours
from .gap_figures import closing_picture, evidence_picture
from .gap_map import map_picture
from .gap_page import rollout_pictures
from .icr_map import plot_icrs
from .map_plots import plot_ground, plot_paths
from .mode_figures import modes_picture
from .modes_page import write_modes_report
from .plots import mark_changes, plot_icr

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
