"""The PyBullet world: loading, stepping, torque, contact, elastic objects, recorder, rendering."""

import ctypes
import os


def _import_engine_quietly() -> None:
    """PyBullet prints its build time when imported; nobody who pipes our output wants it."""
    flush = ctypes.CDLL(None).fflush
    flush(None)
    kept, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 2)
    try:
        import pybullet  # noqa: F401

        flush(None)
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(null)


_import_engine_quietly()
