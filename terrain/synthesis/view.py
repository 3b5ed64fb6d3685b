"""The image of a textured terrain by a camera on the robot, from brightness to bytes."""

from dataclasses import dataclass
from typing import Self

import cv2
import numpy as np

from odometry.arrays import AnyArray, BoolArray, ByteImage, FloatArray
from odometry.simulation.ground import GroundMap, to_world
from terrain.camera.camera import Camera
from terrain.errors import SynthesisError
from terrain.synthesis.texture import Texture

BLUR_PX = 0.5
NOISE_GREY_LEVELS = 2.0


@dataclass(frozen=True)
class Illumination:
    """Light on one frame.

    Attributes
    ----------
    gain : float
        Factor on the brightness.
    slope : float
        Relative change of the gain from the middle to the right edge of the image.
    """

    gain: float
    slope: float

    @classmethod
    def at(cls, time_s: float, phases_rad: tuple[float, float]) -> Self:
        """Light that changes slowly along a run, as under passing clouds."""
        gain = 1.0 + 0.08 * np.sin(2 * np.pi * time_s / 31.0 + phases_rad[0])
        return cls(float(gain), float(0.05 * np.sin(2 * np.pi * time_s / 17.0 + phases_rad[1])))


def expose(brightness: AnyArray, light: Illumination, rng: np.random.Generator) -> ByteImage:
    """Image (H, W) or (H, W, 3) of a scene of `brightness` (0 to 255) in this light."""
    width = brightness.shape[1]
    gain = light.gain * (1 + light.slope * np.linspace(-1, 1, width, dtype=np.float32))
    gain = gain if brightness.ndim == 2 else gain[:, None]
    blurred = cv2.GaussianBlur(brightness, (0, 0), BLUR_PX)
    noise = rng.standard_normal(brightness.shape, dtype=np.float32)
    exposed = np.rint(blurred * gain + NOISE_GREY_LEVELS * noise)
    return np.asarray(np.clip(exposed, 0, 255), dtype=np.uint8)


def encode_jpeg(image: ByteImage, quality: int) -> bytes:
    """JPEG file of a grey (H, W) or RGB (H, W, 3) image."""
    stored = image if image.ndim == 2 else np.ascontiguousarray(image[..., ::-1])
    done, encoded = cv2.imencode(".jpg", stored, [cv2.IMWRITE_JPEG_QUALITY, quality])
    if not done:
        raise SynthesisError(f"an image of shape {image.shape} could not be encoded as JPEG")
    return bytes(encoded)


def jpeg_image(encoded: bytes) -> ByteImage:
    """Image (H, W) or RGB (H, W, 3) of a JPEG file."""
    image = np.asarray(cv2.imdecode(np.frombuffer(encoded, np.uint8), cv2.IMREAD_UNCHANGED))
    return image if image.ndim == 2 else np.ascontiguousarray(image[..., ::-1])


SKY_BRIGHTNESS = 190.0


@dataclass(frozen=True, eq=False)
class View:
    """The point of the ground plane behind every pixel of a camera, computed once.

    Attributes
    ----------
    points_robot : (H, W, 2) array
        Ground points in the robot frame [m]; 0 where the pixel is above the horizon.
    detail_m : (H, W) array
        Larger edge of the ground covered by a pixel [m].
    sees_ground : (H, W) array of bool
        False at and above the horizon.
    """

    points_robot: FloatArray
    detail_m: FloatArray
    sees_ground: BoolArray

    @classmethod
    def of(cls, camera: Camera) -> Self:
        """View of a camera.

        Raises
        ------
        SynthesisError
            If no pixel shows the terrain.
        """
        width, height = camera.image_size
        columns, rows = np.meshgrid(np.arange(width), np.arange(height))
        points = camera.pixels_to_ground(np.stack([columns, rows], axis=-1))
        steps = [np.linalg.norm(np.gradient(points, axis=axis), axis=-1) for axis in (0, 1)]
        detail = np.maximum(*steps)
        sees_ground = np.isfinite(detail)
        if not sees_ground.any():
            raise SynthesisError("the camera shows no terrain; its pitch must point down")
        return cls(
            np.where(sees_ground[..., None], points, 0.0),
            np.where(sees_ground, detail, detail[sees_ground].max()),
            sees_ground,
        )


@dataclass(frozen=True, eq=False)
class Scene:
    """The image of terrain whose strips each have a texture."""

    view: View
    ground: GroundMap
    textures: tuple[Texture, ...]

    def brightness(self, pose_world: FloatArray) -> AnyArray:
        """Brightness of every pixel when the robot is at a pose (x, y, yaw).

        Returns
        -------
        (H, W) or (H, W, 3) float32 array
            0 to 255, before exposure and noise.
        """
        points_world = to_world(pose_world, self.view.points_robot)
        strips = self.ground.strip_at(points_world)
        shape = strips.shape + self.textures[0].levels[0].shape[2:]
        image = np.full(shape, SKY_BRIGHTNESS, np.float32)
        for strip in np.unique(strips[self.view.sees_ground]):
            mask = (strips == strip) & self.view.sees_ground
            used = np.flatnonzero(mask.any(axis=1))
            rows = slice(used[0], used[-1] + 1)
            seen = self.textures[strip].look_up(points_world[rows], self.view.detail_m[rows])
            image[rows][mask[rows]] = seen[mask[rows]]
        return image
