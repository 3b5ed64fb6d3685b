from .labels_and_truth import confusion
from .lines import ICR_COORDINATES, ReportLines
from .plots import draw_region, plot_confusion, plot_image, plot_labels

__all__ = [
    "ICR_COORDINATES",
    "ReportLines",
    "confusion",
    "draw_region",
    "plot_confusion",
    "plot_image",
    "plot_labels",
]
