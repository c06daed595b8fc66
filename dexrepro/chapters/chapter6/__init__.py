"""Chapter 6: movement primitives that keep constraints by barrier Lyapunov functions."""

TITLE = "Constrained movement primitives"
ORDER = (
    "coupled_primitives",
    "constraint_cases",
    "planar_skill",
    "planar_constraint",
    "barrier_anatomy",
    "keep_out",
    "arm_obstacles",
    "skeleton_constraints",
    "box_carrying",
    "obstacle_terms",
)
