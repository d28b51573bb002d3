"""What a user sees when a scan cannot be read."""
import contextlib


class InputError(Exception):
    """A sentence: what is wrong with the file; what to do."""


@contextlib.contextmanager
def told_as(what):
    """Whatever the libraries throw becomes an InputError: they tell damage by exceptions of many kinds."""
    try:
        yield
    except (InputError, GeneratorExit, KeyboardInterrupt, MemoryError):
        raise
    except BaseException as error:  # lazrs panics outside Exception
        # libE57Format repeats itself after asterisks.
        text = " ".join(str(error).split("****")[0].split()) or type(error).__name__
        raise InputError(f"{what}: {text[:200]}; the file is damaged or of an unknown kind") from error
