"""Statements that the claims of several experiments of Chapter 1 share."""

from __future__ import annotations

CASES = ("c1", "c2", "c3")
OPERATOR = "The operator's hand has the effect built in: the mapping multiplies or re-centres what the hand does."
