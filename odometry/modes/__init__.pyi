from .follow.camera_prior import SeenTerrain
from .follow.detection import detections
from .models.mode_set import DWELL_S, UNDETERMINED
from .show.files import write_modes
from .show.words import sentences

__all__ = [
    "DWELL_S",
    "UNDETERMINED",
    "SeenTerrain",
    "detections",
    "sentences",
    "write_modes",
]
