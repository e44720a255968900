# SPDX-License-Identifier: BSD-3-Clause
"""MATLAB files of version 7.3 (save -v7.3), laid out with h5py as MATLAB lays them out: a user block of 512 bytes with
the head of all MAT files, dimensions the other way round, MATLAB_class with everything, structs as groups, texts as
UTF-16, empty arrays as their dimensions, struct arrays and cells as references into #refs#.
"""

import struct

import h5py
import numpy as np

CLASSES = {"f8": "double", "f4": "single", "u1": "uint8", "u2": "uint16", "u4": "uint32", "i2": "int16", "i4": "int32"}


def _say(item, matlab_class, **others):
    item.attrs["MATLAB_class"] = np.bytes_(matlab_class)
    for name, value in others.items():
        item.attrs[name] = value


class Cell(list):
    """A cell array of one row."""


class StructArray(list):
    """A struct array of one row: dictionaries with the same keys."""


def _reference(file, value):
    group = file.require_group("#refs#")
    name = format(len(group), "x")
    _put(file, group, name, value)
    return group[name].ref


def _references(file, values):
    array = np.empty((len(values), 1), dtype=h5py.ref_dtype)
    for i, value in enumerate(values):
        array[i, 0] = _reference(file, value)
    return array


def _put(file, group, name, value):
    if isinstance(value, dict):
        inner = group.create_group(name)
        fields = np.empty(len(value), dtype=h5py.vlen_dtype(np.dtype("S1")))
        for i, key in enumerate(value):
            fields[i] = np.frombuffer(key.encode(), "S1")
        _say(inner, "struct", MATLAB_fields=fields)
        for key, field in value.items():
            _put(file, inner, key, field)
    elif isinstance(value, StructArray):
        inner = group.create_group(name)
        _say(inner, "struct")
        for key in value[0]:
            inner.create_dataset(key, data=_references(file, [each[key] for each in value]))
    elif isinstance(value, Cell):
        _say(group.create_dataset(name, data=_references(file, value)), "cell")
    elif isinstance(value, str):
        units = np.frombuffer(value.encode("utf-16-le"), "<u2")[:, None]
        _say(_array(group, name, units), "char", MATLAB_int_decode=np.int32(2))
    else:
        array = np.atleast_2d(np.asarray(value))
        _say(_array(group, name, array.T), CLASSES[array.dtype.str[1:]])


def _array(group, name, array):
    """What HDF5 gets, its last index running fastest."""
    if array.size == 0:
        data = group.create_dataset(name, data=np.array(array.shape[::-1], "<u8"))
        data.attrs["MATLAB_empty"] = np.uint8(1)
        return data
    packing = {"compression": "gzip", "compression_opts": 3} if array.size > 100 else {}
    return group.create_dataset(name, data=array, **packing)


def write_mat_hdf5(path, variables):
    """A dictionary of variables."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in variables.items():
            _put(file, file, name, value)
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: some day HDF5 schema 1.00 .".ljust(116) + bytes(8)
    with open(path, "r+b") as file:
        file.write((head + struct.pack("<H", 0x0200) + b"IM").ljust(512, b"\0"))
