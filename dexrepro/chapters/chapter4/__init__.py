"""Chapter 4: a controller that grows its own network, keeps a prescribed error bound and reuses what it learned."""

FAIRNESS = (
    "Networks are compared at equal effective gain, the adaptation gain times the mean |G|^2 on the settled orbit, "
    "with the same K_1, K_2, barrier, switch, robust term, rate of forgetting and training; fixed networks have the "
    "width of least error. Errors count over the whole run. Beside each claim that credits the network stands an "
    "integrator, the same law with one constant node. One adaptation gain for all, the other way to read 'the same "
    "parameters', is a reading wherever it decides."
)
TITLE = "Broad learning adaptive neural control"
ORDER = (
    "skill_reuse",
    "barrier_and_switch",
    "payload_transfer",
    "growth_cost",
)
