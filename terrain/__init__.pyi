from .camera import Camera
from .classification.classifier import Classification, TerrainClassifier
from .classification.training import Training, train
from .config import Config
from .errors import TerrainError
from .report.page import write_report
from .results import write_results
from .run_odometry import RunResult, run_odometry
from .synthetic import synthesise
from .texture import SFTA, sfta

__all__ = [
    "SFTA",
    "Camera",
    "Classification",
    "Config",
    "RunResult",
    "TerrainClassifier",
    "TerrainError",
    "Training",
    "run_odometry",
    "sfta",
    "synthesise",
    "train",
    "write_report",
    "write_results",
]
