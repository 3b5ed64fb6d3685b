"""What is said of the camera beside the motion: where they disagree, where neither checks."""

from collections.abc import Iterator

from odometry.modes.follow.followed import Followed


def camera_words(followed: Followed) -> Iterator[str]:
    """Whether camera and motion agree, and how long they could; nothing without labels."""
    if not followed.seen:
        return
    lasting_s, both_s = followed.config.lasting_s, followed.compared_s
    unfit_s, names = followed.unfit_while_seen
    if unfit_s >= lasting_s:
        yield (
            f"The motion fits no mode for {unfit_s:.1f} s in which the camera names "
            f"{' or '.join(names)}: there the motion does not confirm the camera."
        )
    argued = followed.disagreements
    yield from map(disagreement_words, argued)
    if argued:
        return
    if both_s < lasting_s:
        yield (
            f"Camera and motion name a mode at the same time for {both_s:.1f} s only: neither "
            "checks the other."
        )
        return
    yield (
        f"Camera and motion disagree nowhere for {lasting_s:g} s or longer, in the "
        f"{both_s:.1f} s in which both name a mode."
    )


def disagreement_words(one: tuple[float, float, str, str]) -> str:
    """Where camera and motion disagree."""
    from_s, to_s, seen, felt = one
    return (
        f"From {from_s:.1f} s to {to_s:.1f} s it is {seen} by the camera and {felt} by the motion."
    )
