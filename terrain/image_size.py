"""Width and height that an encoded image states, before it is decoded."""

import struct

PIXELS = 64_000_000  # of the largest image that is read: decoded it needs up to 0.4 GB
PNG = b"\x89PNG\r\n\x1a\n"
# SOF0 to SOF15 state the size; among their numbers are DHT, JPG and DAC, which are none
START_OF_FRAME = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
WITHOUT_LENGTH = frozenset({0x01, *range(0xD0, 0xD9)})  # TEM, restarts and the start of image


def stated_size(encoded: bytes) -> tuple[int, int] | None:
    """Width and height [pixels] of a PNG, JPEG, TIFF or BMP; None where it states none.

    References
    ----------
    PNG: ISO/IEC 15948, 11.2.2 (IHDR). JPEG: ITU-T T.81, B.1.1.3 and B.2.2 (frame header). TIFF 6.0,
    section 2 and tags 256 and 257.
    """
    if encoded.startswith(PNG) and encoded[12:16] == b"IHDR" and len(encoded) >= 24:
        return int.from_bytes(encoded[16:20]), int.from_bytes(encoded[20:24])
    if encoded.startswith(b"\xff\xd8"):
        return _jpeg_size(encoded)
    if encoded.startswith((b"II*\0", b"MM\0*")):
        return _tiff_size(encoded)
    if encoded.startswith(b"BM") and len(encoded) >= 26:
        width, height = struct.unpack_from("<ii", encoded, 18)
        return abs(width), abs(height)  # a negative height: the top row comes first
    return None


def is_whole(encoded: bytes) -> bool:
    """Whether a PNG or JPEG has its end: decoders fill what is missing with grey, and say nothing.

    Other formats are taken as whole.
    """
    if encoded.startswith(PNG):
        return encoded.rfind(b"IEND") > encoded.rfind(b"IDAT")
    if encoded.startswith(b"\xff\xd8"):  # end of image, after the last start of scan
        end = encoded.rfind(b"\xff\xd9")
        return end >= 0 and encoded.find(b"\xff\xda", end) < 0
    return True


def _jpeg_size(encoded: bytes) -> tuple[int, int] | None:
    """Go from marker to marker up to the frame header."""
    place = 2
    while (place := encoded.find(b"\xff", place)) >= 0 and place + 9 <= len(encoded):
        marker = encoded[place + 1]
        if marker in START_OF_FRAME:
            height, width = encoded[place + 5 : place + 7], encoded[place + 7 : place + 9]
            return int.from_bytes(width), int.from_bytes(height)
        if marker == 0xFF:  # fill bytes
            place += 1
        elif marker in WITHOUT_LENGTH:
            place += 2
        else:
            place += 2 + int.from_bytes(encoded[place + 2 : place + 4])
    return None


def _tiff_size(encoded: bytes) -> tuple[int, int] | None:
    """Go through the entries of the first directory: tag, type, count, value."""
    order = "<" if encoded.startswith(b"II") else ">"
    size: dict[int, int] = {}
    try:
        (place,) = struct.unpack_from(order + "I", encoded, 4)
        (count,) = struct.unpack_from(order + "H", encoded, place)
        for entry in range(place + 2, place + 2 + 12 * count, 12):
            tag, kind = struct.unpack_from(order + "HH", encoded, entry)
            if tag in (256, 257):  # SHORT or LONG
                (size[tag],) = struct.unpack_from(
                    order + ("H" if kind == 3 else "I"), encoded, entry + 8
                )
    except struct.error:
        return None
    return (size[256], size[257]) if len(size) == 2 else None
