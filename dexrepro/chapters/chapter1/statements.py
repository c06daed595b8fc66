"""What claims of Chapter 1 share with each other or with an experiment: statements, names of cases."""

from __future__ import annotations

CASES = ("c1", "c2", "c3")
TRIALS = ("t1", "t2", "t3")
OPERATOR = "The operator's hand has the effect built in: the mapping multiplies or re-centres what the hand does."
