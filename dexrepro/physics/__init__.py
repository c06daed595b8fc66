"""The PyBullet world: loading, stepping, torque, contact, elastic objects, recorder, rendering."""

import ctypes
import os


def _import_engine_quietly() -> None:
    """PyBullet prints its build time on standard output when imported; scripts that read our JSON must not see it."""
    flush = ctypes.CDLL(None).fflush
    flush(None)
    kept, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        import pybullet  # noqa: F401

        flush(None)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(null)


_import_engine_quietly()
