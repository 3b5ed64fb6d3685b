"""Whether the parameter set has the terrains that a model and the start of a run name."""

from collections.abc import Iterable

from odometry.parameters import ParameterSet
from odometry.recording.run import UNKNOWN
from terrain.classification.answer import Classifier
from terrain.spelling import plain_name


def name_notes(initial: str, classifier: Classifier | None, parameters: ParameterSet) -> list[str]:
    """Terrains of the start and of a model that the parameter set does not have."""
    known, found = parameters.terrains, []
    if not known:
        return []
    if initial not in (*known, UNKNOWN):
        found.append(
            f"{initial!r} has no table in the parameter set, which has {', '.join(known)}: it "
            f"starts from a broad prior{_meant([initial], known)}"
        )
    if classifier is not None:
        missing = sorted(set(map(str, classifier.classes_)) - set(known))
        if missing:
            found.append(
                f"the model knows {', '.join(map(repr, missing))}, the parameter set does not: "
                "the motion there starts from a broad prior round the mean of the terrains that "
                f"the set has ({', '.join(known)}){_meant(missing, known)}"
            )
    return found


def _meant(names: Iterable[str], known: Iterable[str]) -> str:
    """Which names of the set are other spellings of some."""
    known_as = {plain_name(name): name for name in known}
    found = [
        f"{known_as[plain_name(name)]!r} there is {name!r} here: give both one name"
        for name in names
        if plain_name(name) in known_as
    ]
    return f". {'. '.join(found)}" if found else ""
