"""Statements that the claims of several experiments of Chapter 5 share."""

from __future__ import annotations

TARGETS = ("w", "z", "k", "l")
