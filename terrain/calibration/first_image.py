"""The first image of a run that can be read."""

from odometry.arrays import ByteImage
from odometry.run import Run
from terrain.camera_files.calibration import Lens
from terrain.errors import CameraError, ImageError
from terrain.images import read_image

TRIES = 20


def first_image(run: Run) -> ByteImage | None:
    """The first image of a run that can be read; None where it has none."""
    if run.images is None:
        return None
    for name in run.images["file"][:TRIES]:
        try:
            return read_image(run.folder / str(name))
        except ImageError:
            continue
    return None


def require_size(run: Run, lens: Lens) -> None:
    """Raise CameraError unless the run's images have the size of the lens, or there are none."""
    image = first_image(run)
    if image is None:
        return
    height, width = image.shape[:2]
    if (width, height) == lens.image_size:
        return
    lens_width, lens_height = lens.image_size
    advice = "give the calibration of this camera"
    if width * lens_height == height * lens_width:
        advice = (
            f"if the images were made smaller or larger, not cut, multiply fx, fy, cx and cy by "
            f"{width / lens_width:g} and state the images' size"
        )
    raise CameraError(
        f"the images of {run.folder} have {width} x {height} pixels, the lens is that of "
        f"{lens_width} x {lens_height}: {advice}"
    )
