"""Messages decoded by the definitions that a bag carries.

Where a bag has no definition of a type (ROS 2 before Iron), the one that ROS itself ships is
taken. A type that ROS does not ship cannot be read without its definition.
"""

from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from typing import Any

from rosbags.typesys import (
    Stores,
    TypesysError,
    get_types_from_idl,
    get_types_from_msg,
    get_typestore,
)

from odometry.bags.files.topic import READABLE, Buffer, Connection, Message
from odometry.errors import BagError

MOST_COMPILED = 256  # types, of a batch of bags

Reader = Callable[[Buffer, str], Any]


class MessageTypes:
    """Decodes messages; the definitions of a type are compiled once."""

    def __init__(self) -> None:
        self._of_connection: dict[int, tuple[Connection, Reader]] = {}

    def decode(self, message: Message) -> Any:
        """The message as an object with the fields of its definition.

        Raises
        ------
        BagError
            If its type is not known, or its bytes are not as the definition says.
        """
        connection = message.connection
        known = self._of_connection.get(id(connection))
        if known is None:
            known = self._of_connection[id(connection)] = connection, self._reader(connection)
        try:
            return known[1](message.data, connection.message_type)
        except Exception as problem:  # generated code raises whatever the bytes lead it to
            raise BagError(
                f"{connection.topic}: a message is not as the definition of "
                f"{connection.message_type} says"
            ) from problem

    def problem(self, connection: Connection) -> str:
        """Why messages of a connection cannot be read; empty where they can."""
        try:
            self._reader(connection)
        except BagError as problem:
            return str(problem)
        return ""

    def _reader(self, connection: Connection) -> Reader:
        if connection.encoding not in READABLE:
            raise BagError(
                f"{connection.topic}: its messages are encoded as {connection.encoding!r}; "
                f"expected one of {', '.join(READABLE)}"
            )
        own = connection.definition, connection.schema
        try:
            return _compiled(connection.message_type, connection.encoding, *own)
        except BagError as problem:
            raise BagError(f"{connection.topic}: {problem}") from problem


@lru_cache(MOST_COMPILED)
def _compiled(message_type: str, encoding: str, definition: str, schema: str) -> Reader:
    """Reader of a type, of any bag that defines it so: to make one takes as long as a small bag."""
    store = get_typestore(Stores.EMPTY)
    try:
        store.register(_definitions(message_type, encoding, definition, schema))
        store.get_msgdef(message_type)
    except BagError:
        raise
    except Exception as problem:  # rosbags raises several, and KeyError for what is missing
        raise BagError(f"the definition of {message_type} cannot be used: {problem}") from problem
    return store.deserialize_ros1 if encoding == "ros1" else store.deserialize_cdr


def _definitions(message_type: str, encoding: str, definition: str, schema: str) -> dict[str, Any]:
    """Definitions of a type and of its parts, the bag's own before shipped ones."""
    own: dict[str, Any] = {}
    try:
        if definition and schema == "msg":
            own = get_types_from_msg(definition, message_type)
        elif definition:
            for text in _idl_texts(definition):
                own |= get_types_from_idl(text)
    except TypesysError:
        if message_type not in _shipped(encoding):
            raise
        own = {}
    wanted, found, seen = [message_type], dict(own), set[str]()
    while wanted:
        name = wanted.pop()
        if name not in found:
            shipped = _shipped(encoding)
            if name not in shipped:
                raise BagError(
                    f"the bag has no definition of {name}, and ROS does not ship one; record the "
                    "bag again with a recorder that stores definitions (MCAP does, SQLite since "
                    "ROS 2 Iron)"
                )
            found[name] = shipped[name]
        seen.add(name)
        wanted += [other for other in _parts(found[name]) if other not in seen]
    return found


@cache
def _shipped(encoding: str) -> dict[str, Any]:
    """Definitions that ROS ships; they take a while to load, and few bags need them."""
    return get_typestore(Stores.ROS1_NOETIC if encoding == "ros1" else Stores.LATEST).fielddefs


def _idl_texts(definition: str) -> Iterator[str]:
    """The parts of a definition in IDL; parts of several types are separated by a ruler."""
    ruler = 80 * "=" + "\n"
    if not definition.startswith(f"{ruler}IDL: "):
        yield definition
        return
    for part in definition.split(ruler)[1:]:
        yield part.partition("\n")[2]


def _parts(definition: Any) -> Iterator[str]:
    """Names of the types that the fields of a definition are made of."""
    for _, description in definition[1]:
        kind, content = description
        if int(kind) in (3, 4):  # an array or a sequence of another description
            kind, content = content[0]
        if int(kind) == 2:  # a name
            yield content
