"""What takes long to find out and follows from files alone, kept on disk until one of the files changes."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from dexrepro import __version__

log = logging.getLogger(__name__)
SETTLED = 1.0  # s: what was written later than so long before it was read may be written again unnoticed
FORGOTTEN = 60 * 24 * 3600.0  # s: what is older is found out again


def cached(what: str, make: Callable[[], tuple[Any, Iterable[Path] | None]]) -> Any:
    """What ``make`` returns, plain data, and the files (or folders, for the names in them) from which it follows.

    what: names it among all that this installation keeps. Without files (None) nothing is kept; nor where no folder
    can be written, which costs time alone.
    """
    key = [what, __version__, sys.version, sys.prefix, __file__]
    path = _home() / f"{hashlib.sha1(json.dumps(key).encode()).hexdigest()[:20]}.json"
    with suppress(OSError, ValueError, LookupError, TypeError, AttributeError):
        stored = json.loads(path.read_bytes())
        if all(_stamp(file) == stamp for file, stamp in stored["files"].items()):
            log.info("%s: read from %s, none of its %d files has changed", what[:60], path, len(stored["files"]))
            return stored["value"]
    log.info("%s: found out anew", what[:60])
    began = time.time_ns()
    value, files = make()
    with suppress(OSError, TypeError):
        stamps = {str(file): _stamp(file) for file in files} if files is not None else {}
        if stamps and max(stamp[0] for stamp in stamps.values()) < began - SETTLED * 1e9:
            path.parent.mkdir(parents=True, exist_ok=True)
            part = path.with_suffix(f".{os.getpid()}")
            part.write_text(json.dumps({"files": stamps, "value": value}), encoding="utf-8")
            part.replace(path)
            for old in path.parent.iterdir():
                if old.stat().st_mtime < time.time() - FORGOTTEN:
                    old.unlink()
    return value


def _stamp(file: Path | str) -> list[int]:
    stat = os.stat(file)
    return [stat.st_mtime_ns, stat.st_size]


def _home() -> Path:
    """The folder for such things: XDG_CACHE_HOME, or the system's own."""
    local = os.environ.get("LOCALAPPDATA") if os.name == "nt" else None
    return Path(os.environ.get("XDG_CACHE_HOME") or local or "~/.cache").expanduser() / "dexrepro"
