"""Chapter 6: movement primitives that keep constraints by barrier Lyapunov functions."""

from dexrepro.chapters.chapter6 import (
    arm_obstacles,
    barrier_anatomy,
    box_carrying,
    claims,
    constraint_cases,
    coupled_primitives,
    errata,
    keep_out,
    obstacle_terms,
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
            coupled_primitives,
            constraint_cases,
            planar_skill,
            planar_constraint,
            barrier_anatomy,
            keep_out,
            arm_obstacles,
            skeleton_constraints,
            box_carrying,
            obstacle_terms,
        ),
    )
)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
