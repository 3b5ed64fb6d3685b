"""More pairs, of other sorts of drives: to and fro, backward, eights, and others of the same kinds.

Written after `pairs`, by the equations alone: a second set on which changes are evaluated.
"""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import math

from tests.blind.hidden.courses import sign
from tests.blind.rivals import laws
from tests.blind.rivals.given import Given
from tests.blind.rivals.pair import Pair


def shuttled(rng, scene, g: Given):
    """To and fro at one speed, a share of the speed is a share that grows with it."""
    lost = rng.uniform(0.02, 0.1)
    return laws.wheels(1 - lost, 1 - lost), laws.slip_by_speed(lost / g.speed_m_s)


def only_backward(rng, scene, g: Given):
    kept = rng.uniform(0.88, 0.98)
    return laws.slip_backward(kept), laws.wheels(kept, kept)


def outer_limited(rng, scene, g: Given):
    """The outer tread of a circle to the left is the right one."""
    kept = rng.uniform(0.9, 0.98)
    _, outer = g.treads(scene)
    return laws.top_speed(kept * outer), laws.wheels(1.0, kept)


def arm_or_wheels(rng, scene, g: Given):
    """A sensor aside sees a smaller circle at the same turn rate, as treads of other sizes do."""
    aside = g.side * rng.uniform(0.04, 0.2)
    left, right = g.treads(scene)
    base = scene.base
    speed, turn = g.true_speed_m_s(scene), (right - left) / base.width
    new_left = speed * (1 - aside * g.bend(scene)) - turn * base.y_left
    return laws.arm(0.0, aside), laws.wheels(new_left / left, (new_left + right - left) / right)


def uphill_or_slip(rng, scene, g: Given):
    share = rng.uniform(0.3, 1.0)
    lost = share * math.sin(g.slope_rad)
    return laws.uphill(share), laws.slip_by_speed(lost / g.speed_m_s)


def creep_or_current(rng, scene, g: Given):
    """On a contour line, both carry the robot downhill."""
    share = rng.uniform(0.2, 0.8)
    speed = share * g.true_speed_m_s(scene) * math.sin(g.slope_rad)
    return laws.creep(share), laws.current(speed, math.pi)


def curved_both_ways(rng, scene, g: Given):
    wider, beta_2 = rng.uniform(1.5, 2.5), rng.uniform(0.2, 1.0)
    kept = 1 / g.widened(scene, wider, beta_2)
    return laws.curvature(scene.body, wider, beta_2), laws.traction(1.0, kept)


def forced_both_ways(rng, scene, g: Given):
    wider = rng.uniform(1.05, 1.4)
    return laws.inertia(scene.body, 0.0, g.eta_2(scene, wider)), laws.traction(1.0, 1 / wider)


def stretched_or_slip(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.08)
    stretched = laws.stretched(1 - lost, g.heading_rad)
    return stretched, laws.slip_by_speed(lost / g.speed_m_s)


def limited_or_stretched(rng, scene, g: Given):
    lost = rng.uniform(0.02, 0.08)
    stretched = laws.stretched(1 - lost, g.heading_rad)
    return laws.top_speed((1 - lost) * g.speed_m_s), stretched


def current_or_compass(rng, scene, g: Given):
    """On one heading, to be carried aside is to see a yaw that is off."""
    speed = sign(rng) * rng.uniform(0.02, 0.06)
    across = g.heading_rad + math.pi / 2
    turned = laws.compass(-math.atan2(speed, g.true_speed_m_s(scene)), g.heading_rad - math.pi / 2)
    return laws.current(speed, across), turned


MORE_PAIRS = {
    "shuttled": Pair(("wheel size", "tread slip"), "shuttle", shuttled),
    "only_backward": Pair(("tread slip", "wheel size"), "reverse", only_backward),
    "outer_limited": Pair(("drive limits", "wheel size"), "circle", outer_limited),
    "arm_or_wheels": Pair(("sensor place", "wheel size"), "circle", arm_or_wheels),
    "uphill_or_slip": Pair(("slope", "tread slip"), "climb", uphill_or_slip),
    "creep_or_current": Pair(("slope", "unknown"), "contour", creep_or_current),
    "curved_both_ways": Pair(("turn radius", "traction"), "eight", curved_both_ways),
    "forced_both_ways": Pair(("inertia", "traction"), "eight", forced_both_ways),
    "stretched_or_slip": Pair(("reference", "tread slip"), "one_heading", stretched_or_slip),
    "limited_or_stretched": Pair(
        ("drive limits", "reference"), "one_heading", limited_or_stretched
    ),
    "current_or_compass": Pair(("unknown", "reference"), "one_heading", current_or_compass),
}
