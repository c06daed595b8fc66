"""Chapter 1: one leader and two followers hold and move an object."""

from dexrepro.chapters.chapter1 import force_tracking, hold_and_move
from dexrepro.experiment import Experiment

TITLE = "Single-leader dual-follower holding and moving of objects"
EXPERIMENTS = (Experiment.of(force_tracking), Experiment.of(hold_and_move))
CLAIMS: tuple = ()
REFERENCES: tuple = ()
ERRATA: tuple = ()
