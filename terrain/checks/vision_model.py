"""Whether a classifier can read the region ahead of this camera."""

from collections.abc import Iterator

from odometry.checks.finding import Finding, Level
from odometry.run import Robot
from terrain.camera import Camera
from terrain.checks.run_regions import straight_ahead
from terrain.classification.classifier import TerrainClassifier
from terrain.region import NoRegion, RegionConfig
from terrain.region_scale import scale_mismatch


def vision_model(
    classifier: TerrainClassifier, camera: Camera | None, robot: Robot
) -> Iterator[Finding]:
    """No metric scale, or one at which this camera's images cannot be read."""
    scale = classifier.metres_per_pixel
    if scale is None:
        yield Finding(
            "model_without_scale",
            Level.NOTE,
            f"the model's training patches of {classifier.patch_size_px} pixels have no "
            "metres_per_pixel",
            "The model has no metric scale: pixels of the region are compared as they are, and "
            "texture is finer in the image the farther away it is",
            "Train with --metres-per-pixel, on patches in the view from above",
        )
    if camera is None:
        return
    region = straight_ahead(camera, robot)
    if isinstance(region, NoRegion):
        return
    reason = scale_mismatch(classifier, camera, region.rectangle, RegionConfig().coarsest)
    if reason:
        size = f"{scale:.3g} m" if scale is not None else "no stated scale"
        yield Finding(
            "model_unsuited",
            Level.WARNING,
            f"{reason}, when driving straight on ({region.distance_ahead_m:.2g} m ahead; patches "
            f"of {classifier.patch_size_px} pixels, {size} a pixel): vision will label nothing",
            "metres_per_pixel of the model is wrong (mm?), or the model is of another camera, "
            "nearer to the terrain",
            "Train with patches of this camera and their metres_per_pixel",
        )
