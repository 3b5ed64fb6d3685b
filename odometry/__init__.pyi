from .dead_reckoning import dead_reckon
from .errors import OdometryError
from .estimation.config import IcrEkfConfig
from .estimation.estimate import Estimate
from .estimation.icr_ekf import IcrEkf
from .evaluation.relative import EvaluationConfig, position_errors, relative_errors
from .io.run_folder import write_run_folder
from .io.tum import read_tum, write_tum
from .models.catalogue import MODELS
from .parameters import ParameterSet, TerrainParameters, read_parameters, write_parameters
from .pipeline import ConstantTerrain, Replay, replay
from .run import Frame, Robot, Run
from .trajectory import Trajectory

__all__ = [
    "MODELS",
    "ConstantTerrain",
    "Estimate",
    "EvaluationConfig",
    "Frame",
    "IcrEkf",
    "IcrEkfConfig",
    "OdometryError",
    "ParameterSet",
    "Replay",
    "Robot",
    "Run",
    "TerrainParameters",
    "Trajectory",
    "dead_reckon",
    "position_errors",
    "read_parameters",
    "read_tum",
    "relative_errors",
    "replay",
    "write_parameters",
    "write_run_folder",
    "write_tum",
]
