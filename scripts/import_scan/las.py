"""LAS, LAZ and COPC by laspy: all versions and point formats."""
import os
import struct

import laspy
import numpy as np

from import_scan.errors import InputError, told_as

KEPT = [("intensity", "u2"), ("return_number", "u1"), ("number_of_returns", "u1"), ("classification", "u1")]
COLOURS = [("red", "u2"), ("green", "u2"), ("blue", "u2")]
PIECE_BYTES = 64 << 20
VLR_BYTES = 54  # of the head of a variable length record
LASZIP_CHUNK_BYTES = 1 << 30


def check_header(path):
    """Throws InputError for counts that the file cannot have: laspy would believe them, for hours."""
    with open(path, "rb") as file:
        header = file.read(375)
        size = os.fstat(file.fileno()).st_size
        if len(header) < 227:
            raise InputError("it ends within its header; it is truncated")
        header_bytes, points_begin, vlrs, _, record_bytes = struct.unpack_from("<HIIBH", header, 94)
        if not header_bytes <= points_begin <= size:
            raise InputError(f"its points begin at byte {points_begin:,}, the file has {size:,}; it is truncated")
        if vlrs * VLR_BYTES > points_begin - header_bytes:
            raise InputError(f"it announces {vlrs:,} records before its points, which do not fit; it is damaged")
        extended, = struct.unpack_from("<I", header.ljust(375, b"\0"), 243) if header[25] >= 4 else (0,)
        if extended * (VLR_BYTES + 6) > size:
            raise InputError(f"it announces {extended:,} records behind its points, which do not fit; it is damaged")
        file.seek(header_bytes)
        check_laszip(file.read(points_begin - header_bytes), record_bytes)


def check_laszip(vlrs, record_bytes):
    """A chunk is unpacked as a whole."""
    at = vlrs.find(b"laszip encoded")
    if at < 2 or len(vlrs) < at - 2 + VLR_BYTES + 16:
        return
    chunk, = struct.unpack_from("<I", vlrs, at - 2 + VLR_BYTES + 12)
    if chunk != 0xFFFFFFFF and chunk * record_bytes > LASZIP_CHUNK_BYTES:
        raise InputError(f"it has chunks of {chunk:,} points; it is damaged")


class LasCloud:
    """What PlyWriter needs of a LAS file. A field that is zero throughout says nothing and is left out."""

    stations = ()

    def __init__(self, path):
        self.path = path
        self.notes = []
        check_header(path)
        with self.open() as reader:
            header = reader.header
            self.points = header.point_count
            self.piece = max(1, PIECE_BYTES // max(1, header.point_format.size))
            present = set(header.point_format.dimension_names)
            extra = [d.name for d in header.point_format.extra_dimensions if d.num_elements == 1]
            self.extra = {"".join(c if c.isalnum() else "_" for c in name): name for name in extra}
        if self.points == 0:
            raise InputError("it holds no points")
        candidates = [(name, kind) for name, kind in COLOURS + KEPT if name in present]
        used = self.non_zero([name for name, _ in candidates])
        if used & {"red", "green", "blue"}:
            used |= {"red", "green", "blue"}
        self.properties = [(axis, "f8") for axis in "xyz"] + [(n, k) for n, k in candidates if n in used]
        taken = {name for name, _ in self.properties}  # case does not tell names apart
        self.properties += [(name, "f8") for name in self.extra if name.lower() not in taken]

    def open(self):
        return told_open(self.path)

    def raw_pieces(self):
        with self.open() as reader, told_as("its points cannot be read"):
            yield from reader.chunk_iterator(self.piece)

    def non_zero(self, names):
        """Those of the names that are not zero throughout. Stops reading when all are found."""
        missing = set(names)
        for points in self.raw_pieces():
            missing -= {name for name in missing if np.any(points[name])}
            if not missing:
                break
        return set(names) - missing

    def pieces(self):
        count = 0
        for points in self.raw_pieces():
            count += len(points)
            with told_as("its points cannot be read"):
                yield {name: np.asarray(points[self.extra.get(name, name)]) for name, _ in self.properties}
        if count != self.points:
            raise InputError(f"it announces {self.points:,} points and holds {count:,}; the file is truncated")


def told_open(path):
    with told_as("its header cannot be read"):
        return laspy.open(path)


def open_scan(path):
    return LasCloud(path)
