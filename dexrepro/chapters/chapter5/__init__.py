"""Chapter 5: movement primitives that grow, and adaptive neural control with error bounds."""

from dexrepro.chapters.chapter5 import (
    bounded_tracking,
    claims,
    errata,
    incremental_update,
    knowledge_reuse,
    letter_accuracy,
    obstacle_crossing,
    obstacle_tracking,
    style_transformation,
)
from dexrepro.experiment import Experiment

TITLE = "Incremental movement primitives and adaptive neural control"
MODULES = (
    incremental_update,
    letter_accuracy,
    style_transformation,
    bounded_tracking,
    knowledge_reuse,
    obstacle_crossing,
    obstacle_tracking,
)
EXPERIMENTS = tuple(map(Experiment.of, MODULES))
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
