from .camera import Camera
from .checks.recording import check_run
from .classification.classifier import Classification, TerrainClassifier
from .classification.training import Training, train
from .config import Config
from .demo import run_demo
from .errors import TerrainError
from .report.page import write_report
from .results import read_errors, write_results
from .run_odometry import run_odometry
from .run_result import RunResult
from .synthetic import SynthesisConfig, synthesise
from .texture import SFTA, sfta

__all__ = [
    "SFTA",
    "Camera",
    "Classification",
    "Config",
    "RunResult",
    "SynthesisConfig",
    "TerrainClassifier",
    "TerrainError",
    "Training",
    "check_run",
    "read_errors",
    "run_demo",
    "run_odometry",
    "sfta",
    "synthesise",
    "train",
    "write_report",
    "write_results",
]
