from .camera import Camera
from .checks.recording import check_run
from .classification.classifier import Classification, TerrainClassifier
from .classification.training import Training, train
from .config import Config
from .demo import run_demo
from .errors import TerrainError
from .images import decode_image
from .labelling.label_runs import label_runs
from .labelling.patch_files import write_labelled_patches
from .labelling.scale import LabelConfig
from .labelling.told_terrain import TerrainSpan, told_by_spans, told_terrain
from .live_odometry import LiveOdometry, LiveStep
from .main_job import run_odometry
from .report.page import write_report
from .results import read_errors, write_results
from .run_result import RunResult
from .synthetic import SynthesisConfig, synthesise
from .texture import SFTA, sfta

__all__ = [
    "SFTA",
    "Camera",
    "Classification",
    "Config",
    "LabelConfig",
    "LiveOdometry",
    "LiveStep",
    "RunResult",
    "SynthesisConfig",
    "TerrainClassifier",
    "TerrainError",
    "TerrainSpan",
    "Training",
    "check_run",
    "decode_image",
    "label_runs",
    "read_errors",
    "run_demo",
    "run_odometry",
    "sfta",
    "synthesise",
    "told_by_spans",
    "told_terrain",
    "train",
    "write_labelled_patches",
    "write_report",
    "write_results",
]
