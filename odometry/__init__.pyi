from .bags.files.messages import BagMessage, bag_messages
from .checks.findings.finding import CheckReport, Finding
from .checks.recording import check_recording
from .comparison.compare import compare
from .dead_reckoning import dead_reckon, dead_reckon_in_space
from .errors import IdentificationError, OdometryError
from .estimation.config import IcrEkfConfig
from .estimation.estimate import Estimate
from .estimation.icr_ekf import IcrEkf
from .evaluation.open_loop import fitness, measured_poses, open_loop
from .evaluation.relative import EvaluationConfig, position_errors, relative_errors
from .evaluation.score import reference_of, score
from .evaluation.stretches import stretches
from .feel.identify_feel import identify_feel
from .feel.labels.follow import follow_feel
from .feel.labels.live import LiveFeel
from .feel.model import FeelModel
from .feel.model_file import read_feel_model, write_feel_model
from .feel.recorded.windows import feel_windows
from .gap.gap import find_gap
from .geometry.tilt import steepest_slope
from .icrs.measured import icr_medians, measured_icrs
from .icrs.points import icr_covariances, icr_indices, icrs_of_twist, turn_is_known
from .identification.identify import identify
from .identification.start import SolverConfig
from .installed import shipped_data
from .io.run_folder import write_run_folder
from .io.trajectory_files import read_trajectory, write_trajectory
from .io.tum import read_spatial_tum, read_tum, write_spatial_tum, write_tum
from .models.catalogue import MODELS, model_named
from .models.inputs import Inputs
from .modes.follow.followed import followed
from .modes.follow.track import ModeTrack, follow_modes
from .modes.identify.identify_traction import identify_traction_modes
from .modes.identify.identify_velocity import identify_velocity_modes
from .modes.models.mode_set import ModeSet
from .modes.models.mode_set_file import read_mode_set, write_mode_set
from .parameters import ParameterSet, TerrainParameters, read_parameters, write_parameters
from .recording.frames import Frame
from .recording.live_frames import LiveFrames
from .recording.run import Robot, Run
from .recording.run_span import Span, cut_run
from .replays.estimates import Replay
from .replays.pipeline import ConstantTerrain, replay
from .simulation.contact.drive import simulate_contact
from .trajectory import SpatialTrajectory, Trajectory
from .windows.config import WindowConfig
from .windows.recorded.run_inputs import inputs_of
from .windows.travel.windows import windows_of
from .windows.window_errors import window_errors

__all__ = [
    "MODELS",
    "BagMessage",
    "CheckReport",
    "ConstantTerrain",
    "Estimate",
    "EvaluationConfig",
    "FeelModel",
    "Finding",
    "Frame",
    "IcrEkf",
    "IcrEkfConfig",
    "IdentificationError",
    "Inputs",
    "LiveFeel",
    "LiveFrames",
    "ModeSet",
    "ModeTrack",
    "OdometryError",
    "ParameterSet",
    "Replay",
    "Robot",
    "Run",
    "SolverConfig",
    "Span",
    "SpatialTrajectory",
    "TerrainParameters",
    "Trajectory",
    "WindowConfig",
    "bag_messages",
    "check_recording",
    "compare",
    "cut_run",
    "dead_reckon",
    "dead_reckon_in_space",
    "feel_windows",
    "find_gap",
    "fitness",
    "follow_feel",
    "follow_modes",
    "followed",
    "icr_covariances",
    "icr_indices",
    "icr_medians",
    "icrs_of_twist",
    "identify",
    "identify_feel",
    "identify_traction_modes",
    "identify_velocity_modes",
    "inputs_of",
    "measured_icrs",
    "measured_poses",
    "model_named",
    "open_loop",
    "position_errors",
    "read_feel_model",
    "read_mode_set",
    "read_parameters",
    "read_spatial_tum",
    "read_trajectory",
    "read_tum",
    "reference_of",
    "relative_errors",
    "replay",
    "score",
    "shipped_data",
    "simulate_contact",
    "steepest_slope",
    "stretches",
    "turn_is_known",
    "window_errors",
    "windows_of",
    "write_feel_model",
    "write_mode_set",
    "write_parameters",
    "write_run_folder",
    "write_spatial_tum",
    "write_trajectory",
    "write_tum",
]
