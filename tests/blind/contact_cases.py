"""Cases of the transient contact simulator: the effects arise from friction, load and mass."""

from dataclasses import asdict, dataclass

import numpy as np

from odometry.errors import SimulationError
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.vehicle import contact_vehicle
from tests.blind.commands import CALIBRATION_S, MEASURED_S, RATE_HZ, Limits, draw_commands
from tests.blind.drawn import Drawn
from tests.blind.motion import Motion
from tests.blind.robot import Icrs, draw_body
from tests.blind.sizes import NOISE_FLOOR_M, size_m

GRAVITY_M_S2 = 9.80665
ATTEMPTS = 8
LEAST_SIZE_OF_FLOOR = 2.0

# kind: (true effects, other acceptable names)
CONTACT = {
    "contact_slope": (("slope_sliding",), ()),
    "contact_inertia": (("inertia",), ()),
    "contact_curvature": (("curvature",), ("inertia", "none")),
    "contact_none": ((), ("curvature",)),
}


@dataclass(frozen=True)
class Planes:
    """A plane of its own for each drive of a stack: gradients (B,), rise per metre, x + i y."""

    gradients: tuple[complex, ...]

    def rise(self, points, heading):
        return self._each(points) * heading.conj()

    def rise_rate(self, points, velocity):  # noqa: ARG002
        return np.zeros_like(points)

    def heights_m(self, points):
        return (np.conj(self._each(points)) * points).real

    def _each(self, points):
        return np.repeat(self.gradients, len(points) // len(self.gradients))


def make_contact_case(kind, rng):
    """A vehicle on contacts whose slope or speed shows; the base ICRs are fitted to its truth."""
    effects, acceptable = CONTACT[kind]
    for _ in range(ATTEMPTS):
        body = draw_body(rng)
        contact, mu = _draw_contacts(rng, body)
        gradients = (0j, *(_gradient(rng) if kind == "contact_slope" else 0j for _ in range(2)))
        runs = _commands(kind, rng, body, mu)
        starts = np.column_stack(
            [rng.uniform(-50, 50, 3), rng.uniform(-50, 50, 3), rng.uniform(-np.pi, np.pi, 3)]
        )
        try:
            motions = _simulate(body, contact, gradients, runs, starts)
        except SimulationError:
            continue
        icrs = fitted_icrs(motions[0])
        shows = size_m(motions[1], icrs, {}) > LEAST_SIZE_OF_FLOOR * NOISE_FLOOR_M
        if shows or kind in ("contact_none", "contact_curvature"):
            break
    else:
        raise ValueError(f"{kind}: no drive of the wanted size in {ATTEMPTS} draws")
    named = dict(zip(("calibration", "measured", "holdout"), motions, strict=True))
    truth = {"base": icrs.values(), "contact": _truth(body, contact, mu, gradients)}
    drives = {name: (motion, {}) for name, motion in named.items()}
    return Drawn(body, drives, effects, truth, acceptable)


def fitted_icrs(motion):
    """ICRs with the least squares error of the true body rates, from a drive on level ground.

    With D = y_left - y_right: omega = (a_r v_r - a_l v_l) / D, v_x = a_l v_l + y_left omega.
    """
    rows = slice(0, len(motion.commands_m_s))
    omega = motion.yaw_rates_rad_s[rows]
    left, right = motion.commands_m_s.T
    v_x, v_y = _body_velocity(motion)
    by_left, by_right = np.linalg.lstsq(np.column_stack([left, right]), omega, rcond=None)[0]
    a_left, a_right = np.linalg.lstsq(np.column_stack([left, right]), v_x, rcond=None)[0]
    # omega = p v_l + q v_r and v_x = a v_l + b v_r have q = a_r/D, p = -a_l/D, a = -a_l y_r/D,
    # b = a_r y_l/D; so y_l = b / q and y_r = a / p.
    y_left, y_right = a_right / by_right, a_left / by_left
    width = y_left - y_right
    x_icr = -(omega @ v_y) / (omega @ omega)
    return Icrs(*map(float, (y_left, y_right, x_icr, -by_left * width, by_right * width)))


def _body_velocity(motion):
    """v_x and v_y on level ground, from differences of the poses."""
    place = motion.poses[:, 0] + 1j * motion.poses[:, 1]
    velocity = np.gradient(place, motion.step_s) * np.exp(-1j * motion.poses[:, 4])
    return velocity.real, velocity.imag


def _draw_contacts(rng, body):
    """The table [contact] of a vehicle, and its friction."""
    mu = rng.uniform(0.4, 0.9)
    contacts = int(rng.integers(2, 5))
    places = np.linspace(-body.half_length, body.half_length, contacts)
    slip = {"law": "coulomb", "rounding": rng.uniform(0.003, 0.02)}
    if rng.uniform() < 0.5:
        slip = {"law": "shear", "modulus": 0.02 * body.track_width * rng.uniform(0.3, 1.0)}
    table = {
        "x_cm": body.half_length * rng.uniform(-0.15, 0.15),
        "y_cm": body.half_width * rng.uniform(-0.06, 0.06),
        "height": body.half_width * rng.uniform(0.5, 1.0),
        "yaw_inertia": body.mass * (body.length**2 + body.width**2) / 12 * rng.uniform(0.8, 1.3),
        "places": places.tolist(),
        "patch_length": body.wheel_radius * rng.uniform(0.4, 0.8),
        "friction": mu,
        "settling": rng.uniform(0.1, 0.2),
        **slip,
    }
    return table, mu


def _gradient(rng):
    slope, uphill = np.deg2rad(rng.uniform(4.0, 9.0)), rng.uniform(-np.pi, np.pi)
    return complex(np.tan(slope) * np.exp(1j * uphill))


def _commands(kind, rng, body, mu):
    """Commands of the three runs, of their own lengths."""
    width = body.track_width * (1 + 0.75 * body.half_length / body.half_width)
    slow = Limits(0.5, 1.0, 1.0, width)
    fast = {
        "contact_slope": Limits(rng.uniform(0.5, 0.65), 1.0, 1.0, width),
        "contact_inertia": Limits(
            rng.uniform(1.2, 1.8),
            rng.uniform(1.5, 2.2),
            mu * GRAVITY_M_S2 * rng.uniform(0.35, 0.5),
            width,
        ),
        "contact_curvature": Limits(rng.uniform(0.6, 0.9), rng.uniform(1.0, 1.8), 1.0, width),
        "contact_none": slow,
    }[kind]
    durations = (CALIBRATION_S, MEASURED_S, MEASURED_S)
    return [
        draw_commands(rng, duration, limits)
        for duration, limits in zip(durations, (slow, fast, fast), strict=True)
    ]


def _simulate(body, contact, gradients, runs, starts):
    """Motions of the three runs, driven as one stack; the shortest rests at its end."""
    longest = max(map(len, runs))
    stack = np.stack([np.pad(run, ((0, longest - len(run)), (0, 0))) for run in runs])
    vehicle = contact_vehicle(asdict(body), contact)
    drives = simulate_contact(
        vehicle, stack, 1 / RATE_HZ, ground=Planes(gradients), start_poses=starts
    )
    poses = drives.poses_world[..., [0, 1, 3, 4, 5]]
    return [
        Motion(1 / RATE_HZ, run, poses[i, : len(run)], drives.twists_body[i, : len(run), 2])
        for i, run in enumerate(runs)
    ]


def _truth(body, contact, mu, gradients):
    slopes = [float(np.rad2deg(np.arctan(abs(gradient)))) for gradient in gradients[1:]]
    return {
        "mu": mu,
        "mass": body.mass,
        "x_cm": contact["x_cm"],
        "y_cm": contact["y_cm"],
        "height": contact["height"],
        "half_length": body.half_length,
        "half_width": body.half_width,
        "contacts": 2 * len(contact["places"]),
        "law": contact["law"],
        "slopes_deg": slopes,
    }
