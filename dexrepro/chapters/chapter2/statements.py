"""Statements that the claims of several experiments of Chapter 2 share."""

from __future__ import annotations

from dexrepro.claims import Predicate, every, less


def ordered_pairs(*pairs: tuple[str, str], metric: str = "rmse") -> Predicate:
    """The first case of every pair has the smaller metric."""
    return every(*(less(f".{a}.{metric}", f".{b}.{metric}") for a, b in pairs))
