from .camera_prior import SeenTerrain
from .detection import detections
from .files import write_modes
from .mode_set import DWELL_S, UNDETERMINED
from .words import sentences

__all__ = [
    "DWELL_S",
    "UNDETERMINED",
    "SeenTerrain",
    "detections",
    "sentences",
    "write_modes",
]
