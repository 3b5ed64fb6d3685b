"""Ctrl-C and a request to terminate, as an exception that says what they left."""

import signal
from types import FrameType


class Interrupted(BaseException):
    """The user, or the system, stopped the command.

    It is no `KeyboardInterrupt`, which click turns into an exit code of its own.
    """

    def __init__(self, number: int) -> None:
        super().__init__("Interrupted" if number == signal.SIGINT else "Terminated")
        self.exit_code = 128 + number

    @property
    def left(self) -> str:
        """What was written, by those who were writing."""
        return "; ".join(getattr(self, "__notes__", [])) or "nothing was written"


def raise_on_signals(*numbers: signal.Signals) -> None:
    """Raise `Interrupted` at the first of these signals; a second one ends the process at once.

    A signal that is ignored, as `nohup` asks, stays so.
    """

    def stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 - the signal's own
        for one in numbers:
            signal.signal(one, signal.SIG_DFL)
        raise Interrupted(number)

    for one in numbers:
        if signal.getsignal(one) != signal.SIG_IGN:
            signal.signal(one, stop)
