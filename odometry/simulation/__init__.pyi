from .commands import segments
from .contact.drive import simulate_contact
from .contact.slope import Plane
from .contact.vehicle import read_contact_vehicle
from .courses import STEP_S, Course, make_course
from .record import ContactSensors, write_contact_run
from .skid_experiments import (
    SENSORS,
    calibration_courses,
    calibration_runs,
    ground_traction,
    terrain_experiment,
)

__all__ = [
    "SENSORS",
    "STEP_S",
    "ContactSensors",
    "Course",
    "Plane",
    "calibration_courses",
    "calibration_runs",
    "ground_traction",
    "make_course",
    "read_contact_vehicle",
    "segments",
    "simulate_contact",
    "terrain_experiment",
    "write_contact_run",
]
