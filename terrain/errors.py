"""The errors of the package, all children of `odometry.errors.OdometryError`."""

from odometry.errors import OdometryError


class TerrainError(OdometryError):
    """Base of the errors about cameras, images, patches and classifiers.

    Examples
    --------
    >>> import terrain
    >>> try:
    ...     terrain.train("nowhere")
    ... except terrain.TerrainError as error:
    ...     print(error)
    nowhere is not a folder; expected nowhere/<class>/*.jpg or *.png
    """


class CameraError(TerrainError):
    """A camera description is incomplete or contradicts itself."""


class ImageError(TerrainError):
    """An image cannot be read, or is not of a kind that has features."""


class PatchError(TerrainError, ValueError):
    """A set of labelled patches cannot be used for training; scikit-learn requires a ValueError."""


class ModelFileError(TerrainError):
    """A model file is damaged, foreign, or newer than this program."""


class NetworkError(TerrainError):
    """A file is no image network that OpenCV can run, or has no such layer."""


class SynthesisError(TerrainError):
    """A synthetic run cannot be made from what was given."""


class ResultError(TerrainError):
    """A folder does not hold the result of a finished run."""


class BatchError(TerrainError):
    """Many jobs cannot be done together, or not where they were sent."""


class CalibrationError(CameraError):
    """The input does not determine the lens or the mount."""
