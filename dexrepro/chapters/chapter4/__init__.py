"""Chapter 4: a controller that grows its own network, keeps a prescribed error bound and reuses what it learned."""

TITLE = "Broad learning adaptive neural control"
ORDER = (
    "skill_reuse",
    "barrier_and_switch",
    "payload_transfer",
    "growth_cost",
)
