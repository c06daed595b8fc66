"""Chapter 6: movement primitives that keep constraints by barrier Lyapunov functions."""

FAIRNESS = (
    "Laws and rivals move the same learned primitives along the same references and obstacles, with the printed gains, "
    "margin and control period, the projection (ours) off where a claim is judged; the barrier is judged against the "
    "same tracking gains without it, the constrained primitives against their references alone, and rival obstacle "
    "terms with their authors' parameters and with the best of 20 settings each."
)
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
