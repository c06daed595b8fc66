"""Chapter 4: a controller that grows its own network, keeps a prescribed error bound and reuses what it learned."""

from dexrepro.chapters.chapter4 import (
    barrier_and_switch,
    claims,
    errata,
    growth_cost,
    payload_transfer,
    skill_reuse,
)
from dexrepro.experiment import Experiment

TITLE = "Broad learning adaptive neural control"
EXPERIMENTS = tuple(map(Experiment.of, (skill_reuse, barrier_and_switch, payload_transfer, growth_cost)))
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
