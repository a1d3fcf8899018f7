# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Variables of NetCDF files: of the classic format and those with 8-byte offsets or sizes by hand, those of version 4 as HDF5."""

import struct

import numpy as np

from .mesh import Fault

_TYPES = {1: "i1", 2: "S1", 3: ">i2", 4: ">i4", 5: ">f4", 6: ">f8", 7: "u1", 8: ">u2", 9: ">u4", 10: ">i8", 11: ">u8"}


def variables(name: str) -> dict:
    """Arrays by name, and attributes of text as "variable:attribute". Raises Fault."""
    with open(name, "rb") as file:
        head = file.read(8)
    if head[:3] == b"CDF" and head[3:4] in (b"\x01", b"\x02", b"\x05"):
        with open(name, "rb") as file:
            return _Classic(file.read()).read()
    if head == b"\x89HDF\r\n\x1a\n":
        return _of_hdf5(name)
    raise Fault("is no NetCDF file, as Exodus files are")


def _of_hdf5(name: str) -> dict:
    try:
        import h5py
    except ImportError:
        raise Fault("needs the Python package h5py (Debian: python3-h5py), which was not found") from None
    found = {}
    try:
        with h5py.File(name, "r") as file:
            for key, item in file.items():
                if isinstance(item, h5py.Dataset) and item.dtype.kind in "iufS":
                    found[key] = item[()]
                    for attribute, value in item.attrs.items():
                        if isinstance(value, (bytes, str)):
                            found[f"{key}:{attribute}"] = value.decode("latin-1") if isinstance(value, bytes) else value
    except (OSError, RuntimeError, ValueError, KeyError) as error:
        raise Fault(f"is damaged: {error}") from None
    return found


class _Classic:
    """The format is a header of lists: dimensions, attributes, variables with the places of their data."""

    def __init__(self, data: bytes):
        self.data, self.at, self.version = data, 4, data[3]

    def read(self) -> dict:
        try:
            return self._read()
        except (struct.error, IndexError, ValueError, KeyError, OverflowError, MemoryError):
            raise Fault("is damaged: its NetCDF header or data end too early or make no sense") from None

    def _take(self, form: str):
        (value,) = struct.unpack_from(">" + form, self.data, self.at)
        self.at += struct.calcsize(form)
        return value

    def _count(self) -> int:
        n = self._take("Q" if self.version == 5 else "I")
        if n > len(self.data):
            raise ValueError
        return n

    def _name(self) -> str:
        n = self._count()
        text = self.data[self.at:self.at + n].decode("latin-1")
        self.at += n + -n % 4
        return text

    def _attributes(self) -> dict:
        self._take("I")
        found = {}
        for _ in range(self._count()):
            name, kind = self._name(), np.dtype(_TYPES[self._take("I")])
            n = self._count()
            size = n * kind.itemsize
            if kind.kind == "S":
                found[name] = self.data[self.at:self.at + n].decode("latin-1").rstrip("\0")
            self.at += size + -size % 4
        return found

    def _read(self) -> dict:
        self._take("Q" if self.version == 5 else "I")  # the number of records
        self._take("I")
        sizes = []
        for _ in range(self._count()):
            self._name()
            sizes.append(self._take("Q" if self.version == 5 else "I"))
        self._attributes()
        self._take("I")
        found = {}
        for _ in range(self._count()):
            name = self._name()
            shape = [sizes[self._take("Q" if self.version == 5 else "I")] for _ in range(self._count())]
            attributes = self._attributes()
            kind = np.dtype(_TYPES[self._take("I")])
            self._take("Q" if self.version == 5 else "I")  # its size
            begin = self._take("I" if self.version == 1 else "Q")
            for key, value in attributes.items():
                found[f"{name}:{key}"] = value
            if shape and shape[0] == 0:  # grows with the records: results, no mesh
                continue
            n = int(np.prod(shape, dtype=np.float64))
            if begin + n * kind.itemsize > len(self.data):
                raise ValueError
            found[name] = np.frombuffer(self.data, dtype=kind, count=n, offset=begin).reshape(shape)
        return found
