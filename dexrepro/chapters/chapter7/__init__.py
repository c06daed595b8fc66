"""Chapter 7: skills that react to obstacles, carried over by fuzzy rules and executed with variable impedance."""

TITLE = "Incremental skill learning from human reactions"
ORDER = (
    "reaching_demonstrations",
    "reactive_learning",
    "style_separation",
    "fuzzy_generalisation",
    "unseen_conditions",
    "impedance_tracking",
    "impedance_stability",
    "obstacle_contact",
)
FAIRNESS = (
    "Laws share k_s, the slope k of the error, the nominal model, the torque limit, the period and the sensing; where "
    "gains are tuned, every law had the same pairs, up to those with which it chatters. What the estimation or the "
    "adaptive impedance is credited with is judged beside integral action of the same K r with anti-windup, and beside "
    "a constant K."
)
