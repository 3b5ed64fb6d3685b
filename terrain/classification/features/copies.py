"""The filtered copies of a patch, by name."""

from odometry.arrays import ByteImage
from terrain.classification.features.filters import (
    ColourFilter,
    Filter,
    band_pass,
    coherence,
    gradient_magnitude,
    gradient_orientation,
    latest_scales,
    local_contrast,
    red_green,
    reduced,
    yellow_blue,
)
from terrain.images import to_grey

ITSELF = "grey"  # the copy that is the grey image
GREY_COPIES: dict[str, Filter] = {
    ITSELF: reduced(1),
    "grey_2": reduced(2),
    "grey_4": reduced(4),
    "magnitude_0.7": gradient_magnitude(0.7),
    "magnitude_1.4": gradient_magnitude(1.4),
    "magnitude_2.8": gradient_magnitude(2.8),
    "orientation_0.7": gradient_orientation(0.7),
    "orientation_1.4": gradient_orientation(1.4),
    "orientation_2.8": gradient_orientation(2.8),
    "coherence_0.7": coherence(0.7),
    "coherence_1.4": coherence(1.4),
    "coherence_2.8": coherence(2.8),
    "contrast_2": local_contrast(2.0),
    "contrast_5.6": local_contrast(5.6),
    "contrast_16": local_contrast(16.0),
    "band_0.7": band_pass(0.7),
    "band_1": band_pass(1.0),
    "band_2": band_pass(2.0),
    "band_4": band_pass(4.0),
}
COLOUR_COPIES: dict[str, ColourFilter] = {"red_green": red_green, "yellow_blue": yellow_blue}


class Copies(dict[str, ByteImage]):
    """Filtered copies of one patch by name, each made when it is first asked for.

    Parameters
    ----------
    image : (rows, columns) or (rows, columns, 3) array of uint8
        Colour copies need RGB.

    Attributes
    ----------
    image : ByteImage
    scales : Scales
        What the grey copies are made of.
    """

    def __init__(self, image: ByteImage) -> None:
        super().__init__()
        self.image = image
        self.scales = latest_scales(to_grey(image))

    def __missing__(self, name: str) -> ByteImage:
        of_grey = GREY_COPIES.get(name)
        copy = COLOUR_COPIES[name](self.image) if of_grey is None else of_grey(self.scales)
        self[name] = copy
        return copy
