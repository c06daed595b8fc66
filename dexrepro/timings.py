"""What ``make figures`` and ``make test`` take on the machine that measured them, kept beside the baselines.

``make measure`` renews it, by running both from a clean checkout; the README's table and the estimate at the start of a
run are made from it.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from dexrepro.config import baseline_dir
from dexrepro.storage import read_json


def timings() -> dict[str, Any]:
    """commands {command: {"machine": text, "first" and "again": {seconds, memory [GB], disk [GB]}}}, and cases
    {experiment.case: seconds}."""
    with suppress(OSError, ValueError):
        return dict(read_json(baseline_dir() / "measured.json"))
    return {}


def duration(seconds: float) -> str:
    """A time as one says it: 40 s, 12 min, 2.5 h."""
    return (
        f"{seconds:.0f} s"
        if seconds < 90
        else f"{seconds / 60:.0f} min"
        if seconds < 5400
        else f"{seconds / 3600:.1f} h"
    )


def markdown() -> str:
    """The README's table of what the two commands take."""
    found = timings()
    if not found.get("commands"):
        return "`make measure` finds out what the two commands take on a machine."
    lines = ["| command | time | memory | disk |", "| --- | --- | --- | --- |"]
    where: dict[str, list[str]] = {}
    for command, times in found["commands"].items():
        where.setdefault(times["machine"], []).append(f"`{command}`")
        for when in ("first", "again"):
            row = times[when]
            took, memory, disk = duration(row["seconds"]), f"{row['memory']:.1f} GB", f"{row['disk']:.1f} GB"
            lines.append(f"| `{command}`, {when} | {took} | {memory} | {disk} |")
    machines = ", ".join(f"{machine} ({' and '.join(commands)})" for machine, commands in where.items())
    return "\n".join([*lines, "", f"Measured on {machines}."])
