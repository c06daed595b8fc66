"""Chapter 4: a controller that grows its own network, keeps a prescribed error bound and reuses what it learned."""

from dexrepro.chapters.chapter4 import payload_transfer, skill_reuse
from dexrepro.experiment import Experiment

TITLE = "Broad learning adaptive neural control"
EXPERIMENTS = (Experiment.of(skill_reuse), Experiment.of(payload_transfer))
CLAIMS, REFERENCES = (), ()
ERRATA = ()
