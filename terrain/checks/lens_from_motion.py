"""A lens or a pitch under which terrain does not move through the images as a rigid plane."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from odometry.arrays import BoolArray, FloatArray, IntArray, spread
from odometry.checks.findings.finding import Finding, Level
from terrain.calibration.flow_solver import GroundFlow, Solution, solve_mount
from terrain.calibration.tracks import Tracks
from terrain.camera.camera import Camera
from terrain.camera.distortion import undistort
from terrain.checks.ground_steps import STEADY, GroundSteps, moved_terrain
from terrain.checks.image_agreement import ImageMotion
from terrain.checks.terrain_views import Pixels

# Terrain that changes its size from image to image, of 1 and in standard deviations of the median:
# right cameras have 0.012 and 2.5 (rocking ones, and some that look steeply, included)
RESIZED, SURE = 0.015, 4.0
FAR = 0.05  # a wrong lens without doubt, though no single number mends it
ONE_PIECE = 0.6  # of the features that look alike: right cameras leave 0.69 and more
FACTORS = (0.5, 0.6, 0.72, 0.85, 1.18, 1.4, 1.67, 2.0)  # of the focal length, at first
# Of the loss: another number that leaves so little more may be it as well. Steady cameras tell
# pitch, focal length and stretched images apart by 0.04 and more; one that rocks does not
AS_GOOD = 1.02
FEATURES, FEATURE_PX = 1200, 1.0  # that are fitted, and how far off they are found usually
# Standard deviations of a step of the treads, which slip, in which a robot swings about its ICR
STEP_M, STEP, SWING_M, TURN_RAD = 0.01, 0.1, 0.4, 0.01
BY_GYROSCOPE, BY_TREADS = 0.05, 0.3  # of a turn
HEIGHT, PITCH, YAW = 0, 2, 3  # places of height, roll, pitch and yaw
OTHER_HEIGHT = 1.2  # a factor that is stated, as for the height alone


def wrong_lens(motion: ImageMotion, camera: Camera, *, agrees: bool = True) -> Iterator[Finding]:
    """Name the pitch or the focal length that fits, where those of `[camera]` do not; at most one.

    A turn of the robot and its way change no size of the terrain: where most pairs of images say
    they do, the ground is projected wrongly. No number is fitted where the motion in images does
    not agree with that of the treads.
    """
    steps = motion.steps
    middle, spread_of = steps.scale
    if abs(middle) < max(RESIZED, SURE * 1.25 * spread_of / np.sqrt(len(steps))):
        return
    found = sorted(_tried(motion, camera), key=lambda one: one.loss) if agrees else []
    explains = bool(found) and _is_right(found[0].camera, steps)
    if not explains and abs(middle) < FAR:
        return
    likely = [one.words for one in found if explains and one.loss < AS_GOOD * found[0].loss]
    yield Finding(
        "camera_lens",
        Level.WARNING,
        f"terrain becomes {100 * abs(np.expm1(middle)):.1f} % "
        f"{'larger' if middle < 0 else 'smaller'} from the first to the second image of a pair, "
        f"by {len(steps)} pairs: under the right lens and mount it keeps its size",
        ", or ".join(likely) or OTHER_CAMERA,
        BY_MOTION if likely and found[0].is_pitch else CALIBRATE,
    )


OTHER_CAMERA = (
    "Lens and mount are of another camera, or images were cropped or scaled after the calibration"
)
CALIBRATE = (
    "Calibrate the lens with images as they are recorded, and find the mount with camera "
    "--from-motion"
)
BY_MOTION = (
    "Find the mount with camera --from-motion, or correct its pitch; where that was measured, "
    "calibrate the lens"
)


@dataclass(frozen=True, eq=False)
class Fitted:
    """A camera with one number changed, and what that leaves.

    Attributes
    ----------
    camera : Camera
    loss : float
        Of all features that are fitted [nats].
    words : str
    is_pitch : bool
    """

    camera: Camera
    loss: float
    words: str
    is_pitch: bool = False


def _tried(motion: ImageMotion, camera: Camera) -> Iterator[Fitted]:
    if camera.mount is None or not motion.steps.matches:
        return
    fit = _Fit(motion, camera)
    loss, mounted = fit.solved(camera, [HEIGHT, PITCH, YAW])
    degrees, stated = (float(np.degrees(of[4])) for of in (_mount(mounted), camera.mount))
    words = f"The camera points {degrees:.1f} degrees down, not {stated:.1f} as its pitch says"
    yield Fitted(mounted, loss, words + _height(mounted, camera), is_pitch=True)
    for by, what in ((np.array([1.0, 1.0]), "The"), (np.array([0.0, 1.0]), "The vertical")):
        factor, loss, changed = fit.of_focal_lengths(by)
        why = (
            "images were cropped, zoomed or scaled after the calibration, or the lens is another"
            if by.all()
            else "images were stretched"
        )
        words = f"{what} focal length is {factor:.3g} times that of matrix: {why}"
        yield Fitted(changed, loss, words + _height(changed, camera))


def fitted_pitch(motion: ImageMotion, camera: Camera) -> float | None:
    """The pitch [rad] that fits the steps of a motion; None where terrain does not then fit."""
    if camera.mount is None or not motion.steps.matches:
        return None
    _, mounted = _Fit(motion, camera).solved(camera, [HEIGHT, PITCH, YAW])
    return float(_mount(mounted)[4]) if _is_right(mounted, motion.steps) else None


def _height(fitted: Camera, camera: Camera) -> str:
    ratio = fitted.height_m / camera.height_m
    if 1 / OTHER_HEIGHT < ratio < OTHER_HEIGHT:
        return ""
    return f", at a height of {fitted.height_m:.3g} m"


def _is_right(camera: Camera, steps: GroundSteps) -> bool:
    """Whether terrain keeps its size by another camera, and moves as one piece."""
    moved = (moved_terrain(camera, same) for same in steps.matches)
    found = [one for one in moved if one is not None]
    if len(found) <= len(steps) / 2:
        return False
    *_, scales, shares = np.array(found).T
    resized, share = replace(steps, scales=scales).scale[0], float(np.median(shares))
    return abs(resized) < STEADY and share > ONE_PIECE


class _LooseFlow(GroundFlow):
    """Steps that are those of the treads, more or less."""

    turn_share: float = BY_GYROSCOPE

    @cached_property
    def step_sigmas(self) -> FloatArray:
        """Standard deviations (P, 3) of the steps."""
        steps = self.tracks.steps
        length_m, turn_rad = np.linalg.norm(steps[:, :2], axis=1), np.abs(steps[:, 2])
        along_m = STEP_M + STEP * length_m
        turns = TURN_RAD + self.turn_share * turn_rad
        return np.column_stack([along_m, along_m + SWING_M * turn_rad, turns])


class _TreadFlow(_LooseFlow):
    turn_share = BY_TREADS


@dataclass(frozen=True, eq=False)
class _Fit:
    """Features of a run, and the steps of its robot, for one camera after the other."""

    motion: ImageMotion
    camera: Camera

    def solved(self, camera: Camera, free: list[int]) -> tuple[float, Camera]:
        """Loss, and the camera whose mount fits best."""
        flow, mount = self._flow(camera), _mount(camera)
        solution = solve_mount(flow, mount[2:], _chosen(free), FEATURE_PX)
        changed = np.concatenate([mount[:2], solution.values])
        return _loss(flow, solution), Camera.from_mount(
            camera.image_size, camera.matrix, camera.distortion, changed
        )

    def of_focal_lengths(self, by: FloatArray) -> tuple[float, float, Camera]:
        """Factor of the focal lengths (horizontal, vertical), its loss, and the camera."""

        def solved(log: float) -> tuple[float, Camera]:
            return self.solved(_scaled(self.camera, np.exp(log * by)), [HEIGHT, YAW])

        logs = np.log(FACTORS)
        best = float(logs[np.argmin([solved(float(log))[0] for log in logs])])
        loss_of: Callable[[float], float] = lambda log: solved(log)[0]  # noqa: E731
        near = (best - 0.2, best + 0.2)
        best = float(minimize_scalar(loss_of, bounds=near, options={"xatol": 0.01}).x)
        return (float(np.exp(best)), *solved(best))

    def _flow(self, camera: Camera) -> GroundFlow:
        before, after = (_rays(camera, pixels) for pixels in self._pixels)
        known = np.isfinite(np.hstack([before, after])).all(axis=1)
        tracks = Tracks(
            before[known], after[known], self._pair[known], self._steps, len(self._steps)
        )
        has_gyroscope = self.motion.run.yaw_rate is not None
        kind = _LooseFlow if has_gyroscope else _TreadFlow
        return kind(tracks, _mount(camera)[:2], float(np.mean(np.diag(camera.matrix)[:2])))

    @cached_property
    def _kept(self) -> IntArray:
        return spread(sum(len(first) for first, _ in self.motion.steps.matches), FEATURES)

    @cached_property
    def _pixels(self) -> Pixels:
        first, second = (np.concatenate(of) for of in zip(*self.motion.steps.matches, strict=True))
        return first[self._kept], second[self._kept]

    @cached_property
    def _pair(self) -> IntArray:
        counts = [len(first) for first, _ in self.motion.steps.matches]
        return np.asarray(np.repeat(np.arange(len(counts)), counts)[self._kept])

    @cached_property
    def _steps(self) -> FloatArray:
        travel_m, turn_rad = (of[self.motion.best] for of in self.motion.robot_at_lags)
        moved = travel_m * np.sinc(turn_rad / (2 * np.pi)) * np.exp(0.5j * turn_rad)
        return np.column_stack([moved.real, moved.imag, turn_rad])


def _loss(flow: GroundFlow, solution: Solution) -> float:
    return flow.cost(solution.values, solution.motions, FEATURE_PX)


def _chosen(free: list[int]) -> BoolArray:
    return np.isin(np.arange(4), free)


def _mount(camera: Camera) -> FloatArray:
    return np.zeros(6) if camera.mount is None else camera.mount


def _scaled(camera: Camera, by: FloatArray) -> Camera:
    matrix = camera.matrix.copy()
    matrix[[0, 1], [0, 1]] *= by
    return Camera.from_mount(camera.image_size, matrix, camera.distortion, _mount(camera))


def _rays(camera: Camera, pixels: FloatArray) -> FloatArray:
    normalised = (pixels - camera.matrix[:2, 2]) / np.diag(camera.matrix)[:2]
    return undistort(normalised, camera.distortion)
