"""Chapter 6: movement primitives that keep constraints by barrier Lyapunov functions."""

from dexrepro.chapters.chapter6 import (
    arm_obstacles,
    box_carrying,
    constraint_cases,
    planar_constraint,
    planar_skill,
    skeleton_constraints,
)
from dexrepro.experiment import Experiment

TITLE = "Constrained movement primitives"
EXPERIMENTS = tuple(
    map(
        Experiment.of,
        (
            constraint_cases,
            planar_skill,
            planar_constraint,
            arm_obstacles,
            skeleton_constraints,
            box_carrying,
        ),
    )
)
CLAIMS, REFERENCES = (), ()
ERRATA = ()
