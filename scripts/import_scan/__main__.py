"""python -m import_scan SCAN PART OUT: reads SCAN, writes PART, calls it OUT in messages."""
import os
import resource
import signal
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


def convert(scan, part, out):
    """The exit code."""
    try:
        run(scan, part, out)
    except InputError as error:
        return failed(scan, error)
    except MemoryError:
        return failed(scan, "it asks for more memory than there is; the file is damaged, or the machine too small")
    except OSError as error:
        print(f"error: {out}: {error.strerror}; check the disk", file=sys.stderr)
        return 5
    return 0


def failed(scan, what):
    print(f"error: {scan}: {what}", file=sys.stderr)
    return 3


def main(scan, part, out):
    """Reads in a child: the libraries end their process where a damaged file asks for what cannot be."""
    memory = max(4 << 30, os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    child = os.fork()
    if child == 0:
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        code = 130
        try:
            code = convert(scan, part, out)
        except KeyboardInterrupt:
            pass
        finally:
            sys.stderr.flush()
            os._exit(code)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the child has it too
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return failed(scan, f"the library that reads it crashed (signal {os.WTERMSIG(status)}); the file is damaged")
    return os.WEXITSTATUS(status)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
