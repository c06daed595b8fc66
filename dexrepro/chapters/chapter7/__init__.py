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
