"""Pairs of hypotheses that drives of one sort cannot distinguish, matched by closed forms.

Each pair draws the size of the first and sets the second so that both make the same twist, or the
same pose, on the drive that is given: a straight at one speed, a circle, a spin, slow waves, a
straight on one heading, a line on a slope.
"""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import math

from tests.blind.hidden.courses import sign
from tests.blind.rivals import laws
from tests.blind.rivals.given import Given
from tests.blind.rivals.pair import Pair


def wheels_or_slip(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.wheels(1 - lost, 1 - lost), laws.slip_by_speed(lost / g.speed_m_s)


def wheels_or_limit(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.wheels(1 - lost, 1 - lost), laws.top_speed((1 - lost) * g.speed_m_s)


def slip_or_limit(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.slip_by_speed(lost / g.speed_m_s), laws.top_speed((1 - lost) * g.speed_m_s)


def wheels_or_traction(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.wheels(1 - lost, 1 - lost), laws.traction(1 - lost, 1.0)


def traction_or_limit(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.traction(1 - lost, 1.0), laws.top_speed((1 - lost) * g.speed_m_s)


def slip_or_pump(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.1)
    return laws.slip_by_speed(lost / g.speed_m_s), laws.pump(lost / g.speed_m_s)


def skid_or_heading(rng, scene, g: Given):
    """On a circle v_y = -x omega, as a yaw that is off by -x omega / v."""
    ahead = sign(rng) * rng.uniform(0.04, 0.2)
    return laws.skid(ahead), laws.turned_yaw(math.atan(ahead * g.bend(scene)))


def arm_or_heading(rng, scene, g: Given):
    ahead = sign(rng) * rng.uniform(0.04, 0.2)
    return laws.arm(ahead, 0.0), laws.turned_yaw(-math.atan(ahead * g.bend(scene)))


def arm_or_traction(rng, scene, g: Given):
    """An arm to the left of a circle to the left goes round a smaller one."""
    aside = g.side * rng.uniform(0.04, 0.25)
    return laws.arm(0.0, aside), laws.traction(1 - aside * g.bend(scene), 1.0)


def curvature_or_traction(rng, scene, g: Given):
    wider, beta_2 = rng.uniform(1.5, 2.5), rng.uniform(0.2, 1.0)
    return laws.curvature(scene.body, wider, beta_2), laws.traction(
        1.0, 1 / g.widened(scene, wider, beta_2)
    )


def curvature_or_inertia(rng, scene, g: Given):
    wider, beta_2 = rng.uniform(1.5, 2.5), rng.uniform(0.2, 1.0)
    width = g.widened(scene, wider, beta_2)
    return laws.curvature(scene.body, wider, beta_2), laws.inertia(
        scene.body, 0.0, g.eta_2(scene, width)
    )


def inertia_or_traction(rng, scene, g: Given):
    wider = rng.uniform(1.05, 1.4)
    return laws.inertia(scene.body, 0.0, g.eta_2(scene, wider)), laws.traction(1.0, 1 / wider)


def inertia_or_skid(rng, scene, g: Given):
    ahead = rng.uniform(0.04, 0.2)
    return laws.inertia(scene.body, ahead / g.force_n(scene), 0.0), laws.skid(ahead)


def backward_or_wheel(rng, scene, g: Given):
    """In a spin to the left the left tread alone runs backward."""
    kept = rng.uniform(0.85, 0.97)
    return laws.slip_backward(kept), laws.wheels(kept, 1.0)


def left_turns_or_traction(rng, scene, g: Given):
    kept = rng.uniform(0.8, 0.96)
    return laws.left_turns(kept), laws.traction(1.0, kept)


def late_or_sluggish(rng, scene, g: Given):
    delay_s = round(rng.uniform(0.15, 0.4), 2)
    return laws.late_commands(delay_s), laws.sluggish(delay_s)


def stamps_or_sluggish(rng, scene, g: Given):
    delay_s = round(rng.uniform(0.15, 0.4), 2)
    return laws.late_stamps(delay_s), laws.sluggish(delay_s)


def current_or_heading(rng, scene, g: Given):
    """On one heading, to be carried to the left is to see too small a yaw."""
    speed = sign(rng) * rng.uniform(0.02, 0.08)
    return laws.current(speed, g.heading_rad + math.pi / 2), laws.turned_yaw(
        -math.atan2(speed, g.true_speed_m_s(scene))
    )


def stretched_or_wheels(rng, scene, g: Given):
    factor = 1 + sign(rng) * rng.uniform(0.02, 0.08)
    return laws.stretched(factor, g.heading_rad), laws.wheels(factor, factor)


def compass_or_heading(rng, scene, g: Given):
    most = sign(rng) * rng.uniform(0.02, 0.08)
    phase = g.heading_rad - math.pi / 2
    return laws.compass(most, phase), laws.turned_yaw(most)


def creep_or_heading(rng, scene, g: Given):
    """On a contour line, downhill is always to one side."""
    share = rng.uniform(0.2, 0.8)
    return laws.creep(share), laws.turned_yaw(g.side * math.atan(share * math.sin(g.slope_rad)))


def uphill_or_wheels(rng, scene, g: Given):
    share = rng.uniform(0.3, 1.0)
    kept = 1 - share * math.sin(g.slope_rad)
    return laws.uphill(share), laws.wheels(kept, kept)


PAIRS = {
    "wheels_or_slip": Pair(("wheel size", "tread slip"), "straight", wheels_or_slip),
    "wheels_or_limit": Pair(("wheel size", "drive limits"), "straight", wheels_or_limit),
    "slip_or_limit": Pair(("tread slip", "drive limits"), "straight", slip_or_limit),
    "wheels_or_traction": Pair(("wheel size", "traction"), "straight", wheels_or_traction),
    "traction_or_limit": Pair(("traction", "drive limits"), "straight", traction_or_limit),
    "slip_or_pump": Pair(("tread slip", "unknown"), "straight", slip_or_pump),
    "skid_or_heading": Pair(("sideways", "sensor heading"), "circle", skid_or_heading),
    "arm_or_heading": Pair(("sensor place", "sensor heading"), "circle", arm_or_heading),
    "arm_or_traction": Pair(("sensor place", "traction"), "circle", arm_or_traction),
    "curvature_or_traction": Pair(("turn radius", "traction"), "circle", curvature_or_traction),
    "curvature_or_inertia": Pair(("turn radius", "inertia"), "circle", curvature_or_inertia),
    "inertia_or_traction": Pair(("inertia", "traction"), "circle", inertia_or_traction),
    "inertia_or_skid": Pair(("inertia", "sideways"), "circle", inertia_or_skid),
    "left_turns_or_traction": Pair(("unknown", "traction"), "circle", left_turns_or_traction),
    "backward_or_wheel": Pair(("tread slip", "wheel size"), "spin", backward_or_wheel),
    "late_or_sluggish": Pair(("late commands", "slow drive"), "waves", late_or_sluggish),
    "stamps_or_sluggish": Pair(
        ("late stamps", "slow drive"), "waves", stamps_or_sluggish, gyroscope=False
    ),
    "current_or_heading": Pair(("unknown", "sensor heading"), "one_heading", current_or_heading),
    "stretched_or_wheels": Pair(("reference", "wheel size"), "one_heading", stretched_or_wheels),
    "compass_or_heading": Pair(("reference", "sensor heading"), "one_heading", compass_or_heading),
    "creep_or_heading": Pair(("slope", "sensor heading"), "contour", creep_or_heading),
    "uphill_or_wheels": Pair(("slope", "wheel size"), "climb", uphill_or_wheels),
}
