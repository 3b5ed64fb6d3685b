from .camera.camera import Camera
from .checks.recording import check_run
from .classification.answer import Classification
from .classification.classifier import TerrainClassifier
from .classification.features.network_features import NetworkFeatures
from .classification.photographs.patches import cut_patches
from .classification.sfta_features import SftaFeatures
from .classification.training import Training, train
from .config import Config
from .demo import run_demo
from .errors import TerrainError
from .images import decode_image, read_image, to_grey
from .labelling.given_terrain import TerrainSpan, given_by_spans, given_terrain
from .labelling.label_runs import label_runs
from .labelling.patch_files import write_labelled_patches
from .labelling.scale import LabelConfig
from .live.live_odometry import LiveOdometry
from .live.live_step import LiveStep
from .main_job import run_odometry
from .region.footprint_parts import Rectangle
from .region.warp import ground_view
from .report.page import write_report
from .result.run_result import RunResult
from .result.switch_delay import switch_delays, true_stretches
from .results import read_errors, write_results
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
    "NetworkFeatures",
    "Rectangle",
    "RunResult",
    "SftaFeatures",
    "SynthesisConfig",
    "TerrainClassifier",
    "TerrainError",
    "TerrainSpan",
    "Training",
    "check_run",
    "cut_patches",
    "decode_image",
    "given_by_spans",
    "given_terrain",
    "ground_view",
    "label_runs",
    "read_errors",
    "read_image",
    "run_demo",
    "run_odometry",
    "sfta",
    "switch_delays",
    "synthesise",
    "to_grey",
    "train",
    "true_stretches",
    "write_labelled_patches",
    "write_report",
    "write_results",
]
