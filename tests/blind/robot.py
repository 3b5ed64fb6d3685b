"""Robots of three sizes, each seed another one."""

from dataclasses import asdict, dataclass

# name: track_width, length, width, wheel_radius [m], mass [kg]
SIZES = {
    "pioneer": (0.40, 0.51, 0.50, 0.11, 24.0),
    "husky": (0.55, 0.99, 0.67, 0.165, 50.0),
    "warthog": (1.08, 1.52, 1.38, 0.30, 590.0),
}
AXLES_OF_LENGTH = 0.62  # between the outer axles, as a share of the robot's length


@dataclass(frozen=True)
class Body:
    """The table [robot] of run.toml."""

    name: str
    track_width: float
    length: float
    width: float
    wheel_radius: float
    mass: float

    @property
    def half_width(self):
        return self.track_width / 2

    @property
    def half_length(self):
        return AXLES_OF_LENGTH * self.length / 2


@dataclass(frozen=True)
class Icrs:
    """Places of the tread ICRs [m] and factors of the tread speeds (data/README.md)."""

    y_left: float
    y_right: float
    x_icr: float
    alpha_left: float = 1.0
    alpha_right: float = 1.0

    @property
    def width(self):
        return self.y_left - self.y_right

    def values(self):
        return asdict(self)


def draw_body(rng):
    name = str(rng.choice(list(SIZES)))
    sizes = [round(float(size * rng.uniform(0.92, 1.08)), 3) for size in SIZES[name]]
    return Body(f"{name}_like", *sizes)


def draw_icrs(rng, body):
    """Asymmetric ICRs outside the treads."""
    spread = rng.uniform(1.15, 1.8)
    left, right = spread * body.half_width * rng.uniform(0.93, 1.07, size=2)
    return Icrs(
        y_left=float(left),
        y_right=-float(right),
        x_icr=float(0.08 * body.length * rng.uniform(-1.0, 1.0)),
        alpha_left=float(rng.uniform(0.96, 1.02)),
        alpha_right=float(rng.uniform(0.96, 1.02)),
    )
