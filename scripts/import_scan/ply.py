"""Writes points as binary little-endian PLY, piece by piece."""
import os

import numpy as np

PLY_NAMES = {"f8": "double", "f4": "float", "u1": "uchar", "u2": "ushort", "i4": "int", "u4": "uint"}


class PlyWriter:
    """properties: [(name, numpy type)], in the file's order; stations [n x 3]: where the scanner stood.

    The number of points is written when it is known: a comment keeps room for its digits.
    """

    DIGITS = 20

    def __init__(self, path, properties, stations, source):
        self.dtype = np.dtype([(name, "<" + kind) for name, kind in properties])
        self.names = self.dtype.names
        self.stations = np.asarray(stations, "<f8").reshape(-1, 3)
        self.source = "".join(c if 0x20 <= ord(c) < 0x7F else "?" for c in source)
        self.count = 0
        self.file = open(path, "wb")
        self.file.write(self.header(0))
        self.file.write(self.stations.tobytes())

    def header(self, count):
        lines = ["ply", "format binary_little_endian 1.0", "comment made by pointgi's scripts/import of " + self.source,
                 "comment pointgi up z", "comment " + " " * (self.DIGITS - len(str(count)))]
        if len(self.stations):
            lines += [f"element station {len(self.stations)}"] + [f"property double {axis}" for axis in "xyz"]
        lines += [f"element vertex {count}"]
        lines += [f"property {PLY_NAMES[self.dtype[name].str[1:]]} {name}" for name in self.names]
        return ("\n".join(lines + ["end_header"]) + "\n").encode("ascii")

    def write(self, columns):
        """columns: {name: one value a point}; all of `properties`."""
        rows = np.empty(len(columns["x"]), self.dtype)
        for name in self.names:
            rows[name] = columns[name]
        self.file.write(rows.tobytes())
        self.count += len(rows)

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.file.seek(0)
            self.file.write(self.header(self.count))
            self.file.flush()
            os.fsync(self.file.fileno())
        self.file.close()
