"""The drives that are given: each of one sort, so that two hypotheses say the same about it."""

import math
from dataclasses import dataclass

import numpy as np

from tests.blind.formula import force_of_inertia, half_width_by_curvature, icr_twist
from tests.blind.hidden.courses import sign
from tests.blind.hidden.scene import Drive
from tests.blind.rivals.drives import Proposal, as_held, drive_of, waves

# given: (shape of the drive, whether it is on a slope)
GIVEN = {
    "straight": ("straight", False),
    "circle": ("circle", False),
    "spin": ("spin", False),
    "waves": ("waves", False),
    "one_heading": ("straight", False),
    "contour": ("straight", True),
    "climb": ("straight", True),
    "shuttle": ("shuttle", False),
    "reverse": ("straight", False),
    "eight": ("circles", False),
}


@dataclass(frozen=True)
class Given:
    """Sizes of the drive that is given.

    Attributes
    ----------
    name : str
        Of `GIVEN`.
    speed_m_s : float
        Of the middle, negative backward; of each tread in a spin.
    radius_m : float
        Of a circle, to the left where it is positive.
    heading_rad : float or None
        That all runs have, where they have one.
    slope_rad : float
        Uphill is along x.
    side : float
        1 or -1: to the left; with a contour line, uphill on the left.
    """

    name: str
    speed_m_s: float
    radius_m: float
    heading_rad: float | None
    slope_rad: float
    side: float

    def bend(self, scene):
        """Yaw rate per speed on the circle, of the base model [1/m]."""
        v_x, _, omega = self._twist(scene)
        return omega / v_x

    def true_speed_m_s(self, scene):
        return self._twist(scene)[0]

    def widened(self, scene, wider, beta_2):
        """Width by curvature on the circle, as a factor of the calibrated one."""
        body, base = scene.body, scene.base
        p = {
            "beta_1": wider * base.width / body.track_width - 1.0,
            "beta_2": beta_2,
            "track_width": body.track_width,
        }
        left, right = (np.array([speed]) for speed in self.treads(scene))
        return float(2 * half_width_by_curvature(left, right, p)[0] / base.width)

    def force_n(self, scene, wider=1.0):
        """Force of inertia on the circle, with a width wider by a factor."""
        v_x, v_y, omega = self._twist(scene)
        p = {"mass": scene.body.mass, "x_cm": 0.0, "y_cm": 0.0}
        return float(force_of_inertia((v_x, v_y / wider, omega / wider), p))

    def eta_2(self, scene, wider):
        """Coefficient that makes the width wider by this factor on the circle."""
        eta = scene.base.width / scene.body.track_width
        return eta * (wider - 1.0) / self.force_n(scene, wider) ** 2

    def drive(self, rng, scene, duration_s):
        """One run of it."""
        shape, _ = GIVEN[self.name]
        radius = self.radius_m if shape != "spin" else self.side
        asked = Proposal(
            "straight" if shape == "waves" else shape,
            self.speed_m_s,
            radius,
            duration_s,
            self.slope_rad,
            self.heading_rad,
        )
        drive = drive_of(rng, scene, asked)
        if shape != "waves":
            return drive
        return Drive(as_held(waves(asked), scene), drive.ground, drive.start, None)

    def treads(self, scene):
        """Speeds of the left and the right one [m/s]."""
        half = self.speed_m_s / self.radius_m * scene.base.width / 2
        return self.speed_m_s - half, self.speed_m_s + half

    def _twist(self, scene):
        base = scene.base
        if math.isinf(self.radius_m):
            return self.speed_m_s * base.alpha_left, 0.0, 0.0
        return icr_twist(*self.treads(scene), base.y_left, base.y_right, base.x_icr)


def draw_given(rng, scene, name):
    """Sizes that a driver might choose; a spin and left turns are to the left."""
    shape, sloped = GIVEN[name]
    side = 1.0 if shape in ("spin", "circle", "circles") else sign(rng)
    heading = float(rng.uniform(-math.pi, math.pi)) if name == "one_heading" else None
    if sloped:
        heading = -side * math.pi / 2 if name == "contour" else 0.0
    speed = float(rng.uniform(0.3, 0.5) if shape == "spin" else rng.uniform(0.7, 1.0))
    round_ = shape in ("circle", "circles")
    return Given(
        name,
        speed_m_s=-speed if name == "reverse" else speed,
        radius_m=float(rng.uniform(1.2, 2.5) * scene.base.width) if round_ else math.inf,
        heading_rad=heading,
        slope_rad=float(np.deg2rad(rng.uniform(4.0, 8.0))) if sloped else 0.0,
        side=side,
    )
