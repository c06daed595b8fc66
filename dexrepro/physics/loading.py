"""What loading into any engine needs: a display, quiet, and an error for what it complains about."""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager


class LoadingError(RuntimeError):
    """The physics engine complained about, or changed, the description it was given."""


def can_open_window() -> bool:
    """Whether there is a display; the engine ends the whole process where it finds none."""
    if not sys.platform.startswith("linux"):
        return True
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return False
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = x11.XOpenDisplay(None)
    if display:
        x11.XCloseDisplay(ctypes.c_void_p(display))
    return bool(display)


@contextmanager
def captured() -> Iterator[list[str]]:
    """Catch what native code prints on both output streams; the text is the list's only item afterwards."""
    flush = ctypes.CDLL(None).fflush
    flush(None)
    sys.stdout.flush()
    sys.stderr.flush()
    output = [""]
    saved = os.dup(1), os.dup(2)
    with tempfile.TemporaryFile() as file:
        try:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
            yield output
        finally:
            flush(None)
            for target, copy in zip((1, 2), saved, strict=True):
                os.dup2(copy, target)
                os.close(copy)
            file.seek(0)
            output[0] = file.read().decode(errors="replace")
