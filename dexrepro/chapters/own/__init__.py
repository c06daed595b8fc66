"""What belongs to no chapter of the book: a scene that the user describes in a file."""

from dexrepro.chapters.own import scene
from dexrepro.experiment import Experiment

TITLE = "Your own scene"
EXPERIMENTS = (Experiment.of(scene),)
CLAIMS = REFERENCES = ERRATA = ()
