"""Chapter 1: one leader and two followers hold and move an object."""

TITLE = "Single-leader dual-follower holding and moving of objects"
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
