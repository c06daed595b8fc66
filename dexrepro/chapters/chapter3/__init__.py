"""Chapter 3: a redundant arm works through a small opening."""

from dexrepro.chapters.chapter3 import claims, errata, fixed_opening
from dexrepro.experiment import Experiment

TITLE = "Working through a small opening about a remote centre of motion"
EXPERIMENTS = (Experiment.of(fixed_opening),)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
