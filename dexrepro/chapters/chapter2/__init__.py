"""Chapter 2: two arms hold and move a deformable object, one teleoperated, one on its own."""

TITLE = "Single-leader dual-follower manipulation of a deformable object"
FAIRNESS = (
    "Rivals are compared with their printed parameters, on the same object and arms, over one window for all claims of "
    "an experiment; on Baxter the force that every law is asked for fades in as fast as the proposed law reaches it. "
    "What the estimating laws are told of the object at first is told to passive impedance too, as another reading. "
    "What the estimation of movement does is judged against an integral of the force error at equal effective gain; "
    "tuned comparisons give every law forty candidates, and an integral force law that is a control has a gain tuned "
    "on the object on which it is judged."
)
ORDER = (
    "planar_platform",
    "holding_line",
    "movement_estimation",
    "estimation_stability",
    "holding_comparison",
    "balloon_static",
    "balloon_movement",
    "gain_search",
    "balloon_gain_search",
    "holding_sensitivity",
)
