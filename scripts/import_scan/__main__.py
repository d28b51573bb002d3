"""python -m import_scan SCAN PART OUT: reads SCAN, writes PART, calls it OUT in messages."""
import os
import sys

from import_scan.errors import InputError


def reader_of(path):
    """The module that reads this file: its first bytes decide, names may lie."""
    with open(path, "rb") as file:
        magic = file.read(8)
    if magic[:4] == b"LASF":
        from import_scan import las
        return las
    if magic == b"ASTM-E57":
        from import_scan import e57
        return e57
    raise InputError("it is neither LAS, LAZ nor E57; scripts/import reads .las, .laz, .copc.laz and .e57 files")


def run(scan, part, out):
    from import_scan.ply import PlyWriter
    cloud = reader_of(scan).open_scan(scan)
    with PlyWriter(part, cloud.properties, cloud.stations, os.path.basename(scan)) as writer:
        for piece in cloud.pieces():
            writer.write(piece)
            if sys.stderr.isatty():
                print(f"\r{writer.count:,} of {cloud.points:,} points", end="", file=sys.stderr)
    if sys.stderr.isatty():
        print("\r", end="", file=sys.stderr)
    for note in cloud.notes:
        print(f"warning: {scan}: {note}", file=sys.stderr)
    stations = len(cloud.stations)
    what = ", ".join(name for name in writer.names if name not in "xyz") or "positions only"
    where = f", {stations} scanner position{'s' if stations != 1 else ''}" if stations else ""
    print(f"{out}: {writer.count:,} points{where}; {what}", file=sys.stderr)


def main(scan, part, out):
    try:
        run(scan, part, out)
    except InputError as error:
        print(f"error: {scan}: {error}", file=sys.stderr)
        return 3
    except KeyboardInterrupt:
        return 130
    except MemoryError:
        print(f"error: {scan}: it asks for more memory than there is; the file is damaged, or the machine too small",
              file=sys.stderr)
        return 3
    except OSError as error:
        print(f"error: {out}: {error.strerror}; check the disk", file=sys.stderr)
        return 5
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
