"""Which filtered copies `train --preset fast` looks at, and what few of them cost in accuracy.

Copies are chosen one after another, each time the one with which balanced accuracy by patch, mean
over both sets of photographs, is best out of fold. The choice is nested: it is made anew on the
training part of every outer fold, and evaluated on photographs that took no part in it. Candidates
are copies that cost little beside the grey image.

    python -m tests.studies.camera.fast_copies DATA/terrain-images/ground
        DATA/terrain-images/pavements
                                        [--copies 4] [--per-photo 12]

The folders hold labelled photographs; so many patches of each are taken.
"""

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn.metrics import balanced_accuracy_score

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from terrain.classification.features.copies import GREY_COPIES
from terrain.classification.features.features import FEWER_GREYS, FeatureSettings, feature_matrix
from terrain.classification.neighbours.neighbours import vote
from terrain.classification.neighbours.validation import Samples, grouped_folds
from terrain.classification.photographs.patches import find_photos, load_patches
from terrain.classification.presets import PRESETS, linear_neighbours

ALL = tuple(GREY_COPIES)
DEAR = ("coherence_1.4", "coherence_2.8", "magnitude_2.8", "orientation_2.8", "contrast_16")
CHEAP = tuple(name for name in ALL if name not in DEAR)
PER_COPY, NEIGHBOURS, SIZE_PX = 24, 9, 128


@dataclass(frozen=True)
class Photos:
    """Features (n, F) of all copies of patches, their terrain codes (n,) and photographs (n,)."""

    features: FloatArray
    codes: IntArray
    groups: AnyArray

    @classmethod
    def read(cls, root: Path, per_photo: int) -> "Photos":
        """Some patches of each photograph of a folder."""
        patches = load_patches(find_photos(root), SIZE_PX, per_photo)
        settings = FeatureSettings(ALL, (), 4, True, filtered_greys=FEWER_GREYS)
        codes = np.unique(patches.labels, return_inverse=True)[1]
        return cls(feature_matrix(patches.images, settings), codes, np.array(patches.groups))

    def of(self, rows: IntArray) -> "Photos":
        """Some patches."""
        return Photos(self.features[rows], self.codes[rows], self.groups[rows])

    def votes(self, train: IntArray, test: IntArray, copies: tuple[str, ...]) -> FloatArray:
        """Votes (t, classes) for patches by neighbours that learned from others."""
        columns = np.concatenate(
            [PER_COPY * ALL.index(copy) + np.arange(PER_COPY) for copy in copies]
        )
        samples = Samples(self.features[:, columns], self.codes, self.groups)
        model = linear_neighbours().fit(*samples.with_copies(train, None))
        labels = model.labels(self.features[np.ix_(test, columns)], NEIGHBOURS)
        return vote(labels, model.class_weights_)

    def folds(self) -> list[tuple[IntArray, IntArray]]:
        """By photograph."""
        return grouped_folds(self.codes, self.groups)

    def accuracy(self, copies: tuple[str, ...]) -> float:
        """Balanced, by patch, out of fold."""
        votes = np.full((len(self.codes), self.codes.max() + 1), np.nan)
        for train, test in self.folds():
            votes[test] = self.votes(train, test, copies)
        return self.scores(votes)[0]

    def scores(self, votes: FloatArray) -> tuple[float, float]:
        """Balanced accuracy by patch and by photograph, of those that were evaluated."""
        judged: BoolArray = np.isfinite(votes[:, 0])
        codes, groups, votes = self.codes[judged], self.groups[judged], votes[judged]
        by_photo = [
            (codes[groups == group][0], votes[groups == group].mean(axis=0).argmax())
            for group in dict.fromkeys(groups.tolist())
        ]
        return (
            float(balanced_accuracy_score(codes, votes.argmax(axis=1))),
            float(balanced_accuracy_score(*zip(*by_photo, strict=True))),
        )


def chosen(sets: list[Photos], count: int) -> tuple[str, ...]:
    """So many copies, one after another."""
    copies: tuple[str, ...] = ()
    for _ in range(count):
        rest = [copy for copy in CHEAP if copy not in copies]
        best = max(rest, key=lambda copy: np.mean([of.accuracy((*copies, copy)) for of in sets]))
        copies = (*copies, best)
    return copies


def main() -> None:
    """Print the choice of every fold, and accuracies nested and of fixed sets of copies."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("roots", nargs="+", type=Path, help="folders of labelled photographs")
    parser.add_argument("--copies", type=int, default=4, help="how many are chosen")
    parser.add_argument("--per-photo", type=int, default=12, help="patches of a photograph")
    options = parser.parse_args()
    sets = [Photos.read(root, options.per_photo) for root in options.roots]
    folds = [of.folds() for of in sets]
    fixed = {"fast": PRESETS["fast"].features.grey_copies, "all": ALL}
    votes = {
        (name, i): np.full((len(of.codes), of.codes.max() + 1), np.nan)
        for name in ("nested", *fixed)
        for i, of in enumerate(sets)
    }
    for parts in zip(*folds, strict=False):
        nested = chosen(
            [of.of(train) for of, (train, _) in zip(sets, parts, strict=True)], options.copies
        )
        print("chosen in a fold:", *nested)
        for i, (of, (train, test)) in enumerate(zip(sets, parts, strict=True)):
            for name, copies in {"nested": nested, **fixed}.items():
                votes[name, i][test] = of.votes(train, test, copies)
    print("chosen on all:", *chosen(sets, options.copies))
    for (name, i), of_set in votes.items():
        patch, photo = sets[i].scores(of_set)
        print(
            f"{options.roots[i].name:12s} {name:7s} by patch {patch:.3f}, by photograph {photo:.3f}"
        )


if __name__ == "__main__":
    main()
