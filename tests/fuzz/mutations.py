"""Valid inputs made wrong: by bytes, lines, numbers, structure, and members of zip files."""

import hashlib
import io
import json
import re
import zipfile

import numpy as np

WORDS = (
    *("nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "1e999", "1e12", "-1e12", "0", "-1", ""),
    *(
        "fast",
        "true",
        '"text"',
        "[]",
        "{}",
        "[1, 2]",
        "2020-01-01",
        "0x10",
        "1_0",
        "9223372036854775808",
    ),
    *(
        "1" * 6000,
        "0x" + "f" * 6000,
        "[" * 3000,
        "[" * 40 + "]" * 40,
        "a" * 70000,
        "\0",
        "\u00e9",
        '"',
    ),
    *(
        "../x",
        "/etc/passwd",
        "unknown",
        "1,2",
        "'",
        "\n",
        "\r",
        "=",
        "[a.b.c]",
        "{a = 1}",
        "#",
        "-0.0",
    ),
)
VALUES = (
    *(None, True, False, 0, -1, 10**30, 1e300, -1e300, 0.5, "", "text", "\ud800", [], {}, [1, 2]),
    *({"mean": 1}, float("nan"), float("inf"), [[[]]]),
)
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def bytes_changed(data, rng):
    """Flip, cut, insert, repeat or overwrite bytes at a random place."""
    place, length = int(rng.integers(len(data) + 1)), int(rng.integers(1, 64))
    match rng.integers(6):
        case 0 if data:
            changed = bytearray(data)
            for at in rng.integers(len(data), size=rng.integers(1, 5)):
                changed[at] ^= 1 << int(rng.integers(8))
            return bytes(changed)
        case 1:
            return data[:place]
        case 2:
            return data[:place] + rng.bytes(length) + data[place:]
        case 3:
            return data[:place] + data[place + length :]
        case 4:
            return data[:place] + data[place : place + length] * 3 + data[place + length :]
    return data[:place] + bytes([rng.choice([0, 10, 255])]) * length + data[place + length :]


def lines_changed(data, rng):
    """Swap, repeat, drop or empty lines."""
    lines = data.split(b"\n")
    first, second = (int(at) for at in rng.integers(len(lines), size=2))
    match rng.integers(4):
        case 0:
            lines[first], lines[second] = lines[second], lines[first]
        case 1:
            lines.insert(first, lines[second])
        case 2:
            del lines[first]
        case _:
            lines[first] = b""
    return b"\n".join(lines)


def word_changed(data, rng):
    """Put something else in the place of a number, of a cell or of a value."""
    pattern = (NUMBER, re.compile(rb"[^,\s=]+"), re.compile(rb"(?<== ).*"))[rng.integers(3)]
    found = list(pattern.finditer(data))
    if not found:
        return bytes_changed(data, rng)
    start, end = found[rng.integers(len(found))].span()
    return data[:start] + WORDS[rng.integers(len(WORDS))].encode() + data[end:]


def text_changed(data, rng):
    """One to three changes of a text."""
    for _ in range(rng.integers(1, 4)):
        data = (bytes_changed, lines_changed, word_changed, word_changed)[rng.integers(4)](
            data, rng
        )
    return data


def json_changed(data, rng):
    """Another value, or none, at a random place of a JSON text; or another text."""
    if rng.random() < 0.3:
        return text_changed(data, rng)
    return json.dumps(tree_changed(json.loads(data), rng)).encode()


def tree_changed(tree, rng):
    """The same nested lists and tables with one place changed."""
    if not isinstance(tree, dict | list) or not tree or rng.random() < 0.1:
        return VALUES[rng.integers(len(VALUES))]
    keys = list(tree) if isinstance(tree, dict) else list(range(len(tree)))
    key = keys[rng.integers(len(keys))]
    changed = tree.copy()
    if rng.random() < 0.1:
        del changed[key]
    else:
        changed[key] = tree_changed(tree[key], rng)
    return changed


def model_changed(data, rng):
    """A classifier: bytes of the file, its members swapped or packed, or wrong under good sums."""
    if rng.random() < 0.3:
        return bytes_changed(data, rng)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    names = sorted(name for name in members if name.endswith(".npy"))
    one, other = (names[at] for at in rng.integers(len(names), size=2))
    header = json.loads(members["header.json"])
    match rng.integers(6):
        case 0:
            members[one], members[other] = members[other], members[one]
        case 1:
            del members[one]
            if rng.random() < 0.5:
                del header["sha256"][one]
        case 2:
            members[one] = bytes_changed(members[one], rng)
        case 3:
            members[one] = _npy(_array_changed(np.load(io.BytesIO(members[one])), rng))
        case _:
            header["settings"] = tree_changed(header["settings"], rng)
    return zipped(members, header, rng)


def zipped(members, header, rng):
    """A zip of members with the sums that belong to them; now and then packed."""
    sums = header["sha256"] if isinstance(header, dict) else {}
    for name in sums:
        if name in members and rng.random() < 0.95:
            sums[name] = hashlib.sha256(members[name]).hexdigest()
    text = json.dumps(header).encode()
    members = members | {"header.json": text, "sha256": hashlib.sha256(text).hexdigest().encode()}
    packed = rng.choice([0, 0, 0, 8, 12, 14])  # stored, deflate, bzip2, lzma
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", int(packed)) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def _array_changed(array, rng):
    odd = (np.nan, np.inf, 1e300, -1, 0, 1e9)[rng.integers(6)]
    match rng.integers(6):
        case 0:
            return array[: len(array) // 2]
        case 1:
            return np.full(array.shape, odd)
        case 2:
            return array.T
        case 3:
            return array.astype(np.float32 if rng.random() < 0.5 else np.int16)
        case 4:
            return array.reshape(-1)[: rng.integers(3)]
    changed = array.astype(np.float64).ravel()
    changed[rng.integers(changed.size)] = odd
    return changed.reshape(array.shape)


def _npy(array):
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.ascontiguousarray(array), (1, 0), allow_pickle=False)
    return stream.getvalue()
