"""What is in a MATLAB file of version 4 to 7: its arrays of numbers, by name.

Source: the layout that MathWorks publishes as "MAT-File Format". SciPy reads such files as well,
but ends the process at types that it does not know, and unpacks without a bound.
"""

import struct
import zlib
from collections.abc import Iterator
from math import prod
from typing import Any

import numpy as np

from rga.records.formats.bounds import MOST_A_BYTE, most_values

#: bytes that the variables of any file may have once they are unpacked
LARGEST_SMALL = 64 * 2**20
#: variables, fields and what they are made of, beyond which nobody measured them
MOST_PARTS = 200_000
#: structs within structs, beyond which nothing is read
_DEEPEST = 5
#: dimensions, beyond which it is no array that MATLAB writes
_MOST_DIMENSIONS = 32
#: types of elements, those of numbers as NumPy writes them
_TYPES = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
_MATRIX, _PACKED = 14, 15
#: orders of bytes, by how the end of the head is written
_ORDERS = {b"IM": "<", b"MI": ">"}
#: classes of arrays: structs, and from doubles to integers of eight bytes
_STRUCT, _NUMBERS = 2, range(6, 16)
_COMPLEX = 0x800
#: the same of version 4: types, the order of bytes, and a matrix that is full
_OLD_TYPES = {0: "f8", 1: "f4", 2: "i4", 3: "i2", 4: "u2", 5: "u1"}
_OLD_ORDERS = {0: "<", 1: ">"}
_FULL = 0
#: heads of version 4 begin with smaller numbers, in one of two orders
_OLD_HEADS = 5000

Elements = Iterator[tuple[int, memoryview]]
Arrays = Iterator[tuple[str, np.ndarray[Any, Any]]]


def arrays_of(data: bytes) -> Arrays:
    """Arrays of numbers in a file, those in structs as `struct.field`.

    Args:
        data: the file.

    Returns:
        Names, and arrays without dimensions of one element. Sparse arrays, words, cells and
        arrays of structs are left out.

    Raises:
        ValueError: the file is damaged, repeats a name, or holds far more than its size lets
            measurements be.

    >>> import io
    >>> from scipy.io import savemat
    >>> file = io.BytesIO()
    >>> savemat(file, {"S1": [1.0, 2.0], "about": {"fs": 50.0}, "word": "x"})
    >>> [(name, array.tolist()) for name, array in arrays_of(file.getvalue())]
    [('S1', [1.0, 2.0]), ('about.fs', 50.0)]
    """
    file = _File(memoryview(data))
    room = most_values(len(data))
    known: set[str] = set()
    try:
        for name, array in file.version_4() if 0 in data[:4] else file.version_5():
            if name in known:
                raise ValueError(f"the variable {name!r} stands twice")
            known.add(name)
            room -= array.size
            if room < 0:
                raise ValueError("it has far more numbers than its size lets measurements be")
            yield name, array
    except (struct.error, KeyError, zlib.error):
        raise ValueError("its parts do not fit together") from None


