"""Chapter 5: movement primitives that grow, and adaptive neural control with error bounds."""

FAIRNESS = (
    "Ways of learning share the demonstration, the initial kernels, one estimator (least squares) and the rest in the "
    "training data, as in the book; beside each improvement that is credited to added features or biases stand plain "
    "kernels with as many free parameters. Tracking laws share the path, the bound, the torque limit and as many "
    "settings each, chosen on another letter; a network is set beside an integrator at the same effective gain and "
    "rate of forgetting."
)
TITLE = "Incremental movement primitives and adaptive neural control"
ORDER = (
    "incremental_update",
    "letter_accuracy",
    "real_handwriting",
    "style_transformation",
    "bounded_tracking",
    "knowledge_reuse",
    "obstacle_crossing",
    "obstacle_tracking",
)
