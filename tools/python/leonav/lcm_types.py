"""Reads the definitions of message types (*.lcm) and decodes messages by them.

The package decodes by itself, because lcm-gen and an LCM module for Python are on few of the machines on which logs are
looked at, and because numpy decodes all messages of a type of fixed size at once. Encoding of LCM: a fingerprint of 8 bytes
that tells the type, then the members in order, big endian, without padding.
"""
import pathlib
import re
import struct
from typing import NamedTuple

import numpy as np

PRIMITIVES = {"boolean": "i1", "byte": "u1", "int8_t": "i1", "int16_t": ">i2", "int32_t": ">i4", "int64_t": ">i8",
              "float": ">f4", "double": ">f8"}
MASK = (1 << 64) - 1


class MessageError(Exception):
    """The bytes are no message of the type."""


class Member(NamedTuple):
    type: str
    name: str
    dimensions: tuple  # numbers, or names of members before it


class MessageType:
    """One struct of lcmtypes/. `constants` has its numbers with a meaning by name: {"KIND_IMU_GAP": 4, ...}."""

    def __init__(self, name, members, types, constants=None):
        self.name, self.members, self._types, self.constants = name, members, types, constants or {}
        self._dtype = False  # not known yet

    @property
    def fingerprint(self):
        """The first 8 bytes of every message of the type."""
        return self._hash(()).to_bytes(8, "big")

    def _hash(self, parents):
        if self.name in parents:
            return 0
        total = self._own_hash()
        for member in self.members:
            if member.type in self._types:
                total += self._types[member.type]._hash(parents + (self.name,))
        total &= MASK
        return (total << 1 & MASK) | total >> 63

    def _own_hash(self):
        value = 0x12345678

        def add(byte):
            nonlocal value
            signed = value - (1 << 64) if value >> 63 else value
            value = ((value << 8) ^ (signed >> 55)) + byte & MASK

        def add_text(text):
            for byte in (len(text), *text.encode()):
                add(byte)

        for member in self.members:
            add_text(member.name)
            if member.type not in self._types:
                add_text(member.type)
            add(len(member.dimensions))
            for size in member.dimensions:
                add(0 if isinstance(size, int) else 1)
                add_text(str(size))
        return value

    @property
    def dtype(self):
        """The numpy type of the members if the type has a fixed size, else None."""
        if self._dtype is False:
            self._dtype = self._make_dtype()
        return self._dtype

    def _make_dtype(self):
        fields = []
        for member in self.members:
            if not all(isinstance(size, int) for size in member.dimensions):
                return None
            element = PRIMITIVES.get(member.type)
            if member.type in self._types:
                element = self._types[member.type].dtype
            if element is None:
                return None
            fields.append((member.name, element, member.dimensions))
        return np.dtype(fields)

    def decode(self, data):
        """Returns the members as a dict: scalars, numpy arrays, and lists of dicts; raises MessageError."""
        if data[:8] != self.fingerprint:
            raise MessageError(f"no {self.name}")
        values, end = self._decode(data, 8)
        if end != len(data):
            raise MessageError(f"{len(data) - end} bytes too many")
        return values

    def _decode(self, data, start):
        values = {}
        for member in self.members:
            shape = [size if isinstance(size, int) else int(values[size]) for size in member.dimensions]
            if any(size < 0 for size in shape):
                raise MessageError(f"{member.name} has a negative size")
            values[member.name], start = self._decode_member(member, shape, data, start)
        return values, start

    def _decode_member(self, member, shape, data, start):
        nested = self._types.get(member.type)
        element = nested.dtype if nested else PRIMITIVES.get(member.type)
        if element is not None:
            element = np.dtype(element)
            count = 1
            for size in shape:
                count *= size
            end = start + count * element.itemsize
            if end > len(data):
                raise MessageError(f"ends within {member.name}")
            array = np.frombuffer(data, element, count, start)
            return (array.reshape(shape) if shape else array[0]), end
        if len(shape) > 1:
            raise MessageError(f"{member.name} has a shape that is not known")
        items = []
        for _ in range(shape[0] if shape else 1):  # each takes 4 bytes at least, so a false count ends at the data's end
            item, start = nested._decode(data, start) if nested else _decode_string(member.name, data, start)
            items.append(item)
        return (items if shape else items[0]), start


def _decode_string(name, data, start):
    if start + 4 > len(data):
        raise MessageError(f"ends within {name}")
    length = struct.unpack_from(">I", data, start)[0]
    end = start + 4 + length
    if length < 1 or end > len(data) or data[end - 1] != 0:
        raise MessageError(f"{name} is no text")
    return data[start + 4:end - 1].decode(errors="replace"), end


def parse(text, types):
    """Adds the structs of a definition's text to `types`, by name."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    for name, body in re.findall(r"\bstruct\s+(\w+)\s*\{(.*?)\}", text, flags=re.S):
        members, constants = [], {}
        for statement in filter(None, (part.strip() for part in body.split(";"))):
            type_name, names = statement.split(None, 1)
            if type_name == "const":
                constants.update((one, int(value)) for one, value in re.findall(r"(\w+)\s*=\s*(-?\d+)", names))
                continue
            for one in names.split(","):
                dimensions = tuple(int(size) if size.isdigit() else size for size in re.findall(r"\[\s*(\w+)\s*\]", one))
                members.append(Member(type_name, one.split("[")[0].strip(), dimensions))
        types[name] = MessageType(name, members, types, constants)


def load():
    """Returns the types of leonav by name: those installed with the package, in the tree those of lcmtypes/."""
    here = pathlib.Path(__file__).resolve()
    for folder in (here.parent / "lcmtypes", *(parent / "lcmtypes" for parent in list(here.parents)[3:4])):
        definitions = sorted(folder.glob("*.lcm"))
        if definitions:
            types = {}
            for definition in definitions:
                parse(definition.read_text(encoding="utf-8"), types)
            return types
    raise ImportError("leonav: the message types are missing; install the package with pip install tools/python from leonav's tree")


TYPES = load()
BY_FINGERPRINT = {one.fingerprint: one for one in TYPES.values()}


def type_of(data):
    """Returns the type of a message by its fingerprint; None if it is none of leonav's.

    Types of older versions have other fields and therefore fingerprints of their own.
    """
    return BY_FINGERPRINT.get(bytes(data[:8]))
