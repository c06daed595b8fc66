"""Chapter 7: skills that react to obstacles, carried over by fuzzy rules and executed with variable impedance."""

from dexrepro.chapters.chapter7 import (
    claims,
    errata,
    fuzzy_generalisation,
    impedance_stability,
    impedance_tracking,
    obstacle_contact,
    reaching_demonstrations,
    reactive_learning,
    style_separation,
    unseen_conditions,
)
from dexrepro.experiment import Experiment

TITLE = "Incremental skill learning from human reactions"
EXPERIMENTS = tuple(
    Experiment.of(module)
    for module in (
        reaching_demonstrations,
        reactive_learning,
        style_separation,
        fuzzy_generalisation,
        unseen_conditions,
        impedance_tracking,
        impedance_stability,
        obstacle_contact,
    )
)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
