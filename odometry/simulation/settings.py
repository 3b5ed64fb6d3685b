"""What made a simulated run, as the table [simulation] of run.toml keeps it."""

from dataclasses import asdict
from typing import Any

from odometry.simulation.contact.traction import Traction
from odometry.simulation.contact.vehicle import ContactVehicle


def vehicle_settings(vehicle: ContactVehicle) -> dict[str, Any]:
    """Everything of a vehicle that [robot] does not say."""
    x, y, height = vehicle.centre_of_mass_m
    return {
        "yaw_inertia_kg_m2": vehicle.yaw_inertia_kg_m2,
        "x_cm": x,
        "y_cm": y,
        "height": height,
        "contact_x_m": vehicle.contact_x_m.tolist(),
        "friction": vehicle.friction.tolist(),
        "entry_m": vehicle.entry_m.tolist(),
        "settling_s": vehicle.settling_s,
        "law": named_settings(vehicle.law),
    }


def traction_settings(piece: Traction) -> dict[str, Any]:
    """All of a piece; its friction as rows left and right."""
    return {
        "name": piece.name,
        "from_s": piece.from_s,
        "friction": piece.friction.tolist(),
        "lateral_share": piece.lateral_share,
        "law": named_settings(piece.law),
    }


def named_settings(block: Any) -> dict[str, Any]:
    """A frozen block with the name of its kind."""
    content = {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(block).items()}
    return {"kind": type(block).__name__, **content}
