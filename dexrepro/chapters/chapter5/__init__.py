"""Chapter 5: movement primitives that grow, and adaptive neural control with error bounds."""

TITLE = "Incremental movement primitives and adaptive neural control"
ORDER = (
    "incremental_update",
    "letter_accuracy",
    "style_transformation",
    "bounded_tracking",
    "knowledge_reuse",
    "obstacle_crossing",
    "obstacle_tracking",
)
