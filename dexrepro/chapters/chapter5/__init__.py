"""Chapter 5: movement primitives that grow, and adaptive neural control with error bounds."""

from dexrepro.chapters.chapter5 import bounded_tracking, claims, errata, letter_accuracy, obstacle_crossing, style_transformation
from dexrepro.experiment import Experiment

TITLE = "Incremental movement primitives and adaptive neural control"
EXPERIMENTS = tuple(map(Experiment.of, (letter_accuracy, style_transformation, bounded_tracking, obstacle_crossing)))
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
