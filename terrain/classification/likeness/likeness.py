"""Whether images look like the training photographs, as a run or a folder."""

from dataclasses import dataclass

FEWEST_IMAGES = 5
# of models without limits of their own; chosen on ground/, pavements/ and frames of other cameras
UNLIKE_RANK, UNLIKE_RANK_IN_CLASS = 0.75, 0.7
UNLIKE_EXPOSURE = 0.4  # from one half


@dataclass(frozen=True)
class Likeness:
    """Whether the images of a run, or a folder, look like the training photographs.

    Attributes
    ----------
    images : int
    rank, rank_in_class : float
        Mean share of held-out training patches that are nearer to the other photographs than an
        image is; among all, and among those of the terrain that it is nearest to. 0.5 where the
        images are like the photographs, 1 where none is. NaN without images.
    how : tuple of str
        In what the images differ most.
    exposure : float
        Mean share of the 30 training patches of the most similar texture that are darker: 0.5
        where the light is that of training, 1 where every image is brighter.
    light : float
        Grey over that of these patches, geometric mean: 0.5 where the images are half as bright.
    beyond : float or None
        How far the images are from training over what runs of training photographs are: unlike
        above 1, see `RunLimits`. Fewer than five images are compared with one photograph. None
        without images, of files before version 0.15, where limits of the ranks and of the exposure
        decide, and of few images by files before version 0.16.
    colour_beyond : float
        The same of the colours, of models that use colour: see `ColourRange`. 0 of others, of
        fewer than five images and of files before version 0.36.
    exchanged : bool
        Whether the colours are much nearer to training with red and blue exchanged.
    grey_beyond : float
        How probably the images are nearly grey over what runs of training photographs are: see
        `NearlyGrey`. 0 where `colour_beyond` is, and of files before version 0.37.
    turned_beyond : float
        The same of channels in another order, in any light: see `TurnedChannels`. 0 where
        `colour_beyond` is, and of files before version 0.45.
    """

    images: int
    rank: float
    rank_in_class: float
    how: tuple[str, ...]
    exposure: float = 0.5
    beyond: float | None = None
    light: float = 1.0
    colour_beyond: float = 0.0
    exchanged: bool = False
    grey_beyond: float = 0.0
    turned_beyond: float = 0.0

    @property
    def is_unlike(self) -> bool | None:
        """None without images, and of old files where there are too few."""
        if self.beyond is not None:
            return self.beyond > 1
        if self.images < FEWEST_IMAGES:
            return None
        is_far = self.rank > UNLIKE_RANK and self.rank_in_class > UNLIKE_RANK_IN_CLASS
        return is_far or abs(self.exposure - 0.5) > UNLIKE_EXPOSURE

    @property
    def note(self) -> str | None:
        """A warning where labels are in doubt; else None."""
        looks, colours = self._of_looks, self._of_colours
        if looks and colours:
            return f"{looks}. {colours[0].upper()}{colours[1:]}"
        return looks or colours or None

    @property
    def _of_looks(self) -> str:
        if not self.is_unlike:
            return ""
        how = f" ({', '.join(self.how)})" if self.how else ""
        one = self.images == 1
        those, these = ("image is", "it is") if one else ("images are", "these images are")
        return (
            f"the {those} unlike the training photographs of the model{how}: another camera, "
            f"distance, light or compression. {100 * self.rank:.0f} % of held-out training patches "
            f"are more like the other ones than {these}, and {100 * self.exposure:.0f} % of "
            f"those of similar texture are darker. {'The label' if one else 'Many labels'} may be "
            "wrong; label images of this camera and train with them"
        )

    @property
    def _of_colours(self) -> str:
        if self.turned_beyond > 1:
            return (
                "red, green and blue of the images seem to be in another order than in training: "
                "they vary together as in the training photographs with channels exchanged, "
                "whatever the light (blue first, as OpenCV reads images; planes of chroma "
                "exchanged; another Bayer pattern; hue that is turned), or the terrain is of other "
                "colours than any in training. The model uses colour: names that are not surely "
                "right are unknown. Look at the images, and correct how they are read, or train "
                "with this terrain"
            )
        if self.grey_beyond > 1:
            return (
                "the images are nearly grey: red and blue follow green as in a grey image with a "
                "tint, or hardly leave it (a night camera, low saturation, a filter), more than in "
                "the training photographs of any terrain. The model uses colour: names may be "
                "wrong, and are unknown where it is much. Train without --colour, or with images "
                "of this camera in this light"
            )
        if self.exchanged:
            return (
                "with red and blue exchanged the images would be much more like the training "
                "photographs: either blue comes first where red is expected (as OpenCV reads "
                "images, or by a wrong encoding), or the light is much bluer or redder than in "
                "training. The model uses colour: names may be wrong"
            )
        if self.colour_beyond > 1:
            return (
                "the colours of the images are unlike those of the training photographs (another "
                "light, white balance or terrain), and the model uses colour: names may be wrong. "
                "Train without --colour, or with images in this light"
            )
        return ""
