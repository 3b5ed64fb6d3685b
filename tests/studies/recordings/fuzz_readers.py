"""Every reader against inputs made wrong at random: only the project's own errors may come out.

    python -m tests.studies.recordings.fuzz_readers [--changes 20000] [--seed 0] [--only NAME]

A row a reader: how many changed inputs were read and how many refused, the longest time of one,
and the errors that are not the project's, of which the first of each kind is printed. Memory is
limited; the exit code is 1 where there is any such error, or one input took longer than 5 s of
processor time.
"""

import argparse
import os
import resource
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

import numpy as np

from tests.fuzz.readers import fails, readers

MEMORY_BYTES = 4 * 1024**3
LONGEST_S = 5.0


def main() -> None:
    """Run the study and print its table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--changes", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the decoders of images are loud
    sound = True
    with tempfile.TemporaryDirectory() as scratch:
        print(f"{'reader':16}  changed     read  refused  wrong longest ms")
        for reader in readers(Path(scratch)):
            if arguments.only in (None, reader.name):
                sound &= study(reader, arguments.changes, arguments.seed)
    sys.exit(0 if sound else 1)


def study(reader, changes, seed):
    """Print one row; whether all went well."""
    rng = np.random.default_rng(seed)
    counts, seen, longest_s = Counter(), Counter(), 0.0
    for _ in range(changes):
        content = reader.changed(reader.valid, rng)
        start = time.process_time()
        try:
            counts["read" if fails(reader, content) is None else "refused"] += 1
        except Exception as error:
            counts["wrong"] += 1
            place = traceback.extract_tb(error.__traceback__)[-1]
            seen[kind := f"{type(error).__name__} {Path(place.filename).name}:{place.lineno}"] += 1
            if seen[kind] == 1:
                own = [
                    f for f in traceback.extract_tb(error.__traceback__) if "fuzz" not in f.filename
                ]
                steps = " > ".join(f"{Path(f.filename).name}:{f.lineno}" for f in own[-6:])
                print(f"  {kind}: {str(error)[:100]}\n    {steps}\n    {content[:400]!r}")
        taken_s = time.process_time() - start
        longest_s = max(longest_s, taken_s)
        if taken_s > LONGEST_S:
            print(f"  {taken_s:.1f} s: {content[:400]!r}")
    print(
        f"{reader.name:16} {changes:8} {counts['read']:8} {counts['refused']:8} "
        f"{counts['wrong']:6} {1e3 * longest_s:10.0f}",
        flush=True,
    )
    return counts["wrong"] == 0 and longest_s <= LONGEST_S


if __name__ == "__main__":
    main()
