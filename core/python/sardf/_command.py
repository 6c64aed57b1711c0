"""What the commands `python -m sardf...` share: exit codes as those of `sardf`, and whole files."""

import contextlib
import importlib
import itertools
import os
import sys
from pathlib import Path

from sardf._core import Cancelled, Error

DONE, FAILED, WRONG_INPUT = 0, 1, 2
_count = itertools.count()


class Failure(Error):
    """What went wrong although the input was right: a file that cannot be written, a program that
    is missing."""


def located_error(message, file="", line=0, pointer=""):
    """An Error as the core makes it: where, then what."""
    place = f"{file}:{line}" if file and line else str(file)
    text = ": ".join(part for part in (place, pointer, message) if part)
    error = Error(text)
    error.file, error.line, error.pointer, error.message = str(file), line, pointer, message
    return error


def library(name, extra):
    """A module of a library that only this part of sardf needs."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        raise ImportError(f"{name} is not installed: pip install 'sardf[{extra}]'") from None


def run(name, main, arguments):
    """Calls main(arguments) and turns what can go wrong into one line and an exit code."""
    try:
        main(arguments)
        return DONE
    except Failure as failure:
        code, said = FAILED, str(failure)
    except Error as error:
        code, said = WRONG_INPUT, str(error)
    except Cancelled:
        code, said = FAILED, "cancelled"
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except KeyboardInterrupt:
        code, said = FAILED, "interrupted"
    except MemoryError:
        code, said = FAILED, "not enough memory"
    except (ImportError, OSError) as error:
        code, said = FAILED, str(error)
    print(f"{name}: {said}", file=sys.stderr)
    return code


@contextlib.contextmanager
def completed(path):
    """A hidden name in the same folder, renamed to `path` in the end or removed on an error."""
    path = Path(path)
    if path.is_dir():
        raise Failure(f"{path}: cannot be written: it is a folder")
    temporary = path.with_name(f".{path.name}.{os.getpid()}-{next(_count)}.partial")
    try:
        yield temporary
        os.replace(temporary, path)
    except OSError as error:
        raise Failure(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path, text):
    """Writes a file under a temporary name and renames it; `-` is the standard output."""
    if str(path) == "-":
        sys.stdout.write(text)
        sys.stdout.flush()
        return
    with completed(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
