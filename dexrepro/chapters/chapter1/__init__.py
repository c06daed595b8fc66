"""Chapter 1: one leader and two followers hold and move an object."""

TITLE = "Single-leader dual-follower holding and moving of objects"
FAIRNESS = (
    "Rivals are compared with their printed parameters, on the same object, sensor, arms, control period and desired "
    "force; a limit of speed acts inside each law. What the autoregressive part does is judged against the same law "
    "without it, an integral of the force error of equal gain; tuned comparisons give every law twelve gains."
)
ORDER = (
    "force_tracking",
    "lyapunov",
    "relative_pose",
    "two_nuts",
    "dartboard",
    "ready_to_hold",
    "hand_over",
    "rigid_boxes",
    "hold_and_move",
    "sensitivity",
)
