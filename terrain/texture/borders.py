"""Borders of the regions of up to eight binary images at once."""

import cv2

from odometry.arrays import AnyArray, ByteImage


def region_borders(bits: ByteImage) -> ByteImage:
    """Keep the pixels that have a zero among their eight neighbours (eq. 21).

    Parameters
    ----------
    bits : (H, W) array of uint8
        One binary image in each bit.

    Returns
    -------
    (H, W) array of uint8
        One border image in each bit. What lies outside the image counts as one, so the edge of
        the image is not a border.

    References
    ----------
    Chen et al. 2023, eq. 21.
    """
    padded: AnyArray = cv2.copyMakeBorder(bits, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=255)
    across: AnyArray = padded[:, :-2] & padded[:, 1:-1]
    across &= padded[:, 2:]
    inside: AnyArray = across[:-2] & across[1:-1]
    inside &= across[2:]
    inside ^= bits  # inside is a part of bits: what is left is its border
    return inside
