"""Decodes one message."""
from .errors import LeonavError
from .lcm_types import MessageError, type_of


def decode(data):
    """Returns the name of a message's type, for instance "solution_t", and its members as a dict.

    Members are numbers, texts, numpy arrays, or lists of dicts, with the names and units of lcmtypes/. Raises LeonavError where
    the bytes are no message of leonav.
    """
    data = bytes(data)
    kind = type_of(data)
    if kind is None:
        raise LeonavError(f"byte 0: the fingerprint {data[:8].hex()} is of no type of leonav; the sender is another program, or of another "
                          "version")
    try:
        return kind.name, kind.decode(data)
    except MessageError as error:
        raise LeonavError(f"{kind.name} of {len(data)} bytes: {error}; the sender is damaged or of another version") from error
