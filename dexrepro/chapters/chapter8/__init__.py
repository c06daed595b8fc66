"""Chapter 8: broad fuzzy neural adaptive impedance control for optimal robot-environment interaction."""

from dexrepro.chapters.chapter8 import circle_tracking
from dexrepro.experiment import Experiment

TITLE = "Broad fuzzy neural adaptive impedance control for optimal robot-environment interaction"
EXPERIMENTS = (Experiment.of(circle_tracking),)
CLAIMS, REFERENCES, ERRATA = (), (), ()
