"""Chapter 2: two arms hold and move a deformable object, one teleoperated, one on its own."""

from dexrepro.chapters.chapter2 import claims, errata, movement_estimation
from dexrepro.experiment import Experiment

TITLE = "Single-leader dual-follower manipulation of a deformable object"
EXPERIMENTS = (Experiment.of(movement_estimation),)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
