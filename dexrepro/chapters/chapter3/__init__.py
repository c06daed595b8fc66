"""Chapter 3: a redundant arm works through a small opening."""

from dexrepro.chapters.chapter3 import (
    claims,
    errata,
    external_push,
    fixed_opening,
    grasp_classes,
    grasp_through_opening,
    moving_opening,
    settling_time,
)
from dexrepro.experiment import Experiment

TITLE = "Working through a small opening about a remote centre of motion"
EXPERIMENTS = tuple(
    map(
        Experiment.of,
        (settling_time, fixed_opening, external_push, moving_opening, grasp_classes, grasp_through_opening),
    )
)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
