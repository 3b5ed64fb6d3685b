"""What was dropped of a topic, in sentences."""

from collections.abc import Iterator

from odometry.bags.streams import Stream

MOST_REASONS = 3


def lost_of(stream: Stream) -> Iterator[str]:
    """Sentences on messages of a topic that did not become rows; nothing where all did."""
    sink, topic = stream.sink, stream.topic
    if sink.repeated:
        yield f"{topic}: {sink.repeated} messages repeat the stamp of one before; dropped"
    if sink.back:
        far = getattr(sink, "farthest_back_s", 0.0)
        how_far = f", by up to {far:.3g} s" if far else ""
        yield (
            f"{topic}: {sink.back} messages have a stamp that goes back{how_far}; dropped "
            "(--time log takes the times at which the bag received them)"
        )
    if incomplete := getattr(sink, "incomplete", 0):
        yield f"{topic}: {incomplete} rows lack a number that {stream.file} needs; dropped"
    reasons = stream.dropped.most_common()
    for reason, count in reasons[:MOST_REASONS]:
        yield f"{topic}: {count} messages dropped: {reason}"
    if len(reasons) > MOST_REASONS:
        rest = sum(count for _, count in reasons[MOST_REASONS:])
        yield f"{topic}: {rest} more messages dropped for other reasons"
    if not sink.written:
        yield f"{topic}: nothing of it could be used; there is no {stream.file}"
