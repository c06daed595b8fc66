"""Statements that the claims of several experiments of Chapter 2 share."""

from __future__ import annotations

from dexrepro.claims import Predicate, every, less

COMPARISON = "holding_comparison"


def ordered_pairs(*pairs: tuple[str, str], metric: str = "rmse", experiment: str = COMPARISON) -> Predicate:
    """The first case of every pair has the smaller metric."""
    return every(*(less(f"{experiment}.{a}.{metric}", f"{experiment}.{b}.{metric}") for a, b in pairs))
