"""How a force history is judged; None where a run is too short to tell."""

from __future__ import annotations

import math

from dexrepro.arrays import Array
from dexrepro.experiment import Config, Recording, changed


def mean(values: Array) -> float | None:
    """Mean."""
    return float(values.mean()) if values.size else None


def shown(value: float | int | None) -> float:
    """A metric as a figure takes it: not a number where it is absent."""
    return math.nan if value is None else float(value)


SEARCHED = {"laws.force.gain", "laws.passive_impedance.mass", "passive_mass", "estimation.stiffness"}
"""What the searches for gains vary, one of each law; the integral force law is not printed at all."""


def gains(case: Config, shared: Config) -> str:
    """Where the gains of a case come from: printed, found by the search, or rescaled with the object."""
    keys = changed(case, shared)
    if keys & SEARCHED or case.controller == "force_integral":
        return "tuned"
    if case.estimation.window is None:
        return "printed; time from the start"
    return "rescaled" if "estimation.rates" in keys else "printed"


def force_error(recording: Recording, desired: float, start: float, end: float = math.inf) -> Array:
    """||F|| - f_d [N] of the object between two instants [s]."""
    return recording["object.force"][recording.between(start, end)] - desired
