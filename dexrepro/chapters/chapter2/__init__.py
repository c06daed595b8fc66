"""Chapter 2: two arms hold and move a deformable object, one teleoperated, one on its own."""

TITLE = "Single-leader dual-follower manipulation of a deformable object"
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
