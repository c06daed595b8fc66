"""Chapter 8: broad fuzzy neural adaptive impedance control for optimal robot-environment interaction."""

from dexrepro.chapters.chapter8 import circle_tracking, claims, errata, sponge, unknown_object
from dexrepro.experiment import Experiment

TITLE = "Broad fuzzy neural adaptive impedance control for optimal robot-environment interaction"
EXPERIMENTS = tuple(Experiment.of(module) for module in (circle_tracking, unknown_object, sponge))
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