class _File:
    """The bytes of a file, and how many parts of it have been read."""

    def __init__(self, data: memoryview) -> None:
        self.data = data
        self.room = max(LARGEST_SMALL, MOST_A_BYTE * len(data))
        self.parts = 0

    def count(self) -> None:
        self.parts += 1
        if self.parts > MOST_PARTS:
            raise ValueError(f"it has more than {MOST_PARTS:,} parts")

    def version_5(self) -> Arrays:
        order = _ORDERS.get(bytes(self.data[126:128]))
        if order is None:
            raise ValueError("its head does not say how its numbers are written")
        for kind, content in self.elements(self.data[128:], order):
            inner = iter([(kind, content)])
            if kind == _PACKED:
                inner = self.elements(self.unpacked(content), order)
            for what, variable in inner:
                if what != _MATRIX:
                    raise ValueError("what stands in it is no variable")
                yield from self.matrix(variable, order, None, 1)

    def elements(self, data: memoryview, order: str) -> Elements:
        """Types and contents of elements, one after the other."""
        place = 0
        while place < len(data):
            self.count()
            kind, length = struct.unpack_from(f"{order}II", data, place)
            begin, end = place + 8, len(data)
            if kind >> 16:  # four bytes or less stand where the length does
                kind, length = kind & 0xFFFF, kind >> 16
                begin, end = place + 4, place + 8
            if begin + length > end:
                raise ValueError("it is cut off, or a length in it is damaged")
            yield kind, data[begin : begin + length]
            padding = 0 if kind == _PACKED else (place - begin - length) % 8
            place = begin + length + padding

    def unpacked(self, content: memoryview) -> memoryview:
        unpacking = zlib.decompressobj()
        unpacked = unpacking.decompress(content, self.room + 1)
        self.room -= len(unpacked)
        if self.room < 0:
            raise ValueError("it unpacks to far more than its size lets measurements be")
        if not unpacking.eof:
            raise ValueError("it is cut off")
        return memoryview(unpacked)

    def matrix(self, content: memoryview, order: str, called: str | None, depth: int) -> Arrays:
        """Arrays of a matrix, or of the fields of a struct.

        Args:
            content: its elements.
            order: of its bytes.
            called: its name; None: that which stands in it.
            depth: of structs.
        """
        elements = self.elements(content, order)
        (flags,) = struct.unpack_from(f"{order}I", _following(elements)[1])
        shape = np.frombuffer(_following(elements)[1], f"{order}i4").tolist()
        own = _text(_following(elements)[1])
        name = own if called is None else called
        if not name:
            return  # MATLAB keeps functions in it
        if len(shape) > _MOST_DIMENSIONS or min(shape, default=-1) < 0:
            raise ValueError(f"the shape of {name!r} is damaged")
        kind = flags & 0xFF
        if kind == _STRUCT and prod(shape) == 1 and depth <= _DEEPEST:
            (length,) = struct.unpack_from(f"{order}i", _following(elements)[1])
            if length < 1:
                raise ValueError(f"the fields of {name!r} are damaged")
            fields = _following(elements)[1]
            for begin in range(0, len(fields), length):
                inner = _following(elements)[1]
                if inner:
                    field = _text(fields[begin : begin + length])
                    yield from self.matrix(inner, order, f"{name}.{field}", depth + 1)
        elif kind in _NUMBERS:
            parts = [_following(elements) for _ in range(2 if flags & _COMPLEX else 1)]
            real, *imaginary = (
                _shaped(numbers, f"{order}{_TYPES[stored]}", shape) for stored, numbers in parts
            )
            yield name, real + 1j * imaginary[0] if imaginary else real

    def version_4(self) -> Arrays:
        data, place = self.data, 0
        while place < len(data):
            self.count()
            little = int.from_bytes(data[place : place + 4], "little")
            order = "<" if little < _OLD_HEADS else ">"
            said, rows, columns, complex_, length = struct.unpack_from(f"{order}5i", data, place)
            order, kind = _OLD_ORDERS[said // 1000], _OLD_TYPES[said // 10 % 10]
            begin = place + 20 + length
            size = rows * columns * np.dtype(kind).itemsize
            # A name ends in a zero.
            if min(rows, columns) < 0 or length < 2 or begin + size > len(data):
                raise ValueError("it is cut off, or a length in it is damaged")
            end = begin + size * (2 if complex_ else 1)
            if end > len(data):
                raise ValueError("it is cut off")
            if said % 10 == _FULL:
                real, *imaginary = (
                    _shaped(data[part : part + size], f"{order}{kind}", [rows, columns])
                    for part in ((begin, begin + size) if complex_ else (begin,))
                )
                name = _text(data[begin - length : begin])
                yield name, real + 1j * imaginary[0] if imaginary else real
            place = end


def _following(elements: Elements) -> tuple[int, memoryview]:
    """The next element, of those that there have to be."""
    for element in elements:
        return element
    raise ValueError("it is cut off")


def _text(content: memoryview) -> str:
    return bytes(content).partition(b"\0")[0].decode("latin-1")


def _shaped(numbers: memoryview, kind: str, shape: list[int]) -> np.ndarray[Any, Any]:
    return np.frombuffer(numbers, kind).reshape(shape, order="F").squeeze()
