"""What the figures of this chapter share."""

from __future__ import annotations

from typing import Any

from dexrepro.control.impedance_learning import EXPLORING, SOLVING, TRANSFERRING
from dexrepro.experiment import Recording
from dexrepro.report import style


def phases(axes: Any, run: Recording, names: bool = True) -> None:
    """The three phases of Algorithm 8.1 as backgrounds, numbered."""
    colours = {EXPLORING: "#EAF2F8", SOLVING: "#F6EFE0", TRANSFERRING: "#E9F5EC"}
    for number, (phase, colour) in enumerate(colours.items(), 1):
        inside = run.time[run["phase"] == phase]
        if len(inside):
            word = ("phase " if phase != SOLVING else "") + str(number) if names else ""
            style.phase(axes, inside[0], inside[-1], word, colour)
