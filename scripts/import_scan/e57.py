"""E57 by libE57Format as pye57 brings it. Its own E57 class is left aside: it refuses 16-bit colours and files without
images."""
import numpy as np
from pye57 import libe57

from import_scan.errors import InputError, told_as
from import_scan.e57_node import pose_of
from import_scan.e57_colour import ColourRange

PIECE = 1 << 20
CARTESIAN = ["cartesianX", "cartesianY", "cartesianZ"]
SPHERICAL = ["sphericalRange", "sphericalAzimuth", "sphericalElevation"]
NORMAL = ["nor:normalX", "nor:normalY", "nor:normalZ"]
COLOUR = ["colorRed", "colorGreen", "colorBlue"]


def to_cartesian(spherical):
    """[n x 3]: range, azimuth from x towards y, elevation above x y; radians."""
    distance, azimuth, elevation = spherical.T
    flat = distance * np.cos(elevation)
    return np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), distance * np.sin(elevation)], axis=1)


class Scan:
    """One of the file's scans: a station, or a part that a program made."""

    def __init__(self, image_file, node):
        self.file = image_file
        self.points = node["points"]
        self.count = self.points.childCount()
        prototype = libe57.StructureNode(self.points.prototype())
        self.fields = {prototype[i].elementName(): prototype[i] for i in range(len(prototype))}
        self.rotation, self.translation = pose_of(node)
        self.axes = next((axes for axes in (CARTESIAN, SPHERICAL) if self.has(axes)), None)
        if self.axes is None:
            raise InputError("one of its scans has neither cartesian nor spherical coordinates")
        self.colour = ColourRange(node, self.fields["colorRed"]) if self.has(COLOUR) else None

    def has(self, names):
        return all(name in self.fields for name in names)

    def records(self, names):
        """Pieces of at most PIECE records: {name: values as doubles}."""
        if self.count == 0:
            return
        arrays = {name: np.empty(min(PIECE, self.count), "d") for name in names}
        buffers = libe57.VectorSourceDestBuffer()
        for name, array in arrays.items():
            buffers.append(libe57.SourceDestBuffer(self.file, name, array, len(array), True, True))
        reader = self.points.reader(buffers)
        while (count := reader.read()) > 0:
            yield {name: array[:count].copy() for name, array in arrays.items()}
        reader.close()

    def pieces(self, extra):
        """The records that are valid, in the world: (positions [n x 3], {name: values} of `extra`, normals or None)."""
        state = self.axes[0].replace("X", "").replace("Range", "") + "InvalidState"
        with_normals = self.has(NORMAL)
        names = self.axes + [name for name in [state, *extra] if name in self.fields]
        for piece in self.records(names + (NORMAL if with_normals else [])):
            valid = piece[state] == 0 if state in piece else slice(None)
            columns = {name: values[valid] for name, values in piece.items()}
            local = np.stack([columns[name] for name in self.axes], axis=1)
            if self.axes is SPHERICAL:
                local = to_cartesian(local)
            normals = None
            if with_normals:
                normals = np.stack([columns[name] for name in NORMAL], axis=1) @ self.rotation.T
            yield local @ self.rotation.T + self.translation, columns, normals


class E57Cloud:
    """What PlyWriter needs of an E57 file."""

    # The file's name of a field, ours, the type; E57 counts returns from 0.
    KEPT = [("intensity", "intensity", "f4"), ("returnIndex", "return_number", "u1"),
            ("returnCount", "number_of_returns", "u1"), ("las:classification", "classification", "u1"),
            ("classification", "classification", "u1")]

    def __init__(self, path):
        self.notes = []
        with told_as("its structure cannot be read"):
            self.file = libe57.ImageFile(path, "r")
            data = self.file.root()["data3D"]
            self.scans = [Scan(self.file, data[i]) for i in range(len(data))]
        self.points = sum(scan.count for scan in self.scans)
        if self.points == 0:
            raise InputError("it holds no points")
        if len(self.scans) > 65535:
            raise InputError(f"it has {len(self.scans):,} scans; at most 65,535 can be told apart")
        self.stations = [scan.translation for scan in self.scans]
        self.kept = [row for row in self.KEPT if any(row[0] in scan.fields for scan in self.scans)]
        self.with_normals = any(scan.has(NORMAL) for scan in self.scans)
        coloured = [scan for scan in self.scans if scan.colour]
        self.colour_type = "u1" if all(scan.colour.eight_bit for scan in coloured) else "u2"
        if coloured and len(coloured) < len(self.scans):
            self.notes.append(f"{len(self.scans) - len(coloured)} of {len(self.scans)} scans have no colours; their "
                              "points are white")
        self.properties = [(axis, "f8") for axis in "xyz"]
        self.properties += [(axis, "f4") for axis in ("nx", "ny", "nz") if self.with_normals]
        self.properties += [(channel, self.colour_type) for channel in ("red", "green", "blue") if coloured]
        self.properties += list(dict((ours, kind) for _, ours, kind in self.kept).items())
        self.properties += [("station", "u2")]

    def pieces(self):
        skipped = self.points
        for index, scan in enumerate(self.scans):
            with told_as(f"scan {index} cannot be read"):
                for positions, columns, normals in scan.pieces([row[0] for row in self.kept] + COLOUR):
                    skipped -= len(positions)
                    yield self.named(index, scan, positions, columns, normals)
        if skipped == self.points:
            raise InputError("none of its points is valid")
        if skipped:
            self.notes.append(f"{skipped:,} of {self.points:,} records are marked invalid and were left out")

    def named(self, index, scan, positions, columns, normals):
        result = {axis: positions[:, i] for i, axis in enumerate("xyz")}
        if self.with_normals:
            normals = np.zeros_like(positions) if normals is None else normals
            result.update({axis: normals[:, i] for i, axis in enumerate(("nx", "ny", "nz"))})
        for name, channel in zip(COLOUR, ("red", "green", "blue")):
            full = 255 if self.colour_type == "u1" else 65535
            result[channel] = scan.colour.scaled(columns[name], full) if scan.colour else full
        for theirs, ours, _ in self.kept:
            result.setdefault(ours, 0)
            if theirs in columns:
                result[ours] = columns[theirs] + (1 if theirs == "returnIndex" else 0)
        result["station"] = index
        return result


def open_scan(path):
    return E57Cloud(path)
