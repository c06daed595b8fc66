"""Chapter 2: two arms hold and move a deformable object, one teleoperated, one on its own."""

from dexrepro.chapters.chapter2 import (
    balloon_gain_search,
    balloon_movement,
    balloon_static,
    claims,
    errata,
    estimation_stability,
    gain_search,
    holding_comparison,
    holding_line,
    holding_sensitivity,
    movement_estimation,
    planar_platform,
)
from dexrepro.experiment import Experiment

TITLE = "Single-leader dual-follower manipulation of a deformable object"
EXPERIMENTS = tuple(
    Experiment.of(module)
    for module in (
        planar_platform,
        holding_line,
        movement_estimation,
        estimation_stability,
        holding_comparison,
        balloon_static,
        balloon_movement,
        gain_search,
        balloon_gain_search,
        holding_sensitivity,
    )
)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
